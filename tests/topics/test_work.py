"""What is said of topics costs the same for each, however many there are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from any_recording import FORMATS, STRING, TEXT, Given, write_any
from lower_limit import lower
from made_recording import store_of_all
from work import steps

from sambot_viz.commands.topics import topics_text
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

FEW, MANY = 100, 400
TRANSFORMS = "tf2_msgs/msg/TFMessage"


def topics(path: Path, at: float | None) -> str:
    """What ``sambot-viz topics`` prints, and what the page asks of each topic."""
    with open_recording(path) as recording:
        recorded = SourceRobot(
            RecordingPlayback(recording, path.name), MessageTypes(), at=at
        )
        survey = Survey(recorded)
        survey.finish()
        report = TopicReport(survey)
        for name in recording.topics:
            assert recording.topics[name].name == name
            report.last_ns(name, recording.end_ns or 0)
        assert recorded.problems is not None
        report.at_ns = recorded.at_ns
        return topics_text(report.accounts())


@pytest.mark.parametrize(
    ("type_name", "last"),
    [(STRING, ""), (TRANSFORMS, "/tf"), (TRANSFORMS, "/tf_static")],
)
@pytest.mark.parametrize("messages", [0, 2])
@pytest.mark.parametrize("kind", FORMATS)
def test_the_work_for_a_topic_does_not_grow_with_their_number(
    tmp_path: Path,
    kind: str,
    messages: int,
    type_name: str,
    last: str,
    monkeypatch: Any,
) -> None:
    # As in a long recording, which does not come to all topics at its beginning.
    lower(monkeypatch, "SURVEYED", FEW // 2)
    lower(monkeypatch, "SURVEYED_LATE", 10**9)
    store, empty = store_of_all(), b"\0\1\0\0\0\0\0\0"
    text = TEXT if type_name == STRING else store.generate_msgdef(TRANSFORMS)[0]

    def work(count: int) -> int:
        folder = tmp_path / str(count)
        folder.mkdir()
        given = [
            Given(f"/t{number}{last}", [empty] * messages, type_name, text)
            for number in range(count)
        ]
        path = write_any(folder, kind, given)
        topics(path, 0.001)
        return steps(lambda: topics(path, 0.001))

    assert work(MANY) < 1.25 * (MANY / FEW) * work(FEW)
