"""After a change of the fixed frame, all is where it is when drawn afresh there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from inside import session_of
from pose_tracks import MOVED
from situations import TYPES
from status_world import World, files_of

from sambot_viz import Visualizer
from sambot_viz.matrices import matrix_from_wxyz

MESSAGES = Path(__file__).parents[2] / "golden" / "messages"
CASES = sorted(path.parent.name for path in MESSAGES.glob("*/messages.mcap"))
Matrix = npt.NDArray[np.float64]
Pose = tuple[tuple[float, ...], tuple[float, ...]]
IDENTITY: Pose = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@contextmanager
def shown(
    source: Path, config: Path, frame: str, at_s: float = math.inf
) -> Iterator[Visualizer]:
    """Open a recording in a fixed frame, at a time [s] or at its end."""
    with Visualizer(source=f"bag:{source}", config=config, port=0) as viz:
        session_of(viz).document.set_option("Fixed Frame", frame)
        viz.player.pause()
        viz.player.jump(min(at_s, viz.player.duration))
        yield viz


def files_of_case(case: str) -> tuple[Path, Path]:
    return MESSAGES / case / "messages.mcap", MESSAGES / case / "config.rviz"


class OpenPage:
    """What a page that was open all the time knows of the nodes' poses.

    It has heard all that was sent when it is made, and then what `hear` reads: of each
    kind and node the newest message, as they go out after a change. A page drops a pose
    with the node alone, so a node that is only made again keeps the one it had.
    """

    def __init__(self, viz: Visualizer) -> None:
        websocket: Any = viz.viser._websock_server  # pyright: ignore[reportPrivateUsage]
        self._buffer = websocket._broadcast_buffer
        self._next = self._buffer.message_counter
        self.poses = poses_of(viz)

    def hear(self) -> None:
        """Take the messages that are new."""
        messages = self._buffer.message_from_id.items()
        # A pose that moves is changed in the message that is there.
        newest = {n: max(n, getattr(one, "moved_in", -1)) for n, one in messages}
        for number, message in sorted(messages, key=lambda one: newest[one[0]]):
            if newest[number] < self._next or getattr(message, "name", "") == MOVED:
                continue
            match type(message).__name__:
                case "RemoveSceneNodeMessage":
                    self.poses.pop(message.name, None)
                case "SetOrientationMessage":
                    position = self.poses.get(message.name, IDENTITY)[1]
                    self.poses[message.name] = (tuple(message.wxyz), position)
                case "SetPositionMessage":
                    wxyz = self.poses.get(message.name, IDENTITY)[0]
                    self.poses[message.name] = (wxyz, tuple(message.position))
                case _ if message.lifecycle_phase == "create" and message.entity_type:
                    if message.entity_type == "scene":
                        self.poses.setdefault(message.name, IDENTITY)
                case _:
                    pass
        self._next = self._buffer.message_counter


def handles_of(viz: Visualizer) -> dict[str, Any]:
    return viz.viser.scene._handle_from_node_name  # pyright: ignore[reportPrivateUsage]


def poses_of(viz: Visualizer) -> dict[str, Pose]:
    """The pose of each node in the one above it."""
    handles = handles_of(viz).items()
    return {
        name: (tuple(one.wxyz.tolist()), tuple(one.position.tolist()))
        for name, one in handles
    }


def placed(name: str, poses: dict[str, Pose]) -> Matrix:
    """Return T_fixed_node, (4, 4)."""
    T, path = np.eye(4), ""
    for part in name.split("/")[1:]:
        path = f"{path}/{part}"
        T = T @ matrix_from_wxyz(*poses.get(path, IDENTITY))
    return T


def drawn(viz: Visualizer, poses: dict[str, Pose]) -> list[tuple[str, list[float]]]:
    """What each display shows and where: the nodes may have other names."""
    found: list[tuple[str, list[float]]] = []
    for display in session_of(viz).scene.displays:
        for name, handle in handles_of(viz).items():
            if f"/{display.key}" in name:
                what = f"{display.kind} {type(handle).__name__}"
                place = placed(name, poses).round(5) + 0.0
                found.append((what, place.ravel().tolist()))
    return sorted(found)


def test_in_a_frame_that_does_not_exist_what_waits_says_so_also_while_paused() -> None:
    with shown(*files_of_case("nav2_scene_orbit"), "map") as viz:
        assert not transform_problems(viz)
        session_of(viz).document.set_option("Fixed Frame", "nowhere")
        found = transform_problems(viz)
        waiting = ("LaserScan", "Path", "Polygon", "PoseArray", "Pose")
        assert set(waiting) <= set(found)
        for kind in waiting:
            assert "Fixed Frame [nowhere] does not exist" in found[kind]
        session_of(viz).document.set_option("Fixed Frame", "map")
        assert not transform_problems(viz)


def transform_problems(viz: Visualizer) -> dict[str, str]:
    """Display → what it says of a transform that is not known."""
    return {
        display.kind.split("/")[1]: row.text
        for display in session_of(viz).scene.displays
        for key, row in display.status.rows.items()
        if key == "Transform" and row.level != "Ok"
    }


@pytest.mark.parametrize("case", CASES)
def test_all_is_where_it_is_when_it_is_drawn_afresh(case: str) -> None:
    require_same_as_afresh(*files_of_case(case))


def test_so_it_is_with_every_display_of_messages(tmp_path: Path) -> None:
    situations = [f"ok.{kind}" for kind in TYPES]
    source, config = files_of(World(situations), tmp_path)
    kinds = require_same_as_afresh(source, config, at_s=1.0)
    assert kinds == {*TYPES} - WITHOUT_NODES - ZEROS


WITHOUT_NODES = {"DepthCloud", "Effort", "Image", "InteractiveMarkers"}
"""What shows pictures alone, or needs a robot or a second topic."""
ZEROS = {"AccelStamped", "Path", "TwistStamped", "Wrench"}
"""Vectors without a length and a path of one pose: the cases above have more."""


def require_same_as_afresh(
    source: Path, config: Path, at_s: float = math.inf
) -> set[str]:
    """Change the fixed frame, there and back; return the displays that show nodes."""
    with shown(source, config, "map", at_s) as viz:
        page = OpenPage(viz)
        others = sorted({*session_of(viz).scene.context.tree.frames} - {"map"})
        for frame in (*others[:2], "map"):
            session_of(viz).document.set_option("Fixed Frame", frame)
            page.hear()
            with shown(source, config, frame, at_s) as afresh:
                assert drawn(viz, page.poses) == drawn(afresh, poses_of(afresh)), frame
        return {what.partition(" ")[0].partition("/")[2] for what, _ in drawn(viz, {})}
