"""The Topics panel: what each topic of a recording has, and why it shows nothing."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.topics import MOST_SHOWN, TopicsPanel
from sambot_viz.session import Session


class Opened:
    """A Topics panel of a session; nothing plays."""

    def __init__(self, session: Session) -> None:
        assert session.data is not None
        self.session = session
        self.data = session.data
        self.data.player._ticking = True  # pyright: ignore[reportPrivateUsage]
        self.remade = 0
        self.panel = TopicsPanel(
            self.data.topics, self.data.player, session.scene, self._remake
        )

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
    assert opened.data.topics.report.rate("/tf") is None


def test_each_topic_has_its_facts_and_its_reason(opened: Opened) -> None:
    opened.look()
    shown = opened.values()
    assert [i for i in shown if "/" not in i.removeprefix("topic:/")] == [
        f"topic:/{name}"
        for name in ("joint_states", "odom", "robot_description", "scan")
    ] + ["topic:/tf", "topic:/tf_static"]
    assert shown["topic:/scan/type"] == "sensor_msgs/msg/LaserScan"
    assert shown["topic:/scan/count"] == "100"
    assert shown["topic:/scan/reason"].startswith("Nothing draws sensor_msgs/msg/Las")
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
    assert "add one" in opened.values()["topic:/tf/reason"]


def test_of_thousands_of_topics_some_are_shown_and_the_search_finds_all(
    many: Opened,
) -> None:
    many.look()
    shown = many.values()
    assert sum(1 for row_id in shown if row_id.endswith("/count")) == MOST_SHOWN
    assert shown["topics/more"] == f"{4006 - MOST_SHOWN:,} more: use the search"
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
