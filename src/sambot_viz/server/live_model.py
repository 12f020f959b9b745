"""The model of a live robot: its description, and meshes from its source."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable
from pathlib import Path

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import OpenedModel, open_text
from sambot_viz.topics.live_files import fetch_files
from sambot_viz.topics.source_robot import SourceRobot

FRAMES_WITHIN = 2.0
"""Latest time to choose the fixed frame, if no transforms hold the robot before [s]."""

Load = Callable[[OpenedModel, Path], Robot]
"""Load a model with a separate folder of packages."""


class LiveModel:
    """Loads the robot of a live source whenever a description arrives.

    It requests the files in the description once. Files that the source does not
    provide are searched for among the packages of this computer.

    Args:
        live: the robot.
        load: loads the model; called in a thread.
        show: shows the model with the frame of its root link, the top frame, and
            problems of its files; None where the user opened another robot, and only
            displays request this one.
        refuse: shows why the model cannot be shown.
    """

    def __init__(
        self,
        live: SourceRobot,
        load: Load,
        show: Callable[[Robot, str, str, tuple[Problem, ...]], object] | None,
        refuse: Callable[[RobotError], object],
    ) -> None:
        self._live = live
        self._load = load
        self._show = show
        self._refuse = refuse
        self._folder = tempfile.TemporaryDirectory(
            prefix="sambot-viz-live-", ignore_cleanup_errors=True
        )
        # One load at a time, so that the last description is the shown one.
        self._turn = threading.Lock()
        self._latest = ""
        if show is not None:
            live.on_description = self._take

    def load(self, text: str, label: str) -> Robot:
        """Load the description on a topic, for a display that shows it.

        Raises:
            RobotError: the model cannot be shown.
        """
        with self._turn:
            return self._loaded(text, label)[0]

    def close(self) -> None:
        """Forget the files."""
        self._live.on_description = lambda text: None
        with self._turn:
            self._folder.cleanup()

    def _take(self, text: str) -> None:
        self._latest = text
        threading.Thread(
            target=self._run, args=(text,), name="sambot-viz-live-model", daemon=True
        ).start()

    def _run(self, text: str) -> None:
        with self._turn:
            if text != self._latest or not Path(self._folder.name).is_dir():
                return
            try:
                robot, missing = self._loaded(text, self._live.label)
            except RobotError as error:
                self._live.refusal = f"URDF failed Model parse: {_first(error)}"
                self._live.tell_status()
                self._refuse(error)
                return
            self._live.refusal = ""
            if self._show is not None:
                root, top = self._live.root_and_top(robot, FRAMES_WITHIN)
                self._show(robot, root, top, missing)

    def _loaded(self, text: str, label: str) -> tuple[Robot, tuple[Problem, ...]]:
        opened, folder = open_text(text, label), Path(self._folder.name)
        missing = fetch_files(self._live.source, text, folder)
        return self._load(opened, folder), missing


def _first(error: RobotError) -> str:
    problem = error.problems[0]
    return f"{problem.message}; {problem.hint}" if problem.hint else problem.message
