"""The topics of a source that tell of a robot: description, transforms, joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.topics.name_spaces import separate_spaces, space_of

STAND_IN_LINK = "base_link"
"""The link of a stand-in of which no frame is known."""
STAND_IN_NAME = "no robot"
"""The name of a placeholder robot."""
_BASES = ("base_link", "base_footprint")
"""What the frame of a mobile robot is called (REP 105)."""


@dataclass(frozen=True, slots=True)
class RobotTopics:
    """The topics of one robot.

    Attributes:
        description: of the URDF; None when there is none.
        moving: of the transforms that hold at their stamps.
        static: of the transforms that hold at all times.
        joint_states: of the positions of joints.
        others: descriptions of further robots, for displays that ask for them.
        spaces: name spaces whose frames are kept apart; none where there is one.
        joints_of: further description → the topics of the positions of its joints.
        all: every topic of which messages are taken.
        descriptions: of all robots, its own first.
    """

    description: str | None = None
    moving: tuple[str, ...] = ()
    static: tuple[str, ...] = ()
    joint_states: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    spaces: tuple[str, ...] = ()
    joints_of: Mapping[str, tuple[str, ...]] = field(
        default_factory=dict[str, tuple[str, ...]]
    )
    all: frozenset[str] = field(init=False, repr=False, compare=False)
    descriptions: tuple[str, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        own = () if self.description is None else (self.description,)
        object.__setattr__(self, "descriptions", (*own, *self.others))
        taken = frozenset((*own, *self.moving, *self.static, *self.joint_states))
        object.__setattr__(self, "all", taken)


def robot_topics(types: Mapping[str, str], named: Sequence[str] = ()) -> RobotTopics:
    """Choose the topics of a robot.

    A robot without a namespace comes first, then that of the first namespace with a
    description; robots that transforms place come before others. Transforms without a
    namespace belong to every robot. Where robots have namespaces, all transforms are
    used (see `NameSpaces`).

    Args:
        types: topic → the name of its type, as ``std_msgs/msg/String``.
        named: descriptions that a config names; the first existing one comes before all
            others.
    """
    found = [
        name
        for name, kind in types.items()
        if describes_robot(name, kind)
        or (name in named and meaning_of(kind) is Meaning.TEXT)
    ]
    wanted = next((name for name in named if name in found), "")
    every = _all_of(types, Meaning.TRANSFORMS)
    spaces = separate_spaces(every, found)
    told = {space_of(name) for name in every}

    def order(name: str) -> tuple[bool, bool, int, str]:
        lacks = bool(spaces) and told.isdisjoint(("", space_of(name)))
        return name != wanted, lacks, name.count("/"), name

    found.sort(key=order)
    description = found[0] if found else None
    space = "" if description is None else space_of(description)
    others = {name: space_of(name) for name in found[1:] if space_of(name) != space}
    transforms = every if spaces else _near(every, space)
    joints = _all_of(types, Meaning.JOINTS, "joint_states")
    return RobotTopics(
        description,
        tuple(name for name in transforms if not _is_static(name)),
        tuple(name for name in transforms if _is_static(name)),
        _near([n for n in joints if space_of(n) not in others.values()], space),
        tuple(found[1:]),
        tuple(spaces),
        {
            name: tuple(n for n in joints if space_of(n) == its)
            for name, its in others.items()
        },
    )


def describes_robot(name: str, type_name: str) -> bool:
    """Return whether a topic describes a robot, by its name and type."""
    return meaning_of(type_name) is Meaning.TEXT and is_description(name)


def is_description(name: str) -> bool:
    """Return whether a topic is called as those that describe robots."""
    return _last(name) == "robot_description"


def stand_in_model(link: str = STAND_IN_LINK) -> str:
    """Return the XML text of a robot of one link, for messages without a robot."""
    # It imports what asks the web for files, and most robots need no other.
    from xml.sax.saxutils import quoteattr

    return f'<robot name="{STAND_IN_NAME}"><link name={quoteattr(link)}/></robot>'


def top_frame(root: str, pairs: Iterable[tuple[str, str]]) -> str:
    """Return the frame at the top of the tree of a root link, such as odom.

    Args:
        root: of a robot.
        pairs: (parent, child) of all transforms that are known.
    """
    above = {child: parent for parent, child in pairs}
    frame = plain_name(root)
    # Messages may form a ring.
    for _ in range(len(above)):
        if frame not in above:
            break
        frame = above[frame]
    return frame


def base_frame(pairs: Iterable[tuple[str, str]]) -> str | None:
    """Return the frame that is called as that of a robot by convention, if one is.

    Args:
        pairs: (parent, child) of all transforms that are known.
    """
    children = [child for _, child in pairs]
    named = (child for name in _BASES for child in children if _last(child) == name)
    return next(named, None)


def _all_of(
    types: Mapping[str, str], meaning: Meaning, word: str = ""
) -> tuple[str, ...]:
    """Return the topics of a meaning."""
    return tuple(
        name
        for name, kind in types.items()
        if meaning_of(kind) is meaning and word in _last(name)
    )


def _near(names: Sequence[str], space: str) -> tuple[str, ...]:
    """Return the topics in a namespace, or else those in the least."""
    for prefix in dict.fromkeys((space, "")):
        near = [name for name in names if space_of(name) == prefix]
        if near:
            return tuple(near)
    return tuple(names)


def _is_static(name: str) -> bool:
    return _last(name) == "tf_static"


def _last(name: str) -> str:
    return name.rpartition("/")[2]
