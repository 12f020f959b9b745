"""Messages before the first transform, after the last one, and older than tf2 keeps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from made_recording import START, write_recording

from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

Ask = Callable[[Sequence[tuple[float, float]], float], TopicReason | None]


@pytest.fixture
def ask(tmp_path: Path) -> Ask:
    """The reason of /scan at a time; the transforms are from 3.0 to 20.0 s."""

    def reason(scans: Sequence[tuple[float, float]], at: float) -> TopicReason | None:
        told = [("/tf", 3.0 + n / 10, {"base": "odom"}) for n in range(171)]
        path = write_recording(tmp_path / "scans.mcap", {}, told, scans=scans)
        with open_recording(path) as recording:
            survey = Survey(
                SourceRobot(RecordingPlayback(recording, path.name), MessageTypes())
            )
            survey.finish()
            at_ns = START * 10**9 + round(at * 1e9)
            report = TopicReport(survey)
            report.at_ns = at_ns
            return report.account("/scan").reason

    return reason


def has_place(reason: TopicReason | None) -> bool:
    """Whether nothing is wrong with it."""
    return reason is None


def stamp(seconds: float) -> str:
    return f"{START + seconds:.6f}"


def test_a_message_between_transforms_has_its_place(ask: Ask) -> None:
    assert has_place(ask([(0.0, 0.0), (5.0, 5.0)], 5.0))
    # The next transform comes soon, or the recording has ended just before it.
    assert has_place(ask([(0.0, 0.0), (5.05, 5.05)], 5.05))
    assert has_place(ask([(0.0, 0.0), (20.1, 20.1)], 20.1))


def test_before_the_first_transform_it_is_said_when_that_comes(ask: Ask) -> None:
    found = ask([(0.0, 0.0), (1.0, 1.0)], 1.0)
    assert found == TopicReason(
        "no-transform",
        "For frame [base]: Fixed Frame [odom] does not exist. Transforms begin at 3.0 "
        "s: go there with the time bar or --at 3.0",
    )
    found = ask([(0.0, 0.0), (2.9, 2.9)], 3.5)
    assert found == TopicReason(
        "no-transform",
        "No transform to fixed frame [odom]. TF error: [Lookup would require "
        "extrapolation into "
        f"the past.  Requested time {stamp(2.9)} but the earliest data is at time "
        f"{stamp(3.0)}, when looking up transform from frame [base] to frame [odom]]. "
        "Transforms begin at 3.0 s, and this message is from before: go on to the "
        "next one",
    )


def test_after_the_last_transform_its_publisher_had_stopped(ask: Ask) -> None:
    found = ask([(0.0, 0.0), (22.0, 22.0)], 22.0)
    assert found == TopicReason(
        "no-transform",
        "No transform to fixed frame [odom]. TF error: [Lookup would require "
        "extrapolation into "
        f"the future.  Requested time {stamp(22.0)} but the latest data is at time "
        f"{stamp(20.0)}, when looking up transform from frame [base] to frame [odom]]. "
        "The last transform is 2.0 s older than the message: what publishes it had "
        "stopped, go back in time",
    )


def test_a_message_whose_stamp_is_ahead_or_behind_has_another_clock(ask: Ask) -> None:
    found = ask([(0.0, 0.0), (9.0, 5.0)], 5.0)
    assert found is not None
    assert "The newest transform is 4.0 s older than the message: what " in found.text
    found = ask([(0.0, 0.0), (4.0, 16.0)], 16.0)
    assert found is not None
    assert found.text.endswith(
        "Tf2 keeps 10 s, and the message is 2.0 s older: what publishes it is too "
        "slow, or stamps it with another clock"
    )
