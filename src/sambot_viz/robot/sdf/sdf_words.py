"""SDF's elements that ROS reads for a robot, used to find misplaced ones."""

from __future__ import annotations

from functools import cache

from sambot_viz.robot.sdf.elements import ElementType, model_type
from sambot_viz.robot.sdf.gazebo_only import is_tag_for_gazebo
from sambot_viz.robot.slips.vocabulary import Vocabulary, Word

REPEATED = frozenset({"collision", "frame", "joint", "link", "model", "visual"})
"""Elements that may be repeated."""

_READ = (
    "model link visual collision inertial inertia geometry box cylinder sphere mesh "
    "material frame joint axis limit dynamics mimic".split()
)
"""Elements in which ROS looks for others."""

_ENCLOSED = {
    "mass": "inertial",
    "inertia": "inertial",
    **dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), "inertia"),
    **dict.fromkeys(("box", "cylinder", "sphere", "mesh"), "geometry"),
    **dict.fromkeys(("ambient", "diffuse", "specular", "emissive"), "material"),
    **dict.fromkeys(("xyz", "limit", "dynamics", "mimic"), "axis"),
    **dict.fromkeys(("lower", "upper", "effort", "velocity"), "limit"),
    **dict.fromkeys(("damping", "friction"), "dynamics"),
    **dict.fromkeys(("uri", "scale"), "mesh"),
    "size": "box",
    "length": "cylinder",
}
_SYNONYMS = {
    "cylinder": {"radius": "r rad", "length": "h l len"},
    "sphere": {"radius": "r rad"},
    "box": {"size": "dim dims dimension dimensions extent extents"},
    "mesh": {"uri": "file filename path url src source", "scale": "scaling"},
    "geometry": {"box": "cube cuboid", "sphere": "ball"},
    "axis": {"xyz": "dir direction vector"},
    "limit": {
        "lower": "min minimum low",
        "upper": "max maximum high",
        "effort": "torque force",
        "velocity": "vel speed",
    },
    "inertial": {"mass": "m kg weight"},
}


@cache
def types_by_tag() -> dict[str, ElementType]:
    """Return the parts of a <model> that ROS reads: tag → its valid content."""
    types: dict[str, ElementType] = {}
    stack = [model_type()]
    while stack:
        known = stack.pop()
        if known.name in types or is_tag_for_gazebo(known.name):
            continue
        types[known.name] = known
        if known.name in _READ:
            stack += reversed(known.children.values())
    return types


@cache
def sdf_vocabulary() -> Vocabulary:
    """Return the names in a <model>, by the table of all elements of SDF."""
    words: dict[str, Word] = {}
    for tag in _READ:
        known = types_by_tag()[tag]
        inside = [child for child in known.children if not is_tag_for_gazebo(child)]
        words[tag] = Word(
            " ".join(known.attributes),
            once=" ".join(child for child in inside if child not in REPEATED),
            many=" ".join(child for child in inside if child in REPEATED),
            one_of=tag == "geometry",
        )
    synonyms = {
        f"{tag}.{word}": right
        for tag, rows in _SYNONYMS.items()
        for right, others in rows.items()
        for word in others.split()
    }
    return Vocabulary("model", words, synonyms, _ENCLOSED)
