"""The background thread that reads models for displays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from sambot_viz.displays.robot_display import (
    Description,
    ModelRequest,
    ModelResult,
)
from sambot_viz.errors import RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import open_text
from sambot_viz.session.background import Background


class ModelThread:
    """Reads one model at a time, in a thread that lives while there is work.

    Expanding a xacro file may take 20 seconds. Of several requests of one display, only
    the latest is carried out.

    Args:
        load: reads a model; its second argument is False for a file that a browser
            chose, whose code must not run.
        package_path: folders to search for packages.
        load_described: reads a description from a topic.
    """

    def __init__(
        self,
        load: Callable[[Path, bool], Robot],
        package_path: Sequence[Path | str] = (),
        load_described: Callable[[Description], Robot] | None = None,
    ) -> None:
        self.package_path = tuple(package_path)
        self._load = load
        self._load_described = load_described or _load_text
        self._background = Background("sambot-viz-models")

    def read(self, request: ModelRequest) -> None:
        """Read a model soon."""

        def work() -> None:
            try:
                result: ModelResult = self._result(request)
            except RobotError as error:
                result = error
            request.done(result)

        self._background.do(request.owner, work)

    def wait(self, timeout: float) -> bool:
        """Wait until the thread is idle; False on a timeout [s]."""
        return self._background.wait(timeout)

    def _result(self, request: ModelRequest) -> Robot:
        if isinstance(request.path, Description):
            return self._load_described(request.path)
        return self._load(request.path, request.trusted)


def _load_text(described: Description) -> Robot:
    from sambot_viz.robot.model import load_robot

    opened = open_text(described.text or "", described.label)
    return load_robot(opened, trusted=False)
