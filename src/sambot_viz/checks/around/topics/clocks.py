"""Simulated time: who uses it, who does not, and whether it reaches ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.gazebo.starts import starts
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.system import GivenParameter, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem

_ENTRY = (
    "{ros_topic_name: /clock, gz_topic_name: /clock, "
    "ros_type_name: rosgraph_msgs/msg/Clock, gz_type_name: gz.msgs.Clock, "
    "direction: GZ_TO_ROS}"
)
_ARGUMENT = "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"
_CLOCK = "use_sim_time"
_WITHOUT_TIME = frozenset({"parameter_bridge", "create", "spawn_entity.py", "spawner"})
_WITHOUT_CLOCK = frozenset({"ros_gz_sim", "nav2_bringup", "slam_toolbox"})
"""Packages whose launch files start no clock."""


def different_clocks(around: Surroundings) -> Iterator[Problem]:
    """Report nodes without simulated time beside Gazebo, or beside nodes with it."""
    running = around.running
    certain = [node for node in running.nodes if node.starts == "yes"]
    off: dict[tuple[str, Place], list[RunningNode]] = {}
    for node in certain:
        given = node.parameter(_CLOCK)
        if given is None or flag(given.value or "") is not False:
            continue
        exempt = node.is_simulator or node.executable in _WITHOUT_TIME
        exempt = exempt or _may_be_overridden(node, given)
        # Another launch file that includes this one may set true.
        open_ = given.is_argument and _CLOCK not in running.declared
        if not exempt and (given.place in node.chain or not open_):
            off.setdefault((node.launch, given.place), []).append(node)
    for (launch, place), nodes in off.items():
        beside = [node for node in certain if node.launch == launch]
        other = next((node for node in beside if node.is_simulator), None)
        is_default = place in nodes[0].chain
        if other is None and is_default:
            other = next((node for node in beside if _is_simulated(node)), None)
        if other is not None:
            yield _off(nodes, other, place, is_default)


def _is_simulated(node: RunningNode) -> bool:
    given = node.parameter(_CLOCK)
    if given is None or _may_be_overridden(node, given):
        return False
    return flag(given.value or "") is True


def _may_be_overridden(node: RunningNode, given: GivenParameter) -> bool:
    """Return whether a launch file of Nav2 may override use_sim_time of a file."""
    return given.given_at is not None and node.place in node.chain


def _off(
    nodes: Sequence[RunningNode], other: RunningNode, place: Place, is_default: bool
) -> Problem:
    names = dict.fromkeys(node.executable or "this node" for node in nodes)
    there = where((*other.chain, other.place)[0], place)
    does = (
        f"{there} starts Gazebo, whose time begins at 0"
        if other.is_simulator
        else f"{other.executable} ({there}) uses simulated time"
    )
    chain = () if is_default else nodes[0].chain[-1:]
    by = "".join(f", by {where(each, place)}" for each in chain)
    use, them = ("uses", "its") if len(names) == 1 else ("use", "their")
    return Problem.at(
        place,
        "warning",
        "sim-time-off",
        f"{listed(names, 3)} {use} the time of the computer ({_CLOCK} is false{by}), "
        f"but {does}: {them} transforms never fit",
        f"write '{_CLOCK}': 'true' among the launch_arguments"
        if is_default
        else f"write True for {_CLOCK}",
    )


def clock_not_bridged(around: Surroundings) -> Iterator[Problem]:
    """Report a bridge without /clock where nodes wait for simulated time."""
    user = _first_user(around)
    if user is None or any(
        _may_bring_clock(launch, around) for launch in around.launches
    ):
        return
    bridges = [
        (package, file)
        for package in around.packages
        for file in package.yaml_files
        if any("ros_type_name" in entry for entry in file.entries())
    ]
    texts = [v.value for _, f in bridges for e in f.entries() for v in e.values()]
    if any("clock" in text for text in texts):
        return
    place: Place | None = None
    hint: str | Fix
    if bridges:
        package, file = bridges[0]
        text = package.text(file.path) or ""
        place = Place(file.shown, len(text.splitlines()))
        hint = f"add - {_ENTRY} at the end of the file"
        end = Place(file.shown, place.line + 1, 1)
        if text.endswith("\n") and "\n- " in f"\n{text}":
            hint = write_between(end, end, f"- {_ENTRY}\n", hint)
    else:
        hint = f"add '{_ARGUMENT}' to the arguments of parameter_bridge"
        place = next((p for la in around.launches for p in _bridging(la)), None)
    if place is not None:
        yield Problem.at(
            place,
            "warning",
            "clock-not-bridged",
            f"the bridge does not bring /clock to ROS, but nodes use simulated time "
            f"({where(user, place)}): their time stays at 0",
            hint,
        )


def _first_user(around: Surroundings) -> Place | None:
    """Return the first place where a file with a bridge sets use_sim_time of a node."""
    for launch in around.launches:
        if any(start.generation == "gz" for start in starts(launch)):
            for node in launch.nodes:
                if node.sim_time is not None and flag(node.sim_time.value):
                    return node.sim_time.place
    return None


def _bridging(launch: LaunchFile) -> Iterator[Place]:
    for node in launch.nodes:
        if node.executable == "parameter_bridge" and node.arguments:
            yield node.place


def _may_bring_clock(launch: LaunchFile, around: Surroundings) -> bool:
    if any("clock" in text for text in launch.strings):
        return True
    return any(_is_foreign(fact, around) for fact in launch.paths)


def _is_foreign(fact: Fact, around: Surroundings) -> bool:
    """Return whether a launch file is from a package with unknown content."""
    package = fact.value.removeprefix(SHARE).partition("/")[0]
    ours = package in around.names or package in _WITHOUT_CLOCK
    return fact.value.endswith("launch.py") and not ours
