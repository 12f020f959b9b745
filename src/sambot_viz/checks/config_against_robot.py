"""Find settings of an RViz config that prevent the robot from being shown.

Such a config is valid, and RViz reports nothing or too little. Examples are a fixed
frame that no node publishes, and a robot description that RViz misses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from sambot_viz.bundled import is_bundled
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import QOS_PROPERTIES
from sambot_viz.rviz.declarations import is_ros1, kind_of
from sambot_viz.rviz.yaml.yaml_nodes import Map, Node, Scalar

if TYPE_CHECKING:
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.rviz.class_items import DisplayConfig

_DESCRIPTION = "robot_description"
_ROBOT_MODEL = "rviz_default_plugins/RobotModel"
_OF_MOVEIT = "moveit_rviz_plugin/"
_LIKENESS = 0.87
_OF_THE_WORLD = frozenset({"map", "odom", "world"})
"""Frames that programs outside the packages publish, and no robot has."""


def check_config(robot: Robot, config: RvizConfig) -> list[Problem]:
    """Find settings of a config that do not match this robot.

    Args:
        robot: the robot to show.
        config: the config that shows it.

    Returns:
        Warnings and notes, in the order of the file.
    """
    problems = list(_fixed_frame(robot, config))
    models = [d for d in _all(config.displays) if _is_robot_model(d)]
    if not is_bundled(config.file):
        # A user cannot fix the config that comes with the program.
        for display in models:
            problems += _description(display, config.file)
    misspelt = list(_misspelt_classes(config))
    problems += [*misspelt, *_classes_of_ros1(config)]
    meant = any(_ROBOT_MODEL in problem.hint for problem in misspelt)
    if not models and not meant:
        problems.append(_no_robot_model(config.file))
    elif models and not any(display.enabled for display in models):
        problems.append(_switched_off(models[0], config.file))
    elif models and all(_shows_nothing(display) for display in models):
        problems.append(_without_shapes(models[0], config.file))
    return sorted(problems, key=lambda p: p.line or 0)


def moveit_draws_robot(config: RvizConfig) -> bool:
    """Return whether RViz draws the robot with a display of MoveIt."""
    displays = _all(config.displays)
    return any(d.enabled and d.class_id.startswith(_OF_MOVEIT) for d in displays)


def lists_links(robot: Robot, config: RvizConfig) -> bool:
    """Return whether a config has settings for the links of this robot.

    RViz saves them for all links, and frames, of the robot that it has shown.
    """
    listed: set[str] = set()
    for display in _all(config.displays):
        for key in ("Links", "Frames"):
            inside = display.node.get(key)
            if isinstance(inside, Map):
                listed |= {k for k in inside.keys() if isinstance(inside.get(k), Map)}
    own = listed & robot.links.keys()
    return len(own) > 1 and 2 * len(own) > len(listed)


def _misspelt_classes(config: RvizConfig) -> Iterator[Problem]:
    """Find displays with a misspelt class."""
    known = [
        f"{package}/{name}"
        for package, names in vocabulary("rviz_classes").items()
        if package != "properties"
        for name in names
    ]
    for display in _all(config.displays):
        kind = kind_of(display.class_id)
        if kind in known:
            continue
        near = nearest(kind, known, _LIKENESS) or _of_message(kind)
        if near is not None:
            place = _place(config.file, display.node.get("Class"))
            yield Problem.at(
                place,
                "warning",
                "config-class",
                f"RViz has no display {display.class_id}: it shows an error in its "
                "place",
                _written(place, display.class_id, near, near),
            )


def _of_message(kind: str) -> str | None:
    """Return the display for the message whose name the class has."""
    package, _, name = kind.rpartition("/")
    if package != _ROBOT_MODEL.rpartition("/")[0]:
        return None
    displays = known_nodes().displays.items()
    shows = {message.rpartition("/")[2]: display for display, message in displays}
    return shows.get(name)


def _classes_of_ros1(config: RvizConfig) -> Iterator[Problem]:
    """Find displays of RViz 1 beside those of RViz 2."""
    displays = _all(config.displays)
    if not any(d.class_id.startswith("rviz_default_plugins/") for d in displays):
        return
    for display in displays:
        if is_ros1(display.class_id):
            place = _place(config.file, display.node.get("Class"))
            right = kind_of(display.class_id)
            yield Problem.at(
                place,
                "warning",
                "config-class",
                f"{display.class_id} is a display of RViz 1, and the others are of "
                "RViz 2, which shows an error in its place",
                _written(place, display.class_id, right, right),
            )


def _written(
    place: Place | str | None, wrong: str, right: str, shown: str
) -> str | Fix:
    hint = f"write {shown}"
    if not isinstance(place, Place):
        return hint
    return write(place, wrong, right, hint=hint)


def _no_robot_model(file: str | None) -> Problem:
    return Problem.at(
        file,
        "info",
        "setup-no-robot-model",
        "the RobotModel display is missing: only the frames of the robot are shown",
        f"add a display of the class {_ROBOT_MODEL}",
    )


def _switched_off(display: DisplayConfig, file: str | None) -> Problem:
    return Problem.at(
        _place(file, display.node.get("Enabled") or display.node),
        "info",
        "setup-no-robot-model",
        "the RobotModel display is switched off: only the frames of the robot are "
        "shown",
        "switch it on in the Displays panel",
    )


def _is_transparent(display: DisplayConfig) -> bool:
    try:
        return float(display.node.text("Alpha") or "1") == 0
    except ValueError:
        return False


def _shows_nothing(display: DisplayConfig) -> bool:
    """Return whether a robot display has nothing to see: no shapes, or no alpha."""
    node = display.node
    shown = node.text("Collision Enabled") or "false"
    without_shapes = node.text("Visual Enabled") == "false" and shown == "false"
    return without_shapes or _is_transparent(display)


def _without_shapes(display: DisplayConfig, file: str | None) -> Problem:
    if _is_transparent(display):
        place = _place(file, display.node.get("Alpha"))
        return Problem.at(
            place,
            "info",
            "setup-no-robot-model",
            "the RobotModel display has the Alpha 0: the robot is invisible",
            _written(place, display.node.text("Alpha") or "", "1", "Alpha: 1"),
        )
    return Problem.at(
        _place(file, display.node.get("Visual Enabled")),
        "info",
        "setup-no-robot-model",
        "the RobotModel display draws neither visuals nor collisions: only the frames "
        "of the robot are shown",
        "write Visual Enabled: true",
    )


def _all(displays: Sequence[DisplayConfig]) -> Iterator[DisplayConfig]:
    for display in displays:
        yield display
        yield from _all(display.displays)


def _is_robot_model(display: DisplayConfig) -> bool:
    return display.class_id.rpartition("/")[2] == "RobotModel"


def _fixed_frame(robot: Robot, config: RvizConfig) -> Iterator[Problem]:
    written = str(config.global_options.node.text("Fixed Frame") or "")
    frame = str(config.global_options.get("Fixed Frame")).lstrip("/")
    said = {*config.global_options.node.keys()}
    misspelt = "Fixed Frame" not in said and nearest("Fixed Frame", said, _LIKENESS)
    if not frame or frame in robot.links or misspelt:
        return
    near = nearest(frame, robot.links)
    place = _place(config.file, config.global_options.node.get("Fixed Frame"))
    hint: str | Fix = (
        f"write {near}" if near else f"choose {robot.root}, the root of this robot"
    )
    if frame not in _OF_THE_WORLD and isinstance(place, Place):
        hint = write(place, written, near or robot.root, hint=hint)
    yield Problem.at(
        place,
        "warning",
        "setup-fixed-frame",
        f"the fixed frame {frame} does not exist: no link of the robot has this name, "
        "and without ROS nothing else publishes it",
        hint,
    )


def unknown_references(
    robot: Robot, config: RvizConfig, is_published: Callable[[str], bool]
) -> Iterator[Problem]:
    """Find displays that hang on a frame which does not exist.

    Args:
        robot: the robot to show.
        config: the config that shows it.
        is_published: returns whether a node may publish a frame that is no link.
    """
    for display in _all(config.displays):
        node = display.node.get("Reference Frame")
        frame = _text(node).lstrip("/")
        is_frame = bool(frame) and not frame.startswith("<")
        if not is_frame or not display.enabled or frame in robot.links:
            continue
        if frame in _OF_THE_WORLD or is_published(frame):
            continue
        place = _place(config.file, node)
        right = nearest(frame, robot.links, _LIKENESS) or "<Fixed Frame>"
        yield Problem.at(
            place,
            "warning",
            "frame-unknown",
            f"the display {display.name} hangs on the frame {frame}, which does not "
            "exist: RViz does not show it",
            _written(place, _text(node), right, right),
        )


def description_topics(config: RvizConfig) -> set[str]:
    """Return the full names of the topics from which displays read the robot."""
    values = (_topic_value(d) for d in _all(config.displays) if _is_robot_model(d))
    names = (_text(value).lstrip("/") for value in values)
    return {f"/{name}" for name in names if name}


def _topic_value(display: DisplayConfig) -> Node | None:
    """Return the topic of a display's robot; None where it reads a file."""
    topic = display.node.get("Description Topic")
    if topic is None or display.node.text("Description Source") == "File":
        return None
    return topic.get("Value") if isinstance(topic, Map) else topic


def _description(display: DisplayConfig, file: str | None) -> Iterator[Problem]:
    topic, value = display.node.get("Description Topic"), _topic_value(display)
    if topic is None or value is None:
        return
    name = _text(value)
    if name and name.rpartition("/")[2] != _DESCRIPTION:
        place = _place(file, value)
        yield Problem.at(
            place,
            "warning",
            "setup-description-topic",
            f"the display {display.name} reads the robot from the topic {name}, but "
            f"robot_state_publisher publishes it on /{_DESCRIPTION}",
            _written(place, name, f"/{_DESCRIPTION}", f"Value: /{_DESCRIPTION}"),
        )
    yield from _volatile(display, topic, file)


def _volatile(
    display: DisplayConfig, topic: Node, file: str | None
) -> Iterator[Problem]:
    """Report a Volatile that the user wrote.

    RViz itself writes Volatile with all defaults, and then uses another policy.
    """
    durability = topic.get("Durability Policy") if isinstance(topic, Map) else None
    if not isinstance(topic, Map) or _text(durability) != "Volatile":
        return
    if all(_text(topic.get(k.name)) == str(k.default) for k in QOS_PROPERTIES):
        return
    place, right = _place(file, durability), "Transient Local"
    yield Problem.at(
        place,
        "warning",
        "setup-description-volatile",
        f"the display {display.name} reads the robot with the Durability Policy "
        "Volatile: RViz then misses the description, which is published only once, "
        "and shows nothing and no error",
        _written(place, "Volatile", right, f"Durability Policy: {right}"),
    )


def _text(node: Node | None) -> str:
    return node.text.strip() if isinstance(node, Scalar) else ""


def _place(file: str | None, node: Node | None) -> Place | str | None:
    """Return the place of a value; only the file for a default.

    The file does not have values that the user typed in the page.
    """
    if isinstance(node, Scalar) and node.changed:
        return None
    span = None if node is None else node.span
    if file is None or span is None:
        return file
    return Place(file, span.line, span.column)
