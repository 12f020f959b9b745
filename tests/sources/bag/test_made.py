"""Recordings of sam_bot in every format, whole and damaged, as their list expects."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz.errors import Problem, SourceError
from sambot_viz.sources.bag import Recording, open_recording

MADE = """square.mcap square_fastwrite.mcap square_noindex.mcap square_jazzy
    square_humble square.bag cut60.db3 cut60.bag killed_db3 custom_type_humble
    cut60.mcap cut60_fastwrite.mcap killed zeros_at_end.mcap
    flipped_chunk.mcap flipped_payload.mcap flipped_length.mcap flipped_footer.mcap
    empty.mcap garbage.mcap magic_only.mcap no_messages.mcap text.db3 only_metadata
    stale_metadata other_qos split clock_back.mcap log_back.mcap static_at_start.mcap
    static_three.mcap no_description.mcap no_static.mcap joints_only.mcap
    two_parents.mcap two_clocks.mcap description_late.mcap custom_type.mcap
    service_event.mcap mixed.mcap profile_empty.mcap ros1_profile.mcap old_names.mcap
    trailing.mcap wrong_definition.mcap broken_definition.mcap
    many_topics.mcap""".split()


@pytest.fixture(scope="module")
def made(shared: Path) -> Path:
    return shared / "data" / "bags" / "made"


@pytest.fixture(scope="module")
def expected(made: Path) -> dict[str, Any]:
    text = (made / "index.yaml").read_text("utf-8")
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def opened(path: Path) -> tuple[Recording | None, tuple[Problem, ...]]:
    """The recording with all of its messages found, and what is said about it."""
    try:
        recording = open_recording(path)
    except SourceError as error:
        return None, error.problems
    while not recording.is_complete:
        recording.index_more()
    return recording, recording.problems


def test_every_recording_of_the_list_is_tested(expected: dict[str, Any]) -> None:
    assert set(MADE) == set(expected)


@pytest.mark.parametrize("name", MADE)
def test_what_is_readable_is_read_and_one_sentence_says_what_is_lost(
    name: str, made: Path, expected: dict[str, Any]
) -> None:
    want = expected[name]
    recording, problems = opened(made / name)
    said = want.get("say", [])
    about_file = [
        one
        for one in (said if isinstance(said, list) else [said])
        if one["about"] == "file"
    ]
    assert [problem.code for problem in problems] == [
        one["reason"] for one in about_file
    ]
    for problem, one in zip(problems, about_file, strict=True):
        assert all(word in problem.message for word in one["words"]), problem.message
        assert problem.hint
    if recording is None:
        assert want["messages"] == 0
        return
    with recording:
        counts = Counter(message.topic for message in recording.messages())
        least = want.get("also", {}).get("padded", want["messages"])
        assert counts.total() == least
        if want.get("time"):
            assert [recording.start_ns, recording.end_ns] == want["time"]
        for name, topic in want.get("topics", {}).items():
            found = recording.topics[name]
            assert (counts[name], found.count) == (topic["messages"],) * 2
            plain = found.schema.name.replace("/msg/", "/")
            assert plain == topic["type"].replace("/msg/", "/")
            assert found.message_encoding == topic["encoding"]
            if topic["latched"] is not None:
                assert found.is_latched is topic["latched"]
        others = want.get("more_topics", 0)
        if want.get("topics"):
            assert len(recording.topics) == len(want["topics"]) + others


def test_latched_messages_are_collected_from_all_files(made: Path) -> None:
    kept = {"/robot_description": 1, "/tf_static": 3}
    with open_recording(made / "static_three.mcap") as recording:
        assert Counter(m.topic for m in recording.latched()) == kept
    kept["/tf_static"] = 2
    for name in ("split", "static_at_start.mcap", "other_qos"):
        with open_recording(made / name) as recording:
            assert Counter(m.topic for m in recording.latched()) == kept, name
    with open_recording(made / "description_late.mcap") as recording:
        assert Counter(m.topic for m in recording.latched()) == kept
        (late,) = [m for m in recording.latched() if m.topic == "/robot_description"]
        assert late.log_ns - (recording.start_ns or 0) > 2.9e9
    with open_recording(made / "service_event.mcap") as recording:
        assert Counter(m.topic for m in recording.latched()) == kept


def test_a_split_recording_is_in_the_order_of_its_first_messages(made: Path) -> None:
    with open_recording(made / "split") as recording:
        assert [path.name for path in recording.paths] == [
            "split_0.mcap",
            "split_1.mcap",
        ]
        times = [message.log_ns for message in recording.messages()]
        assert times == sorted(times)
        middle = times[len(times) // 2]
        for at in (middle - 1, middle, middle + 1):
            last = recording.last("/tf", at)
            following = recording.next("/tf", at)
            assert last is not None
            assert following is not None
            tf = [m.log_ns for m in recording.messages(topics=["/tf"])]
            assert last.log_ns == max(time for time in tf if time <= at)
            assert following.log_ns == min(time for time in tf if time > at)


def test_files_side_by_side_are_one_recording(made: Path) -> None:
    paths = [made / "no_static.mcap", made / "static_three.mcap"]
    with open_recording(paths) as recording:
        assert recording.topics["/tf_static"].count == 3
        assert recording.topics["/tf"].count == 600
        times = [message.log_ns for message in recording.messages()]
        assert len(times) == 511 + 514
        assert times == sorted(times)


def test_one_refused_file_of_a_folder_costs_only_itself(
    tmp_path: Path, made: Path
) -> None:
    (tmp_path / "a.mcap").write_bytes((made / "split" / "split_1.mcap").read_bytes())
    (tmp_path / "b.mcap").write_bytes(b"")
    with open_recording(tmp_path) as recording:
        assert sum(1 for _ in recording.messages()) == 257
        assert [problem.code for problem in recording.problems] == ["file-empty"]
    (tmp_path / "a.mcap").unlink()
    with pytest.raises(SourceError, match="is empty"):
        open_recording(tmp_path)
    (tmp_path / "b.mcap").unlink()
    with pytest.raises(SourceError, match=r"no \.mcap"):
        open_recording(tmp_path)
    with pytest.raises(SourceError, match="there is no such file"):
        open_recording(tmp_path / "no.mcap")
