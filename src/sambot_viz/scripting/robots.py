"""Further robots in the same view, each with its own joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.frames import Transform
from sambot_viz.frames.transform import Pose
from sambot_viz.robot.merged_robots import HungRobot, merged
from sambot_viz.robot.model import Positions, Robot, load_robot
from sambot_viz.robot.parts import Origin
from sambot_viz.scripting.displays import first
from sambot_viz.server.sessions import Sessions

Move = Callable[[Mapping[str, float]], None]
"""Moves joints of all robots, by their names with prefixes."""


class AddedRobot:
    """A further robot: ``arm = viz.add_robot("arm.urdf", "arm")``.

    Its links, joints and frames are those of its model, prefixed by its name and a
    slash: "arm/elbow" in the Joints panel, for ``viz.link("arm/hand")`` and in
    ``viz.frames``. The methods here take the names of its model.

    Attributes:
        name: the name that it was added with.
        robot: its model.
    """

    def __init__(self, robots: Robots, name: str, robot: Robot) -> None:
        self.name = name
        self.robot = robot
        self._robots = robots

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints that take a position, in the order of vectors."""
        return self.robot.joint_names

    @property
    def joint_positions(self) -> Mapping[str, float]:
        """Joint → position [rad or m], mimic joints included.

        With private sessions, those of the browser that came first.
        """
        session, prefix = first(self._robots.sessions), f"{self.name}/"
        with session.lock:
            joints = session.robot.joints
            every = {} if joints is None else joints.all_positions()
        own = {n: q for n, q in every.items() if n.startswith(prefix)}
        return MappingProxyType({n.removeprefix(prefix): q for n, q in own.items()})

    def set_joint_positions(self, positions: Positions) -> None:
        """Move some of its joints, in every browser.

        Args:
            positions: joint → position [rad or m], or a vector in the order of
                `joint_names`.

        Raises:
            JointError: an unknown joint, a mimic joint, no finite number, or a vector
                of another length.
            UsageError: it was removed.
            ServerError: the visualizer was stopped.
        """
        self._robots.require(self)
        named = self.robot.named_positions(positions)
        self._robots.move({f"{self.name}/{n}": q for n, q in named.items()})

    def remove(self) -> None:
        """Take it out of the view, with robots that hang at it.

        Raises:
            UsageError: it was removed already.
        """
        self._robots.remove(self)

    def __repr__(self) -> str:
        return f"<robot '{self.robot.name}' as '{self.name}'>"


class Robots:
    """Joins the robot that was opened with those that a program adds.

    Args:
        sessions: they show all of them as one robot.
        move: moves joints.
    """

    def __init__(self, sessions: Sessions, move: Move) -> None:
        self.sessions = sessions
        self.move = move
        self._hung: dict[str, HungRobot] = {}
        self._added: dict[str, AddedRobot] = {}
        # Also when the model is loaded again.
        sessions.assemble = lambda robot: merged(robot, [*self._hung.values()])

    def add(
        self,
        model: Path | str | Robot,
        name: str,
        parent: str | None,
        xyz: Pose,
        rpy: Sequence[float],
    ) -> AddedRobot:
        """Add a robot, as `Visualizer.add_robot` says."""
        self.sessions.require_open()
        shown = self.sessions.robot
        if shown is None:
            raise UsageError("there is no robot yet beside which another could be")
        if not name or name != name.strip("/ ") or name in self._hung:
            raise UsageError(f"'{name}' is not a name, or another robot has it")
        parent = shown.root if parent is None else parent
        if parent not in shown.links:
            near = did_you_mean(parent, shown.links)
            raise UsageError(f"no link '{parent}' to hang it at; {near}")
        pose = Transform.of(xyz, rpy)
        if not isinstance(model, Robot):
            packages = self.sessions.options.package_path
            model = load_robot(model, package_path=packages)
        origin = Origin(position_of(pose.matrix), pose.rpy)
        self._hung[name] = HungRobot(name, model, parent, origin)
        self._added[name] = AddedRobot(self, name, model)
        self.sessions.show_again()
        return self._added[name]

    def remove(self, robot: AddedRobot) -> None:
        """Take a robot out, with those that hang at it."""
        self.sessions.require_open()
        self.require(robot)
        gone = {robot.name}
        for one in self._hung.values():
            if one.parent.rpartition("/")[0] in gone:
                gone.add(one.name)
        for name in gone:
            del self._hung[name], self._added[name]
        self.sessions.show_again()

    def require(self, robot: AddedRobot) -> None:
        """Raise UsageError for a robot that was removed."""
        if self._added.get(robot.name) is not robot:
            raise UsageError(f"the robot '{robot.name}' was removed")
