"""The topics of the Add dialog, and the displays that are added for them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from live_peers import WAIT
from made_recording import described, write_recording
from panel_rows import edit, panel_of, rows_of
from patience import until
from robot_peer import RobotPeer, square_peer

from sambot_viz import SambotVizError, Visualizer, limits
from sambot_viz.panels.displays.add_by_topic import (
    NO_SOURCE,
    NOT_SHOWN,
    AddByTopicPanel,
)
from sambot_viz.panels.displays.display_commands import DisplayCommands
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.displays.topic_tree import shown_topics, topic_rows
from sambot_viz.panels.rows.row import Row
from sambot_viz.session import Session

IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
SCAN, IMU = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu"
BROWSER = 1


class Dialog:
    """The panel of a session, and what its choices do."""

    def __init__(self, session: Session) -> None:
        self.session = session
        topics = None if session.data is None else session.data.topics
        self.panel = panel_of(AddByTopicPanel, session, topics=topics)
        displays = panel_of(DisplaysPanel, session)
        self.add = panel_of(DisplayCommands, session, displays=displays)
        self.id_of: Callable[[Any], str] = displays.id_of

    def show(self, words: str = "", shows_all: bool = False) -> list[str]:
        """The tree: each name behind as many dots as rows are above it."""
        with self.session.lock:
            edit(self.panel, "add_by_topic/show", [True, words, shows_all])
            return tree_of(rows_of(self.panel))

    def said(self) -> list[str]:
        with self.session.lock:
            return [row.value for row in self.panel.rows() if row.kind == "note"]

    def choose(self, kind: str, topic: str, *more: Any) -> None:
        """Do what the page asks for."""
        name, group, index = more or ("", "", None)
        with self.session.lock, self.session.history.acting(BROWSER):
            edit(self.add, "displays/add-topic", [kind, topic, name, group, index, ""])

    @property
    def names(self) -> list[str]:
        return [one.name for one in self.session.document.config.displays]


def tree_of(rows: dict[str, Row]) -> list[str]:
    """The names of rows, each below the one that it belongs to."""

    def below(parent: str, dots: str) -> Iterator[str]:
        for row in rows.values():
            if row.parent == parent and row.kind != "note":
                yield f"{dots}{row.name}"
                yield from below(row.id, f"{dots}.")

    return list(below("", ""))


@pytest.fixture
def square(repository: Path) -> Iterator[Dialog]:
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        yield Dialog(session_of(viz))


def test_each_topic_has_the_displays_that_show_it(square: Dialog) -> None:
    assert rows_of(square.panel) == {}
    assert square.show() == [
        *("/joint_states", ".RobotModel", ".Effort", "/odom", ".Odometry"),
        *("/robot_description", ".RobotModel", "/scan", ".LaserScan"),
        *("/tf", ".TF", "/tf_static", ".TF"),
    ]
    edit(square.panel, "add_by_topic/show", [False, "", False])
    assert rows_of(square.panel) == {}


def test_names_are_parted_and_pictures_that_are_compressed_are_another_choice() -> None:
    types = {
        "/camera/image": IMAGE,
        "/camera/image/compressed": COMPRESSED,
        "/camera/image/small": IMAGE,
        "/camera/image-2/compressed": COMPRESSED,
        "no_slash": SCAN,
    }
    rows = {row.id: row for row in topic_rows(shown_topics(types), "x/")}
    tree = [name for name in tree_of(rows) if "Camera" not in name]
    assert [name for name in tree if "DepthCloud" not in name] == [
        *("/camera", "./image", "..Image", "..Image (compressed)"),
        *("../small", "...Image", "./image-2", "../compressed", "...Image"),
        *("no_slash", ".LaserScan"),
    ]
    chosen = next(row for row in rows.values() if row.name == "Image (compressed)")
    assert chosen.extra == {
        "display": "rviz_default_plugins/Image",
        "topic": "/camera/image/compressed",
    }


def test_a_topic_by_itself_stands_for_its_usual_display() -> None:
    (row, *_) = topic_rows(shown_topics({"/camera": IMAGE}), "x/")
    assert row.extra == {"display": "rviz_default_plugins/Image", "topic": "/camera"}


def test_topics_that_nothing_shows_come_when_they_are_asked_for(tmp_path: Path) -> None:
    source = write_recording(
        tmp_path / "r.mcap",
        {"/robot_description": described("base")},
        empty={"/front/imu": IMU, "/front/scan": SCAN},
    )
    with Visualizer(source, port=0) as viz:
        dialog = Dialog(session_of(viz))
        assert dialog.show("front") == ["/front", "./scan", "..LaserScan"]
        both = ["/front", "./imu", "./scan", "..LaserScan"]
        assert dialog.show("front", True) == both
        imu = next(r for r in rows_of(dialog.panel).values() if r.name == "/imu")
        assert imu.extra == {"off": True}
        assert (imu.value, imu.help) == (IMU, f"Nothing draws {IMU} yet.")
        assert dialog.show("imu") == []
        assert dialog.said() == [NOT_SHOWN]
        assert dialog.show("nothing has this", True) == []
        assert dialog.said() == ["No name has this in it"]


def test_of_thousands_of_topics_some_are_shown_and_the_search_finds_all(
    shared: Path,
) -> None:
    path = shared / "data" / "bags" / "made" / "many_topics.mcap"
    with Visualizer(path, port=0) as viz:
        dialog = Dialog(session_of(viz))
        dialog.show("", True)
        topics = [row for row in rows_of(dialog.panel).values() if row.value]
        assert len(topics) >= limits.ADDED_ROWS.value
        assert dialog.said() == [
            f"{4006 - limits.ADDED_ROWS.value:,} more: use the search"
        ]
        assert dialog.show("cell_39/door_99", True) == ["/cell_39", "./door_99"]


def test_without_a_source_the_list_says_what_to_do(
    make_viz: Callable[..., Visualizer],
) -> None:
    dialog = Dialog(session_of(make_viz()))
    assert dialog.show() == []
    assert dialog.said() == [NO_SOURCE]


def test_topics_of_a_live_robot_come_while_the_dialog_is_open(repository: Path) -> None:
    with (
        square_peer(repository, RobotPeer) as peer,
        Visualizer(source=peer.uri, port=0) as viz,
    ):
        session = session_of(viz)
        until(lambda: "/scan" in Dialog(session).show(), WAIT)
        dialog = Dialog(session)
        remade: list[object] = []
        for signal in dialog.panel.remade_by:
            signal.listeners.append(lambda: remade.append(None))
        assert "/late" not in dialog.show()
        before = len(remade)
        peer.advertise("/late", schema=SCAN)
        until(lambda: "/late" in dialog.show(), WAIT)
        until(lambda: len(remade) > before, WAIT)
        dialog.choose("rviz_default_plugins/LaserScan", "/late")
        assert dialog.names[-1] == "LaserScan"


# What a choice does


def test_a_topic_is_added_with_its_name_and_the_qos_that_suits_it(
    square: Dialog,
) -> None:
    square.choose(
        "rviz_default_plugins/RobotModel", "/robot_description", "Ours", "", 0
    )
    (first, *_) = square.session.document.config.displays
    assert (first.name, first.kind) == ("Ours", "rviz_default_plugins/RobotModel")
    assert first.get("Description Topic") == "/robot_description"
    assert first.get("Description Topic/Durability Policy") == "Transient Local"
    square.choose("rviz_default_plugins/RobotModel", "/joint_states")
    assert square.session.document.config.displays[-1].get("Description Topic") == ""


def test_a_topic_is_dropped_between_displays_and_into_a_group_and_undone(
    square: Dialog,
) -> None:
    session, before = square.session, square.names
    edit(square.add, "displays/add", ["rviz_common/Group", "Sensors", ""])
    group = session.document.config.displays[-1]
    square.choose("", "/scan", "", "", 1)
    assert square.names == [before[0], "LaserScan", *before[1:], "Sensors"]
    square.choose("", "/odom", "", square.id_of(group), 0)
    assert [one.name for one in group.displays] == ["Odometry"]
    with session.lock:
        assert session.history.undo(BROWSER) == "Add Odometry"
        assert group.displays == ()
        assert session.history.undo(BROWSER) == "Add LaserScan"
        assert square.names == [*before, "Sensors"]
        session.history.redo(BROWSER)
    assert square.names == [before[0], "LaserScan", *before[1:], "Sensors"]


@pytest.mark.parametrize(
    ("kind", "topic", "why"),
    [
        ("", "/nowhere", "there is no topic /nowhere"),
        ("x/Y", "/scan", r"Y \(x\) cannot be added"),
        (
            "rviz_default_plugins/Map",
            "/scan",
            r"Map \(rviz_default_plugins\) does not show sensor_msgs/msg/LaserScan",
        ),
    ],
)
def test_a_choice_that_cannot_be_meant_is_refused(
    square: Dialog, kind: str, topic: str, why: str
) -> None:
    before = square.names
    with pytest.raises(SambotVizError, match=why):
        square.choose(kind, topic)
    assert square.names == before


def test_a_topic_that_nothing_shows_says_so(tmp_path: Path) -> None:
    texts = {"/robot_description": described("base")}
    source = write_recording(tmp_path / "r.mcap", texts, empty={"/imu": IMU})
    with Visualizer(source, port=0) as viz:
        dialog = Dialog(session_of(viz))
        with pytest.raises(SambotVizError, match=f"/imu: nothing draws {IMU} yet"):
            dialog.choose("", "/imu", "", "", 0)
