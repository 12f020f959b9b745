"""The Topics panel: what each topic of a recording has, and why it shows nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from filled_messages import DEFINITIONS, MAP_UPDATE, on_topic
from inside import session_of
from live_peers import WAIT
from made_messages import write_messages
from patience import until
from protocol_client import wait_for_workers
from robot_peer import BusyPeer, square_peer

from sambot_viz import Visualizer, bundled, limits
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.sources.topics_panel import TopicsPanel
from sambot_viz.session import Session
from sambot_viz.session.signals import connect
from sambot_viz.topics import live_evidence


class Opened:
    """A Topics panel of a session; nothing plays."""

    def __init__(self, session: Session) -> None:
        assert session.data is not None
        self.session = session
        self.data = session.data
        if self.data.player is not None:
            self.data.player._ticking = True  # pyright: ignore[reportPrivateUsage]
        self.remade = 0
        self.panel = TopicsPanel(session.sources, session.scene.statuses, self._remake)
        connect(self.data.topics.remade_by, lambda: self._remake(self.panel))

    def _remake(self, panel: Panel) -> None:
        self.remade += 1

    def run(self, command_id: str, *arguments: Any) -> None:
        found = {one.id: one for one in self.panel.commands()}
        with self.session.lock:
            found[command_id].run(*arguments)

    def look(self) -> None:
        """Open the panel, and look at all messages at once."""
        survey = self.data.topics._survey  # pyright: ignore[reportPrivateUsage]
        with self.session.lock:
            survey.finish()
        self.run("topics/show", True)
        # The worker tells that all was looked at.
        wait_for_workers()

    def values(self) -> dict[str, Any]:
        with self.session.lock:
            return {row.id: row.value for row in self.panel.rows()}


@pytest.fixture
def opened(repository: Path) -> Iterator[Opened]:
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        yield Opened(session_of(viz))


@pytest.fixture
def many(shared: Path) -> Iterator[Opened]:
    path = shared / "data" / "bags" / "made" / "many_topics.mcap"
    with Visualizer(path, port=0) as viz:
        yield Opened(session_of(viz))


def test_nothing_is_looked_at_before_somebody_opens_the_panel(opened: Opened) -> None:
    assert list(opened.values()) == ["topics/wait"]
    assert opened.panel.values() == {}
    assert list(opened.panel.moved_by) == []
    assert opened.data.topics.rate("/tf") is None


def test_each_topic_has_its_facts_and_its_reason(opened: Opened) -> None:
    opened.look()
    shown = opened.values()
    assert [i for i in shown if "/" not in i.removeprefix("topic:/")] == [
        f"topic:/{name}"
        for name in ("joint_states", "odom", "robot_description", "scan")
    ] + ["topic:/tf", "topic:/tf_static"]
    assert shown["topic:/scan/type"] == "sensor_msgs/msg/LaserScan"
    assert shown["topic:/scan/count"] == "100"
    # What a recording has is seen at first.
    assert "topic:/scan/reason" not in shown
    assert "topic:/tf/reason" not in shown
    assert shown["topic:/tf"].startswith("50 Hz")


def test_the_age_is_on_the_clock_of_the_player(opened: Opened) -> None:
    opened.look()
    opened.values()
    with opened.session.lock:
        opened.data.player.jump(opened.data.player.start_ns + 10_050_000_000)
        at_10 = opened.panel.values()["topic:/robot_description"]
    assert at_10.startswith("10.0 s ago") or at_10.startswith("10.1 s ago")
    assert opened.data.player.stepped in opened.panel.moved_by
    opened.run("topics/show", False)
    assert opened.panel.values() == {}


def test_a_topic_that_has_begun_is_there_without_a_hand(shared: Path) -> None:
    path = shared / "data" / "bags" / "made" / "description_late.mcap"
    with Visualizer(path, port=0) as viz:
        opened = Opened(session_of(viz))
        opened.look()
        text = opened.values()["topic:/robot_description/reason"]
        assert text.startswith("Begins at 3.0 s")
        before = opened.remade
        with opened.session.lock:
            opened.panel.values()
            assert opened.remade == before
            opened.data.player.advance(3.5)
            opened.panel.values()
        assert opened.remade == before + 1
        assert "topic:/robot_description/reason" not in opened.values()


def test_updates_of_a_map_are_drawn_by_the_display_of_the_map(tmp_path: Path) -> None:
    update = on_topic(MAP_UPDATE, "/map_updates")
    path = write_messages(tmp_path / "made.mcap", update, definitions=DEFINITIONS)
    config = tmp_path / "map.rviz"
    config.write_text("Visualization Manager: {Displays: []}")
    with Visualizer(path, config=config, port=0) as viz:
        opened = Opened(session_of(viz))
        opened.look()
        reason = opened.values()["topic:/map_updates/reason"]
    assert reason == "Not shown: add a Map display."


def test_a_display_that_is_off_or_missing_is_the_reason(opened: Opened) -> None:
    opened.look()
    with opened.session.lock:
        tf = next(
            d
            for d in opened.session.scene.displays
            if d.config.kind == "rviz_default_plugins/TF"
        )
        opened.session.display_edits.set_enabled(tf, enabled=False)
    assert opened.values()["topic:/tf/reason"] == "The display TF is off: tick its box."
    with opened.session.lock:
        opened.session.display_edits.remove_display(tf.config)
    assert "add a" in opened.values()["topic:/tf/reason"]


def test_of_thousands_of_topics_some_are_shown_and_the_search_finds_all(
    many: Opened,
) -> None:
    many.look()
    shown = many.values()
    assert (
        sum(1 for row_id in shown if row_id.endswith("/count"))
        == limits.TOPIC_ROWS.value
    )
    assert (
        shown["topics/more"]
        == f"{4006 - limits.TOPIC_ROWS.value:,} more: use the search"
    )
    many.run("topics/find", "cell_39 door_99")
    found = many.values()
    assert next(iter(found)) == "topic:/cell_39/door_99"
    assert "topics/more" not in found
    many.run("topics/find", "nothing-has-this")
    assert list(many.values()) == ["topics/none"]


def test_viewers_may_look_and_search(opened: Opened) -> None:
    assert all(one.client_local for one in opened.panel.commands())
    assert all(row.set is None for row in opened.panel.rows())


def test_a_reset_of_the_clock_is_a_problem_once_it_was_played(shared: Path) -> None:
    path = shared / "data" / "bags" / "made" / "clock_back.mcap"
    with Visualizer(path, port=0) as viz:
        session = session_of(viz)
        assert session.data is not None

        def codes() -> list[str]:
            return [problem.code for problem in session.problems.shown.value.listed]

        assert "clock-back" not in codes()
        with session.lock:
            session.data.player.advance(8.0)
        assert "clock-back" in codes()


def test_two_parents_are_a_problem_from_the_start(shared: Path) -> None:
    path = shared / "data" / "bags" / "made" / "two_parents.mcap"
    with Visualizer(path, port=0) as viz:
        listed = session_of(viz).problems.shown.value.listed
        assert [p.code for p in listed].count("two-parents") == 1


class LiveOpened(Opened):
    """The same of a robot on the network, whose page nobody has open."""

    def look(self) -> None:
        self.run("topics/show", True)

    def until_shown(self, condition: Callable[[dict[str, Any]], object]) -> None:
        def holds() -> bool:
            with self.session.lock:
                self.panel.values()
            return bool(condition(self.values()))

        until(holds, WAIT, not_yet=(AssertionError, KeyError))


@pytest.fixture
def peer(repository: Path) -> Iterator[BusyPeer]:
    with square_peer(repository, BusyPeer) as peer:
        yield peer


@pytest.fixture
def live(peer: BusyPeer) -> Iterator[LiveOpened]:
    # Without a config all topics would be drawn.
    with Visualizer(source=peer.uri, port=0, config=bundled.config_path()) as viz:
        until(
            lambda: session_of(viz).robot.model.name == "sam_bot",
            WAIT,
            not_yet=(AttributeError,),
        )
        yield LiveOpened(session_of(viz))


def test_a_live_topic_is_listened_to_while_its_row_is_on_the_screen(
    live: LiveOpened, peer: BusyPeer
) -> None:
    assert "/scan" not in peer.subscribed()
    live.look()
    # These come one after the other.
    wanted = {
        "topic:/scan/count": "46",
        "topic:/scan/reason": "Not shown: add a LaserScan display.",
        "topic:/robot_description/count": "1",
    }
    live.until_shown(lambda shown: wanted.items() <= shown.items())
    shown = live.values()
    assert shown["topic:/scan/type"] == "sensor_msgs/msg/LaserScan"
    assert shown["topic:/scan"].endswith("s ago")
    live.run("topics/find", "tf")
    live.values()
    until(lambda: "/scan" not in peer.subscribed(), WAIT)
    live.run("topics/find", "")
    live.values()
    until(lambda: "/scan" in peer.subscribed(), WAIT)
    live.run("topics/show", False)
    until(lambda: "/scan" not in peer.subscribed(), WAIT)
    assert "/tf" in peer.subscribed()


def test_a_page_that_leaves_listens_to_nothing(
    live: LiveOpened, peer: BusyPeer
) -> None:
    live.look()
    live.values()
    until(lambda: "/scan" in peer.subscribed(), WAIT)
    with live.session.lock:
        live.panel.close()
    until(lambda: "/scan" not in peer.subscribed(), WAIT)


def test_live_topics_that_appear_have_rows(live: LiveOpened, peer: BusyPeer) -> None:
    live.look()
    assert "topic:/late" not in live.values()
    peer.advertise("/late")
    live.until_shown(lambda shown: "topic:/late" in shown)
    until(lambda: "/late" in peer.subscribed(), WAIT)
    peer.publish("/late", "hello")
    live.until_shown(lambda shown: shown["topic:/late/count"] == "1")
    peer.remove("/late")
    live.until_shown(lambda shown: "topic:/late" not in shown)


def test_large_messages_come_when_their_row_is_chosen(
    live: LiveOpened, peer: BusyPeer
) -> None:
    peer.advertise("/camera", schema="sensor_msgs/msg/Image")
    live.look()
    live.until_shown(lambda shown: "select this row" in shown["topic:/camera/reason"])
    assert "/camera" not in peer.subscribed()
    live.run("topics/choose", "/camera")
    until(lambda: "/camera" in peer.subscribed(), WAIT)
    live.run("topics/choose", "/scan")
    until(lambda: "/camera" not in peer.subscribed(), WAIT)


def test_why_nothing_of_a_live_topic_is_seen(
    live: LiveOpened, peer: BusyPeer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_evidence, "SILENT_AFTER", 0.0)
    peer.advertise("/silent")
    peer.advertise("/odd", schema="nobody_msgs/msg/Nothing")
    live.look()
    live.until_shown(
        lambda shown: "nothing has come" in shown["topic:/silent/reason"].lower()
    )
    until(lambda: "/silent" in peer.subscribed(), WAIT)
    peer.publish("/silent", "hello")
    live.until_shown(
        lambda shown: "nothing draws" in shown["topic:/silent/reason"].lower()
    )
    peer.advertise("/broken")
    live.until_shown(lambda shown: "topic:/broken" in shown)
    until(lambda: "/broken" in peer.subscribed(), WAIT)
    peer.log("/broken", b"\0\1\0\0\xff\xff\xff\xff")
    live.until_shown(lambda shown: "be decoded" in shown["topic:/broken/reason"])
    # Nothing was recorded.
    assert "look at what publishes it" in live.values()["topic:/broken/reason"]
    with live.session.lock:
        live.session.document.set_option("Fixed Frame", "nowhere")
    live.until_shown(lambda shown: "Frame [nowhere]" in shown["topic:/scan/reason"])


def test_while_the_connection_is_lost_topics_are_not_to_blame(
    live: LiveOpened, peer: BusyPeer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_evidence, "SILENT_AFTER", 0.0)
    peer.advertise("/silent")
    live.look()
    live.until_shown(lambda shown: "has come yet" in shown["topic:/silent/reason"])
    assert "Hz" not in live.values()["topic:/tf_static"]
    peer.stop()
    live.until_shown(lambda shown: "has come yet" not in shown["topic:/silent/reason"])


def test_however_many_look_a_topic_is_looked_at_once_a_second(
    live: LiveOpened, monkeypatch: pytest.MonkeyPatch
) -> None:
    topics, asked = live.data.topics, list[str]()
    assert topics is not None
    live.look()
    scene = live.session.scene
    others = [
        TopicsPanel(live.session.sources, scene.statuses, lambda panel: None)
        for _ in range(2)
    ]
    with live.session.lock:
        live.panel.rows()
        for panel in others:
            {one.id: one for one in panel.commands()}["topics/show"].run(True)
            panel.rows()
        account = topics.account
        monkeypatch.setattr(topics, "account", lambda n: asked.append(n) or account(n))
        topics._tick()  # pyright: ignore[reportPrivateUsage]
        for panel in (live.panel, *others):
            panel.values()
        assert sorted(asked) == sorted(topics.names)
        for panel in others:
            panel.close()
