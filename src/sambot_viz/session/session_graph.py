"""The nodes and topics of a session: of its model's package, and of its robot."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.graph.launch_names import has_launch_files
from sambot_viz.options import Options
from sambot_viz.robot.packages.package_index import package_around
from sambot_viz.session.background import Background
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.shown_problems import Problems
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker

# The first page does not wait for what only the tab needs.
if TYPE_CHECKING:
    from sambot_viz.errors import Problem
    from sambot_viz.graph.launches import StartedLaunch
    from sambot_viz.graph.node_graph import NodeGraph
    from sambot_viz.graph.placed_graph import PlacedGraph
    from sambot_viz.graph.running import RunningNodes
    from sambot_viz.sources.source import Source

SMALL = 40
"""With more nodes and topics, details are left out at first."""
PAUSE = 3.0
"""Period of questions to a robot while the graph is on a screen [s]."""


@dataclass(frozen=True, slots=True)
class _GraphInputs:
    """The inputs of a graph.

    Attributes:
        package: the package with the launch files; None without one.
        model: number of the robot, which changes when a file is saved.
        problems: the findings of check.
        launch: name of the launch file; "" for the one that starts the most nodes.
        running: the nodes and topics that a robot reports.
        details: whether details are drawn; None draws them in small graphs.
    """

    package: Path | None
    model: int
    problems: tuple[Problem, ...]
    launch: str
    running: NodeGraph | None
    details: bool | None


class SessionGraph:
    """Makes the graph while a page shows it, and again when its inputs change.

    Graphs are made one by one in a separate thread: reading the files of a package may
    take seconds, and the session must not wait for them.

    Args:
        robot: the robot, whose package is read.
        problems: drawn at their places.
        sources: a live one reports the running nodes.
        change: sends the changes.
        worker: takes the finished graphs.
        options: arguments of the launch files, and the folders of packages.

    Attributes:
        changed: emitted when there is another graph.
        facts: emitted when it changes whether there may be something to draw.
        launch: name of the launch file to draw; "" for the one that starts the most.
        has_details: whether types, packages and topics of one node are drawn.
    """

    def __init__(
        self,
        robot: RobotState,
        problems: Problems,
        sources: SessionSources,
        change: Change,
        worker: Worker,
        options: Options,
    ) -> None:
        self.changed = Signal(change, None)
        self.launch = ""
        self.has_details = True
        self._details: bool | None = None
        self._robot, self._problems, self._sources = robot, problems, sources
        self._worker = worker
        self._options = options
        self._background = Background("sambot-viz-graph")
        self._viewers: set[object] = set()
        self._launches: tuple[StartedLaunch, ...] = ()
        self._asked: _GraphInputs | None = None
        self._read: tuple[object, tuple[StartedLaunch, ...]] = (None, ())
        self._nodes: tuple[Source, RunningNodes] | None = None
        self._drawn: tuple[object, PlacedGraph | None] = ((None, True), None)
        self._placed: PlacedGraph | None = None
        self._is_looking = False
        self.facts = (robot.changed, sources.replaced)
        connect([*self.facts, problems.shown], self._look)

    @property
    def is_there(self) -> bool:
        """Whether there is something to draw: launch files, or a live robot."""
        return self._package is not None or self._live is not None

    @property
    def is_waiting(self) -> bool:
        """Whether a robot is not connected, so that its nodes are unknown."""
        return self._live is not None and not self._live.status.is_connected

    @property
    def launches(self) -> Sequence[str]:
        """The names of the launch files, once they were read."""
        return [one.name for one in self._launches]

    @property
    def placed(self) -> PlacedGraph | None:
        """The picture; None until a page has shown it."""
        return self._placed

    def follow(self, viewer: object, on: bool) -> None:
        """Make the graph while a viewer sees it."""
        if not on:
            self._viewers.discard(viewer)
            return
        self._viewers.add(viewer)
        self._look()
        self._look_later()

    def choose(self, launch: str) -> None:
        """Draw another launch file."""
        self.launch = launch
        self._look()

    def draw_details(self, on: bool) -> None:
        """Draw types, packages and topics of one node, or leave them out."""
        self._details = on
        self._look()

    @property
    def _package(self) -> Path | None:
        """The folder of the model's package, where that has launch files."""
        robot = self._robot.model
        if robot is None:
            folder = self._given_package()
        # The model from a page or a robot is read, never files around it.
        elif not robot.files or robot.file_roots is not None:
            return None
        else:
            folder = package_around(robot.files[0])
        return folder if folder is not None and has_launch_files(folder) else None

    def _given_package(self) -> Path | None:
        """Return the package of the model that was given, which may have an error."""
        given = self._options.model
        if not isinstance(given, str | Path) or not os.path.exists(given):
            return None
        path = Path(given)
        return package_around(path / "package.xml" if path.is_dir() else path)

    @property
    def _live(self) -> Source | None:
        data = self._sources.data
        return None if data is None else data.source.live

    def _look(self) -> None:
        """Have the graph made, when it may be another one."""
        if not self._viewers:
            return
        robot, problems = self._robot.model, self._problems.shown.value.listed
        package, running = self._package, self._running()
        given = _GraphInputs(
            package, id(robot), problems, self.launch, running, self._details
        )
        if given != self._asked:
            self._asked = given
            self._background.do(self, partial(self._make, given))

    def _make(self, given: _GraphInputs) -> None:
        """Make the graph, in its thread."""
        from sambot_viz.graph.node_graph import compared
        from sambot_viz.graph.placed_graph import place_graph

        try:
            expected, launches = self._expected(given)
            found = [one for one in (expected, given.running) if one is not None]
            graph = compared(*found) if len(found) == 2 else next(iter(found), None)
            details = given.details
            if details is None:
                details = graph is None or len(graph.nodes) + len(graph.topics) <= SMALL
            if (graph, details) != self._drawn[0]:
                placed = None if graph is None else place_graph(graph, details)
                self._drawn = (graph, details), placed
        except Exception as error:
            self._worker.post(partial(self._worker.report, error))
            return
        self._worker.post(partial(self._take, self._drawn[1], launches, details))

    def _take(
        self,
        placed: PlacedGraph | None,
        launches: tuple[StartedLaunch, ...],
        details: bool,
    ) -> None:
        self.has_details = details
        if placed is not self._placed or launches is not self._launches:
            self._placed, self._launches = placed, launches
            self.changed.touch()

    def _look_later(self) -> None:
        """Ask the robot again after a while, as long as a page shows the graph."""
        if not self._is_looking and self._viewers and self._live is not None:
            self._is_looking = True
            self._worker.post_later(PAUSE, self._look_again)

    def _look_again(self) -> None:
        self._is_looking = False
        if self._viewers and self._nodes is not None:
            self._nodes[1].ask()
        self._look()
        self._look_later()

    def _expected(
        self, given: _GraphInputs
    ) -> tuple[NodeGraph | None, tuple[StartedLaunch, ...]]:
        """Return what launch files start, and these; called in the thread alone."""
        if given.package is None:
            return None, ()
        from sambot_viz.graph.expected import expected_graph
        from sambot_viz.graph.launches import started_launches

        of = (given.package, given.model, given.problems)
        if of != self._read[0]:
            options = self._options
            launches = started_launches(
                given.package,
                arguments=options.xacro_args,
                package_path=options.package_path,
                workspace=options.workspace,
            )
            self._read = of, launches
        launches = self._read[1]
        called = (one for one in launches if one.is_called(given.launch))
        launch = next(called, next(iter(launches), None))
        return launch and expected_graph(launch.system, given.problems), launches

    def _running(self) -> NodeGraph | None:
        live = self._live
        if live is None or self.is_waiting:
            return None
        from sambot_viz.graph.running import RunningNodes

        if self._nodes is None or self._nodes[0] is not live:
            changed = partial(self._worker.post, self._look, latest_of=self)
            self._nodes = live, RunningNodes(live, changed)
            self._nodes[1].ask()
        return self._nodes[1].graph()
