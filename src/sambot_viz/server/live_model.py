"""The model of a live robot: its description, with the meshes that its source has."""

from __future__ import annotations

import re
import tempfile
import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from dataclasses import replace
from pathlib import Path

from sambot_viz.errors import Problem, RobotError, SourceError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import OpenedModel, open_model
from sambot_viz.topics.live_robot import LiveRobot

FRAMES_WITHIN = 2.0
"""The fixed frame is chosen when transforms hold the robot, or after this time [s]."""
FILES_WITHIN = 60.0
"""All files of a robot are to be there after this time [s]."""
MOST_FILES = 500
_FILE = re.compile(r"""filename\s*=\s*["'](package://([^"'/]+)/([^"']+))["']""")

Load = Callable[[OpenedModel, Path], Robot]
"""Load a model, with a folder of packages of its own."""


class LiveModel:
    """Loads the robot of a live source whenever it is described.

    The files that the description names are asked for once; what the source does not
    hand out is looked for among the packages of this computer.

    Args:
        live: the robot.
        load: loads it; called in a thread.
        show: shows it with the frame at its top, and problems of its files.
        refuse: shows why it cannot be shown.
    """

    def __init__(
        self,
        live: LiveRobot,
        load: Load,
        show: Callable[[Robot, str, tuple[Problem, ...]], object],
        refuse: Callable[[RobotError], object],
    ) -> None:
        self._live = live
        self._load = load
        self._show = show
        self._refuse = refuse
        self._folder = tempfile.TemporaryDirectory(prefix="sambot-viz-live-")
        # One after the other: the last description is the one that is shown.
        self._turn = threading.Lock()
        self._latest = ""
        live.on_description = self._take

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
                opened = open_model(text, self._live.label)
                missing = self._fetch(text)
                robot = self._load(opened, Path(self._folder.name))
            except RobotError as error:
                self._refuse(error)
                return
            top = self._live.top_frame(plain_name(robot.root), FRAMES_WITHIN)
            self._show(robot, top, missing)

    def _fetch(self, text: str) -> tuple[Problem, ...]:
        """Write the files of a description, and say which the source does not have."""
        source = self._live.source
        if "assets" not in source.capabilities:
            return ()
        asked: dict[str, tuple[Path, Future[bytes]]] = {}
        for uri, package, rest in _FILE.findall(text):
            path = Path(self._folder.name, package, rest)
            inside = ".." not in Path(rest).parts and package not in (".", "..")
            if inside and uri not in asked and len(asked) < MOST_FILES:
                asked[uri] = (path, source.fetch_asset(uri))
        wait([future for _, future in asked.values()], FILES_WITHIN)
        missing: list[Problem] = []
        for uri, (path, future) in asked.items():
            try:
                data = future.result(0)
            except SourceError as error:
                # It says what would allow it; the rest of the robot is shown.
                missing += [replace(p, severity="warning") for p in error.problems]
                continue
            except TimeoutError:
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            manifest = Path(self._folder.name, uri.split("/")[2], "package.xml")
            if not manifest.exists():
                manifest.write_text("<package/>", encoding="utf-8")
        return tuple(missing)
