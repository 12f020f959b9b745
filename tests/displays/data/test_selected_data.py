"""Data that a page has selected: its rows, its boxes, and when it goes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from filled_messages import cloud2, on_topic, pose, xyz
from inside import session_of, viser_server
from panel_rows import data_of, panel_of
from protocol_client import ProtocolClient

from sambot_viz import limits
from sambot_viz.panels.selection.selection import SHOWN, SelectionPanel
from sambot_viz.panels.tools import ToolsPanel
from sambot_viz.session.scene.picker import Picker

Open = Callable[..., Any]
SQUARE = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
FIVE = np.float32([1, 2, 3, 4])
MARKER = "visualization_msgs/msg/Marker"


class Page:
    """A page that looks at a recording from 5 m above, with the tool Select."""

    def __init__(self, shown: Any, client: ProtocolClient) -> None:
        self.shown = shown
        self.session = session_of(shown.viz)
        shown.viz.player.pause()
        self._client = client
        self.settle()
        (self.client,) = self.session.clients.all.values()
        self.tools = self.client.tools
        camera = {
            "wxyz": (0.0, 1.0, 0.0, 0.0),
            "position": (0.0, 0.0, 5.0),
            "fov": 0.785,
            "near": 0.01,
            "far": 1000.0,
            "image_height": 480,
            "image_width": 640,
            "look_at": (0.0, 0.0, 0.0),
            "up_direction": (0.0, 1.0, 0.0),
        }
        client.send("ViewerCameraMessage", **camera)
        self.choose("Select")

    def settle(self) -> None:
        self._client.settle(viser_server(self.shown.viz))

    def choose(self, label: str) -> None:
        self._client.act("tools/choose", label)
        self.settle()

    def click(self, x: float, y: float, modifier: str | None = None) -> None:
        self._send("click", modifier, (x, y, 5.0), (0.0, 0.0, -1.0), ((0.5, 0.5),))

    def rectangle(self, low: Any, high: Any, modifier: str | None = None) -> None:
        self._send("rect-select", modifier, None, None, (low, high))

    def _send(self, kind: str, modifier: Any, start: Any, ray: Any, at: Any) -> None:
        self._client.send(
            "ScenePointerMessage",
            event_type=kind,
            ray_origin=start,
            ray_direction=ray,
            screen_pos=at,
            modifier=modifier,
        )
        self.settle()

    @property
    def numbers(self) -> list[int]:
        """Those of the selected points."""
        (numbers,) = self.tools.selection.values() or ([],)
        return [*numbers]

    def panel(self) -> SelectionPanel:
        return panel_of(SelectionPanel, self.session, self.client)

    def rows(self) -> dict[str, Any]:
        """Names of rows → their values; of the last item, where there are several."""
        return {row.name: row.value for row in self.panel().rows()}

    def boxes(self) -> int:
        """How many boxes are drawn around the selection."""
        found = self.session.picker.boxes_of(self.tools.selection)
        return sum(len(lines) for lines in found.values()) // 12


@pytest.fixture
def page(
    messages: Open, protocol: Callable[..., ProtocolClient]
) -> Callable[..., Page]:
    def open_page(*given: Any, **values: Any) -> Page:
        shown = messages(*given, **values)
        return Page(shown, protocol(urlsplit(shown.viz.url).port or 0))

    return open_page


def test_a_clicked_point_has_its_rows_and_a_box(page: Callable[..., Page]) -> None:
    made = cloud2(SQUARE, intensity=FIVE)

    def stamped(types: Any) -> Any:
        topic, name, message = made(types)
        message.header.stamp.sec, message.header.stamp.nanosec = 12, 34
        return topic, name, message

    one = page("PointCloud2", stamped)
    assert "Nothing is selected" in one.rows()[""]
    one.click(0.5, -0.5)
    assert one.numbers == [2]
    assert one.rows() == {
        "Point 2 [PointCloud2]": None,
        # Which message it is of.
        "Topic": one.shown.display.config.get("Topic"),
        "Stamp": "12.000000034 s",
        "Frame": "map",
        "Position": "0.5; -0.5; 0 m",
        "3: intensity": "3",
    }
    assert one.boxes() == 1
    tools = panel_of(ToolsPanel, one.session, one.client)
    assert data_of(tools)["tools/selected"] == ["Point 2 of PointCloud2"]
    one.click(0.0, 0.0)
    assert not one.tools.selection


def test_shift_adds_points_and_ctrl_removes_them(page: Callable[..., Page]) -> None:
    one = page("PointCloud2", cloud2(SQUARE))
    one.rectangle((0.3, 0.2), (0.5, 0.8))
    assert one.numbers == [0, 1]
    one.rectangle((0.5, 0.5), (0.8, 0.8), "shift")
    assert one.numbers == [0, 1, 2]
    assert one.boxes() == 3
    one.click(-0.5, 0.5, "cmd/ctrl")
    assert one.numbers == [0, 2]
    assert one.rows()["Distance"].startswith("1 m, from Point 0 [PointCloud2] to ")
    assert one.rows()["Offset"] == "1; 0; 0 m, along the axes of map"
    one.rectangle((0.0, 0.0), (1.0, 1.0), "cmd/ctrl")
    assert not one.tools.selection
    assert one.boxes() == 0


def test_of_many_points_the_first_are_listed(page: Callable[..., Page]) -> None:
    points = np.random.default_rng(1).uniform(-1, 1, (20_000, 3))
    one = page("PointCloud2", cloud2(points), Style="Points")
    one.rectangle((0.0, 0.0), (1.0, 1.0))
    count = len(one.numbers)
    assert count > limits.SELECTED_BOXES.value
    assert one.boxes() == limits.SELECTED_BOXES.value
    rows = one.panel().rows()
    assert sum(row.kind == "group" for row in rows) == SHOWN
    assert rows[-1].value == f"and {count - SHOWN} more"


def test_points_of_an_old_message_are_selected_no_longer(
    page: Callable[..., Page],
) -> None:
    one = page("PointCloud2", cloud2(SQUARE), cloud2(SQUARE))
    one.shown.viz.player.jump(0.0)
    one.click(0.5, 0.5)
    assert one.numbers == [3]
    one.shown.viz.player.jump(one.shown.viz.player.duration)
    one.settle()
    assert not one.tools.selection
    assert "Nothing is selected" in one.rows()[""]


@pytest.mark.parametrize("way", ["off", "not selectable"])
def test_what_is_taken_off_is_selected_no_longer(
    page: Callable[..., Page], way: str
) -> None:
    one = page("PointCloud2", cloud2(SQUARE))
    one.click(0.5, 0.5)
    if way == "off":
        one.session.display_edits.set_enabled(one.shown.display.config, False)
    else:
        one.shown.set("Selectable", False)
    one.settle()
    assert not one.tools.selection


def marker(x: float) -> Any:
    return on_topic(
        MARKER,
        ns="n",
        id=1,
        type=1,
        pose=pose(x),
        scale=xyz(0.4, 0.4, 0.4),
        color={"r": 1.0, "a": 1.0},
    )


def test_a_selected_marker_is_followed_while_it_is_there(
    page: Callable[..., Page],
) -> None:
    gone = on_topic(MARKER, ns="n", id=1, action=2)
    one = page("Marker", marker(0.0), marker(1.0), gone)
    player = one.shown.viz.player
    player.jump(0.0)
    one.click(0.1, 0.1)
    panel = one.panel()
    (head, _, place, *_) = panel.rows()
    assert head.name == "Marker n/1"
    assert place.value == "0; 0; 0 m"
    player.jump(0.1)
    one.settle()
    assert panel.values()[place.id] == "1; 0; 0 m"
    assert one.boxes() == 1
    player.jump(player.duration)
    one.settle()
    assert not one.tools.selection


def test_two_points_are_measured(page: Callable[..., Page]) -> None:
    one = page("PointCloud2", cloud2(SQUARE), **{"Size (m)": 0.05})
    one.choose("Measure")
    # Beside the middles, but on the squares.
    one.click(-0.51, -0.49)
    one.click(0.49, 0.51)
    assert one.tools.status.startswith("1.41421 m. ")


def test_the_camera_looks_at_the_selected_points(page: Callable[..., Page]) -> None:
    one = page("PointCloud2", cloud2(SQUARE))
    one.click(0.5, 0.5)
    box = one.session.picker.box_of(one.tools.selection)
    assert box is not None
    assert (box[0] + box[1]) / 2 == pytest.approx((0.5, 0.5, 0.0))


def test_messages_cost_nothing_where_nothing_is_selected(
    page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    one = page("PointCloud2", cloud2(SQUARE), cloud2(SQUARE))
    asked: list[str] = []
    for name in ("boxes_of", "kept", "data_of"):
        monkeypatch.setattr(Picker, name, lambda *_, name=name: asked.append(name))
    for time in (0.0, one.shown.viz.player.duration):
        one.shown.viz.player.jump(time)
        one.settle()
    assert asked == []
