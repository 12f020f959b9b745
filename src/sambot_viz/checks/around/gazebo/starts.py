"""Find which Gazebo a launch file starts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Generation
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.errors import Place

NAMES: dict[Generation, str] = {"gz": "Gazebo", "classic": "Gazebo Classic"}
PACKAGES: dict[str, Generation] = {
    "gazebo_ros": "classic",
    "ros_gz_sim": "gz",
    "ros_gz_bridge": "gz",
    "ros_ign_gazebo": "gz",
    "ros_ign_bridge": "gz",
}
_PROGRAMS: dict[str, Generation] = {
    "gazebo": "classic",
    "gzserver": "classic",
    "gzclient": "classic",
    "gz sim": "gz",
    "ign gazebo": "gz",
}
_SIMULATORS = (
    *_PROGRAMS,
    "GzServer",
    "gz_sim.launch.py",
    "gz_server.launch.py",
    "ign_gazebo.launch.py",
    "gazebo.launch.py",
)
_ACTIONS: dict[str, Generation] = {"GzServer": "gz", "RosGzBridge": "gz"}


class Start(NamedTuple):
    """A program of one Gazebo that a launch file starts.

    Attributes:
        generation: which Gazebo.
        what: its name.
        place: its line.
        call: the action that starts it.
    """

    generation: Generation
    what: str
    place: Place
    call: Call

    @property
    def simulates(self) -> bool:
        """True for the simulator itself, not for a bridge or a spawned robot."""
        return self.what.startswith(_SIMULATORS)


def starts(launch: LaunchFile) -> list[Start]:
    """Return the programs of Gazebo that always start."""
    return [start for call in launch.certain for start in _starts(launch, call)]


def may_start(launch: LaunchFile) -> frozenset[Generation]:
    """Return the generations of Gazebo that start at least sometimes."""
    every = (start for call in launch.calls for start in _starts(launch, call))
    return frozenset(start.generation for start in every)


def _starts(launch: LaunchFile, call: Call) -> Iterator[Start]:
    name, place = call.name, call.place
    if name in _ACTIONS:
        yield Start(_ACTIONS[name], name, place, call)
    elif name in NODES:
        package = launch.text(call, "package") or ""
        program = launch.text(call, "executable") or ""
        if package in PACKAGES:
            yield Start(PACKAGES[package], f"{program} of {package}", place, call)
    elif name == "IncludeLaunchDescription":
        path = launch.text(call, "launch_description_source", 0) or ""
        package = path.removeprefix(SHARE).partition("/")[0]
        if path.startswith(SHARE) and package in PACKAGES:
            file = path.rpartition("/")[2]
            yield Start(PACKAGES[package], f"{file} of {package}", place, call)
    elif name == "ExecuteProcess":
        words = " ".join(launch.values.texts(call.given("cmd"))).split()
        for program in (" ".join(words[:1]), " ".join(words[:2])):
            if program in _PROGRAMS:
                yield Start(_PROGRAMS[program], program, place, call)
