"""A recording that is still made is followed over any web server, some seconds late."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from folder_server import FolderServer, folder_server
from live_peers import WAIT, Inbox, cdr_word, eventually
from lower_limit import lower
from parted_recording import PartedRecording
from patience import until

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.follow import conversation, followed_recording
from sambot_viz.sources.given import given_source
from sambot_viz.sources.live.address import without_secrets
from sambot_viz.sources.registry import is_live
from sambot_viz.sources.source import Source

Opened = Callable[[str], Source]
Parted = Callable[..., PartedRecording]


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ask for the list more often than every two seconds."""
    monkeypatch.setattr(followed_recording, "POLL", 0.02)


@pytest.fixture
def made(parted: Parted, tmp_path: Path) -> PartedRecording:
    made = parted(tmp_path / "run")
    made.say("wheels", topic="/tf_static")
    return made


@pytest.fixture
def server(made: PartedRecording) -> Iterator[FolderServer]:
    with folder_server(made.folder) as server:
        yield server


def says(source: Source, words: str) -> None:
    until(
        lambda: words in source.status.sentence,
        WAIT,
        not_yet=(),
        why=f"never {words!r}",
    )


def follow(opened: Opened, server: FolderServer, inbox: Inbox) -> Source:
    source = opened(server.address)
    source.subscribe("/words", inbox)
    return source


def test_what_is_recorded_comes_file_by_file_up_to_the_end(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one", "two")
    source = follow(opened, server, inbox)
    inbox.wait_for("one", "two")
    says(source, "About 0 s behind the recorder")
    assert source.status.is_connected and source.live is source
    assert source.topics()["/words"].schema.name == "std_msgs/msg/String"
    made.part("three")
    inbox.wait_for("one", "two", "three")
    made.say("four")
    made.end()
    inbox.wait_for("one", "two", "three", "four")
    says(source, "the recording has ended")
    # Each file was asked for once, and as a whole: the server knows no ranges.
    asked = [path for path, _ in server.answers if path.endswith(".mcap")]
    assert asked == [f"/run_{number}.mcap" for number in range(3)]


def test_a_page_that_opens_in_the_middle_has_the_newest_file_and_what_holds(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    made.part("two")
    source, held = follow(opened, server, inbox), Inbox()
    inbox.wait_for("two")
    assert "/run_0.mcap" not in [path for path, _ in server.answers]
    # It is late, and the topic was recorded before.
    source.subscribe("/tf_static", held)
    held.wait_for("wheels")
    made.part("three")
    inbox.wait_for("two", "three")
    # Each file has it, and it is handed on once.
    held.wait_for("wheels")


def test_the_list_is_sent_only_when_it_has_changed(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    follow(opened, server, inbox)
    eventually(lambda: ("/metadata.yaml", 304) in server.answers)


def test_a_list_that_was_read_while_it_was_written_changes_nothing(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    follow(opened, server, inbox)
    inbox.wait_for("one")
    path = made.folder / "metadata.yaml"
    made.part("two")
    whole = path.read_bytes()
    for cut in (
        whole[: whole.index(b"run_1") + 5],
        whole[: len(whole) // 2],
        b"",
        b"\n",
    ):
        # In one step, or the server would announce more than it sends.
        (made.folder / "cut").write_bytes(cut)
        (made.folder / "cut").rename(path)
        count = len(server.answers)
        eventually(lambda count=count: len(server.answers) > count + 2)
    (made.folder / "whole").write_bytes(whole)
    (made.folder / "whole").rename(path)
    inbox.wait_for("one", "two")
    assert {s for path, s in server.answers if path.endswith(".mcap")} == {200}


def test_a_file_that_is_missing_or_broken_costs_itself(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    source = follow(opened, server, inbox)
    inbox.wait_for("one")
    made.part("two")
    made.part("three")
    (made.folder / "run_1.mcap").unlink()
    (made.folder / "run_2.mcap").write_bytes(b"no recording")
    says(source, "2 files are missing or cannot be read")
    made.part("four")
    inbox.wait_for("one", "four")


def test_a_file_above_the_limit_is_left_out(
    made: PartedRecording,
    server: FolderServer,
    opened: Opened,
    inbox: Inbox,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "FOLLOWED_PART", 100)
    made.part("one")
    source = follow(opened, server, inbox)
    says(source, "1 file is missing or cannot be read")


def test_a_server_that_comes_back_goes_on_with_the_next_file(
    made: PartedRecording, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    with folder_server(made.folder) as server:
        source = follow(opened, server, inbox)
        inbox.wait_for("one")
        port = int(server.server_address[1])
    says(source, "there is no connection")
    made.part("two")
    with folder_server(made.folder, port):
        inbox.wait_for("one", "two")
        until(lambda: "connection" not in source.status.sentence, WAIT)
        assert source.status.is_connected and source.status.session == 1


def test_another_recording_in_its_place_is_another_session(
    parted: Parted, tmp_path: Path, opened: Opened, inbox: Inbox
) -> None:
    folder = tmp_path / "latest"
    folder.symlink_to(tmp_path / "monday")
    parted(tmp_path / "monday").part("one")
    parted(tmp_path / "tuesday").part("two")
    with folder_server(folder) as server:
        source = follow(opened, server, inbox)
        inbox.wait_for("one")
        (tmp_path / "new").symlink_to(tmp_path / "tuesday")
        (tmp_path / "new").rename(folder)
        inbox.wait_for("one", "two")
        assert source.status.session == 2


def test_a_recorder_that_says_nothing_more_is_told(
    made: PartedRecording,
    server: FolderServer,
    opened: Opened,
    inbox: Inbox,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(conversation, "SILENCE", 0.0)
    made.part("one")
    source = follow(opened, server, inbox)
    inbox.wait_for("one")
    made.kill()
    says(source, "nothing new for")


def test_secrets_of_an_address_are_not_shown(
    made: PartedRecording, server: FolderServer
) -> None:
    made.part("one")
    secret = server.address.replace("://", "://me:word@") + "?key=hidden"
    assert is_live(secret) and given_source(secret).is_live
    shown = without_secrets(secret)
    assert shown == server.address
    with pytest.raises(SourceError) as refused:
        open_recording(secret)
    said = str(refused.value) + str(refused.value.problems)
    assert "HTTP ranges" in said and "word" not in said and "hidden" not in said


def test_a_folder_whose_address_lacks_its_slash_is_named_as_such(
    made: PartedRecording,
) -> None:
    with folder_server(made.folder.parent) as server:
        with pytest.raises(SourceError, match="it is a folder: end its address with /"):
            open_recording(f"{server.address}run")


def test_a_follower_that_is_far_behind_goes_on_with_the_newest_file(
    made: PartedRecording, tmp_path: Path, opened: Opened, inbox: Inbox
) -> None:
    served = tmp_path / "served"

    def copy() -> None:
        """Copy what is recorded, and the list as the last."""
        served.mkdir(exist_ok=True)
        for name in made.names():
            shutil.copy(made.folder / name, served)
        shutil.copy(made.folder / "metadata.yaml", served / "new")
        (served / "new").rename(served / "metadata.yaml")

    made.part("one")
    copy()
    with folder_server(served) as server:
        follow(opened, server, inbox)
        inbox.wait_for("one")
        for number in range(9):
            made.part(f"{number}")
        copy()
        inbox.wait_for("one", "8")


def test_clocks_apart_and_clocks_that_are_set_do_not_stop_it(
    parted: Parted,
    tmp_path: Path,
    opened: Opened,
    inbox: Inbox,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(followed_recording, "LONGEST_GAP", 0.05)
    made = parted(tmp_path / "old", start_ns=5)
    made.part("one")
    with folder_server(made.folder) as server:
        follow(opened, server, inbox)
        inbox.wait_for("one")
        made.set_clock(10**18)
        made.part("two")
        made.set_clock(3 * 10**17)
        made.say("three")
        made.set_clock(4 * 10**17)
        made.part("four")
        inbox.wait_for("one", "two", "three", "four")


def test_a_folder_without_a_list_says_so_until_there_is_one(
    parted: Parted, tmp_path: Path, opened: Opened, inbox: Inbox
) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    with folder_server(folder) as server:
        source = follow(opened, server, inbox)
        says(source, "answered 404 File not found for metadata.yaml")
        assert not source.status.is_connected
        folder.rmdir()
        parted(folder).part("one")
        inbox.wait_for("one")


def test_nothing_can_be_sent_to_a_recording_that_is_followed(
    made: PartedRecording, server: FolderServer, opened: Opened, inbox: Inbox
) -> None:
    made.part("one")
    source = follow(opened, server, inbox)
    inbox.wait_for("one")
    with pytest.raises(SourceError, match="a recording is followed, and nothing can"):
        source.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
    with pytest.raises(SourceError, match="a recording is followed"):
        source.action("/navigate", "nav2_msgs/action/NavigateToPose")


def test_all_of_it_is_opened_as_a_recording_where_the_server_has_ranges(
    parted: Parted, made: PartedRecording, server: FolderServer
) -> None:
    made.part("one")
    with pytest.raises(SourceError, match=re.escape("it does not know HTTP ranges")):
        open_recording(server.address)
    empty = parted(made.folder / "empty")
    with pytest.raises(SourceError, match="names no file yet"):
        open_recording(f"{server.address}empty/")
    empty.end()
    server.has_ranges = True
    made.part("two")
    with open_recording(server.address) as recording:
        words = recording.messages(topics=["/words"])
        assert [cdr_word(one.payload) for one in words] == ["one", "two"]
