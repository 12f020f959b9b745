"""What became of a topic is said alike by all that say it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from image_messages import octets, raw
from inside import session_of
from live_peers import WAIT
from made_messages import write_messages
from made_recording import described, write_recording
from patience import until
from robot_peer import BusyPeer, square_peer

from sambot_viz import Visualizer
from sambot_viz.displays.data.topic_display import TopicDisplay
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.panels.sources.topics_panel import TopicsPanel
from sambot_viz.session import Session
from sambot_viz.sources.bag import open_recording
from sambot_viz.text import capitalized
from sambot_viz.topics.account import Account
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey

RECORDINGS = (
    *("reported/recordings/" + name for name in ("encodings", "images", "marker_cube")),
    *("reported/recordings/" + name for name in ("map_updates_jump", "nav2_12")),
    *("reported/bags/c04/c04", "reported/bags/c13_loop/c13_loop"),
    *("bags/made/" + name for name in ("two_clocks", "no_static", "flipped_payload")),
    *("bags/made/" + name for name in ("mixed", "wrong_definition", "clock_back")),
)
NOT_IN_LISTS = {"off", "no-display"}
"""Reasons that the command line does not have: it has no displays."""


@contextmanager
def opened(path: Path) -> Generator[tuple[Visualizer, Session]]:
    """A page of a recording without a config, at its end."""
    with Visualizer(path, port=0) as viz:
        viz.player.pause()
        viz.player.jump(viz.player.duration)
        yield viz, session_of(viz)


def listed(path: Path) -> dict[str, str]:
    """Topic → what ``sambot-viz topics --at`` the end says of it."""
    with Inputs(Options(path)) as inputs:
        assert inputs.moved_by is not None
        survey = Survey(inputs.moved_by)
        survey.finish()
        report = TopicReport(survey)
        report.at_ns = survey.recording.end_ns
        return {one.name: sentence(one) for one in report.accounts()}


def sentence(account: Account) -> str:
    reason = account.reason
    return "" if reason is None else capitalized(reason.text)


def in_panel(session: Session) -> dict[str, str]:
    """Topic → what its row in the panel Topics says."""
    panel = TopicsPanel(session.sources, session.scene.statuses, lambda one: None)
    with session.change():
        {one.id: one for one in panel.commands()}["topics/show"].run(True)
        rows = {row.id: row for row in panel.rows()}
        panel.close()
    return {
        name: str(rows[f"topic:{name}/reason"].value).removesuffix(".")
        if f"topic:{name}/reason" in rows
        else ""
        for name in session.data.topics.names
    }


def drawn(session: Session) -> Iterator[tuple[TopicDisplay, str]]:
    """Yield the displays that are on, with the worst of what their statuses say."""
    for display in session.scene.displays:
        if isinstance(display, TopicDisplay) and display.shown and display.topic:
            rows = display.status.rows.values()
            said = [row.text for row in rows if row.level != "Ok"]
            yield display, said[0] if said else ""


@pytest.mark.parametrize("name", RECORDINGS)
def test_lists_panels_statuses_problems_and_programs_agree(
    shared: Path, name: str
) -> None:
    path = shared / "data" / f"{name}.mcap"
    said = listed(path)
    with opened(path) as (viz, session):
        accounts = viz.topics
        assert in_panel(session) == {n: sentence(one) for n, one in accounts.items()}
        for topic, account in accounts.items():
            code = "" if account.reason is None else account.reason.code
            if code not in NOT_IN_LISTS or said[topic]:
                assert sentence(account) == said[topic], topic
        with session.change():
            problems = [str(one.message) for one in session.problems.shown.value.listed]
            for display, text in drawn(session):
                account = accounts[display.topic]
                told = sentence(account)
                assert bool(text) == (told != ""), (display.topic, text, told)
                assert told in text, display.topic
                if account.reason is not None and account.reason.severity != "info":
                    known = [one for one in problems if display.topic in one]
                    assert any(told in one for one in known), problems


def test_a_loop_is_said_of_the_topic_that_tells_of_it(shared: Path) -> None:
    path = shared / "data" / "reported" / "bags" / "c13_loop"
    said = "odom -> body on /tf and body -> odom on /tf"
    with opened(path) as (viz, session):
        assert said in sentence(viz.topics["/tf"])
        assert said in in_panel(session)["/tf"]


OF_TIME = {"stale", "not-here-yet", "not-listened"}
"""What is so of a robot, or of a recording, alone."""
NEWEST_ONLY = "bags/made/flipped_payload"
"""Of a robot the newest message is looked into, and one of thirty is broken here."""


class WholePeer(BusyPeer):
    until_s = 1e6


def codes_of(viz: Visualizer) -> dict[str, str]:
    return {n: a.reason.code if a.reason else "" for n, a in viz.topics.items()}


@pytest.mark.parametrize("name", [one for one in RECORDINGS if one != NEWEST_ONLY])
def test_a_robot_and_its_recording_give_the_same_reasons(
    shared: Path, name: str
) -> None:
    path = shared / "data" / f"{name}.mcap"
    with opened(path) as (viz, session):
        recorded, fixed = codes_of(viz), session.scene.context.fixed_frame
    with open_recording(path) as played:
        peer = WholePeer(played)
        try:
            with Visualizer(source=peer.uri, fixed_frame=fixed, port=0) as viz:
                session = session_of(viz)
                assert session.data is not None
                topics = session.data.topics

                def agree() -> bool:
                    with session.change():
                        topics.follow("test", topics.names)
                    live = codes_of(viz)
                    return live.keys() == recorded.keys() and all(
                        live[one] == code or {live[one], code} & OF_TIME
                        for one, code in recorded.items()
                    )

                until(agree, WAIT, not_yet=(KeyError,))
        finally:
            peer.stop()


def test_a_loop_is_in_the_status_of_tf(shared: Path) -> None:
    path = shared / "data" / "reported" / "recordings" / "tf_ring_direct.mcap"
    with opened(path) as (viz, session), session.change():
        (tf,) = (one for one in session.scene.displays if one.config.name == "TF")
        assert tf.status.rows["/tf"].text == sentence(viz.topics["/tf"])
        assert tf.status.level == "Warn"
        assert tf.status.rows["/tf"].code == "tf-loop"


def test_a_clock_that_goes_back_is_a_problem_before_it_is_played(shared: Path) -> None:
    path = shared / "data" / "bags" / "made" / "clock_back.mcap"
    with Visualizer(path, port=0) as viz:
        viz.player.pause()
        session = session_of(viz)
        assert viz.player.time == 0.0

        def codes() -> set[str]:
            return {one.code for one in session.problems.shown.value.listed}

        until(lambda: "clock-back" in codes(), WAIT)
        viz.player.jump(viz.player.duration)
        assert "clock-back" in codes()


def test_transforms_that_are_not_taken_say_what_hides_them(tmp_path: Path) -> None:
    told = [("/tf", 0.0, {"base": "odom"}), ("/b/tf", 1.0, {"base": "odom"})]
    path = write_recording(
        tmp_path / "two.mcap", {"/robot_description": described("base", "arm")}, told
    )
    with opened(path) as (viz, _):
        said = sentence(viz.topics["/b/tf"])
    assert said == listed(path)["/b/tf"]
    assert said.startswith("Its frames are hidden by those of /tf: with /b/robot_desc")


def test_pictures_that_no_display_shows_have_no_tick(tmp_path: Path) -> None:
    shown = [raw("rgb8", octets(1, 2, 3, 4, 5, 6))]
    path = write_messages(tmp_path / "a.mcap", *shown)
    with opened(path) as (viz, session):
        assert viz.topics["/a"].reason is None
        with session.change():
            display = next(d for d, _ in drawn(session) if d.topic == "/a")
            session.display_edits.remove_display(display.config)
        assert sentence(viz.topics["/a"]) == "Not shown: add an Image display"


def test_a_robot_that_leaves_takes_its_ticks_along(repository: Path) -> None:
    with (
        square_peer(repository, BusyPeer) as peer,
        Visualizer(source=peer.uri, port=0) as viz,
    ):
        session = session_of(viz)
        until(lambda: viz.topics["/scan"].count, WAIT, not_yet=(KeyError,))
        until(lambda: viz.topics["/scan"].reason is None, WAIT)
        peer.stop()

        def codes() -> set[str]:
            return {a.reason.code if a.reason else "" for a in viz.topics.values()}

        until(lambda: codes() == {"not-connected"}, WAIT)

        def agree() -> bool:
            with session.change():
                session.scene.time_passed()
                rows = {d.topic: d.status.rows["Topic"] for d, _ in drawn(session)}
            assert rows["/scan"].level == "Warn"
            return rows["/scan"].text == sentence(viz.topics["/scan"])

        # First the connection has ended, and then nothing listens there.
        until(agree, WAIT)
