"""Report joint states without a publisher, in launch files and at bridges."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.gazebo.systems import attributes, near_system
from sambot_viz.checks.around.launching.actions import LaunchArgument, Operation
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.system import Endpoint, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.ends import remapped_at
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Problem

_SENDER = "joint-state-publisher-system"
_TRUE = frozenset({"true", "1"})
_READER, _KIND = "robot_state_publisher", "JointState"
_SOURCES = (".py", ".cpp", ".hpp", ".h", ".ino", ".lua")


def no_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a joint state publisher that does not start, as gui is true by default."""
    robot = around.known
    joints = [j.name for j in robot.joints.values() if j.movable] if robot else []
    for launch in around.launches:
        nodes = [call for call in launch.calls if call.name == "Node"]
        started = {launch.text(node, "executable") for node in nodes}
        if "joint_state_publisher_gui" in started:
            continue
        for node in nodes:
            if launch.text(node, "executable") != "joint_state_publisher":
                continue
            match node.condition:
                case Operation("not", (LaunchArgument(name=str(argument)),)):
                    pass
                case _:
                    continue
            default = launch.values.defaults.get(argument, "")
            if default.strip().lower() not in _TRUE:
                continue
            stays = listed(joints) or "every movable joint"
            verb = "stay" if len(joints) > 1 else "stays"
            yield Problem.at(
                node.place,
                "warning",
                "launch-no-joint-states",
                f"no node publishes joint states here: {argument} is true, so "
                "joint_state_publisher does not start, and no "
                f"joint_state_publisher_gui node is listed; {stays} {verb} without a "
                "transform",
                "add the joint_state_publisher_gui node, or run with "
                f"{argument}:=False",
            )


def unsent_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a bridge for joint states without a plugin that sends them."""
    drives = [p for p in around.plugins if p.is_drive and p.generation == "gz"]
    if not drives or any("ros2_control" in p.filename for p in around.plugins):
        return
    if any(near_system(plugin.filename) for plugin in around.plugins):
        # One of them may misspell the intended plugin.
        return
    carried = (e for e in around.bridged if e.kind == "Model")
    entry = next((e for e in carried if e.reaches_ros), None)
    if entry is None or entry.scoped:
        return
    topic = f"<topic>{bare(entry.gz.value)}</topic>"
    senders = [p for p in around.plugins if _SENDER in p.filename]
    if not senders:
        place = entry.gz.place
        yield Problem.at(
            place,
            "warning",
            "bridge-topic",
            f"the bridge carries {entry.gz.value}, but no plugin beside "
            f"{drives[0].filename} ({where(drives[0].element.place, place)}) sends the "
            "states of the joints: the wheels have no transform in ROS",
            f"add <plugin {attributes('joint-state-publisher')}>{topic}</plugin> "
            "beside that of the drive",
        )
    elif not any(sender.element.find("topic") for sender in senders):
        place = senders[0].element.place
        yield Problem.at(
            place,
            "warning",
            "bridge-topic",
            f"{senders[0].filename} has no <topic> and sends to one that Gazebo makes "
            f"up, but the bridge carries {entry.gz.value} "
            f"({where(entry.gz.place, place)})",
            f"add {topic} to the plugin",
        )


def unheard_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report joint states that robot_state_publisher reads under another name."""
    running = around.running
    if not running.is_known or _may_have_others(around):
        return
    ends = [(n, end) for n in running.started for end in n.endpoints]
    states = [(n, end) for n, end in ends if end.message == _KIND]
    readers = [(n, e) for n, e in states if not e.publishes and n.executable == _READER]
    found: dict[str, Problem] = {}
    for reader, end in readers:
        # What another launch file with a reader starts is for that one.
        others = {n.launch for n, _ in readers} - {reader.launch}
        near = [(n, e) for n, e in states if n.launch not in others]
        read = {e.topic for _, e in near if not e.publishes}
        read |= {f"/{bare(name)}" for n in running.started for name in _sources(n)}
        senders = [(n, e) for n, e in near if e.publishes]
        odd = [each for each in senders if each[0].launch == reader.launch]
        if reader.starts != "yes" or any(e.topic in read for _, e in senders):
            continue
        for sender, sent in odd[:1]:
            for problem in _unheard(around, (reader, end), (sender, sent)):
                found.setdefault(problem.message, problem)
    yield from found.values()


def _may_have_others(around: Surroundings) -> bool:
    """Return whether ros2_control or a program may publish or read joint states."""
    if any("ros2_control" in plugin.filename for plugin in around.plugins):
        return True
    if any(node.package == "controller_manager" for node in around.running.started):
        return True
    used = {each for package in around.packages for each in package.used}
    return any(
        _KIND in (package.text(path) or "")
        for package in used.union(around.packages)
        for path in package.ending(*_SOURCES)
        if not path.endswith("launch.py")
    )


def _sources(node: RunningNode) -> tuple[str, ...]:
    """Return the topics that a joint_state_publisher collects."""
    given = node.parameter("source_list")
    return (given.values or ()) if given is not None else ()


def _unheard(
    around: Surroundings,
    read: tuple[RunningNode, Endpoint],
    sent: tuple[RunningNode, Endpoint],
) -> Iterator[Problem]:
    """Report the odd one of two ends; the rule about namespaces has the others."""
    (reader, end), (sender, topic) = read, sent
    what = "the bridge" if sender.is_bridge else sender.executable
    is_renamed = _renames(reader)
    if sender.is_bridge and not is_renamed:
        place = topic.place
        fix = write(place, topic.written, f"/{bare(end.topic)}")
    else:
        odd, other = (reader, what) if is_renamed else (sender, _READER)
        if not _renames(odd):
            return
        place = remapped_at(around, odd)
        fix = Fix(f"delete the remapping, or write one for {other} too")
    at = "" if place == topic.place else f" ({where(topic.place, place)})"
    yield Problem.at(
        place,
        "warning",
        "launch-no-joint-states",
        f"{_READER} ({where(reader.place, place)}) reads {end.topic}, but {what}{at} "
        f"publishes the joint states as {topic.topic}: wheels and other joints that "
        "move have no transform",
        fix,
    )


def _renames(node: RunningNode) -> bool:
    return any(bare(old) == "joint_states" for old, _ in node.remappings)
