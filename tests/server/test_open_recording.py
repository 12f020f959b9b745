"""Another recording takes the place of the one that is shown, as if begun with it."""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from lower_limit import lower
from made_recording import described, write_recording
from patience import until
from protocol_client import ProtocolClient

from sambot_viz import UsageError, Visualizer
from sambot_viz.errors import SourceError
from sambot_viz.session import Session
from sambot_viz.sources.bag.file_bytes import FileBytes

Protocol = Callable[..., ProtocolClient]
PLACED = "robot", "/robot_description"
CONFIG = """Visualization Manager:
  Global Options:
    Fixed Frame: base
  Displays:
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: Scan
      Topic:
        Value: /scan
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: Robot
      Description Topic:
        Value: /robot_description
"""


@pytest.fixture
def folder(tmp_path: Path, repository: Path) -> Path:
    """Recordings with a robot, without, with a ring, with nothing, and broken ones."""
    robot = {"/robot_description": described("base", "arm")}
    moved = [("/tf", t, {"base": "odom"}) for t in (0.0, 1.0, 2.0)]
    scans = [(t, t) for t in (0.0, 1.0, 2.0)]
    write_recording(tmp_path / "robot.mcap", robot, moved, scans=scans)
    other = {"/robot_description": described("base", "neck", "head", radius=0.5)}
    held = [("/tf", t, {"base": "map", "neck": "base"}) for t in (0.0, 4.0)]
    write_recording(
        tmp_path / "other.mcap", other, held, {"/empty": "std_msgs/msg/Empty"}
    )
    write_recording(tmp_path / "frames.mcap", {"/note": "hello"}, moved, scans=scans)
    ring = [("/tf", t, {"a": "b", "b": "a", "base": "odom"}) for t in (0.0, 1.0)]
    write_recording(tmp_path / "ring.mcap", {}, ring)
    write_recording(tmp_path / "texts.mcap", {"/note": "nothing to see"})
    (tmp_path / "square.mcap").write_bytes(
        (repository / "assets" / "square.mcap").read_bytes()
    )
    whole = (tmp_path / "robot.mcap").read_bytes()
    (tmp_path / "broken.mcap").write_bytes(b"no recording" + whole[12:])
    (tmp_path / "empty.mcap").write_bytes(b"")
    (tmp_path / "look.rviz").write_text(CONFIG)
    return tmp_path


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[FileBytes]:
    """The files of recordings that are open."""
    made: list[FileBytes] = []
    begin, close = FileBytes.__init__, FileBytes.close

    def opening(self: FileBytes, *given: Any) -> None:
        begin(self, *given)
        made.append(self)

    def closing(self: FileBytes) -> None:
        close(self)
        made[:] = [one for one in made if one is not self]

    monkeypatch.setattr(FileBytes, "__init__", opening)
    monkeypatch.setattr(FileBytes, "close", closing)
    return made


@pytest.fixture
def show() -> Iterator[Callable[..., Visualizer]]:
    """Show a recording; each is stopped at the end of the test."""
    made: list[Visualizer] = []

    def make(path: Path, **options: Any) -> Visualizer:
        made.append(Visualizer(path, port=0, **options))
        return made[-1]

    yield make
    for viz in made:
        viz.stop()


def seen(viz: Visualizer) -> dict[str, Any]:
    """What the session of a server shows, once all is read and found."""
    session = session_of(viz)
    viz.server.sessions.wait_for_meshes(30.0)
    session.checks.run()
    accounts = {name: account.reason for name, account in viz.topics.items()}
    with session.lock:
        data, tree, player = session.data, session.scene.context.tree, viz.player
        assert data is not None
        data.begin()
        nodes = session.audience.scene._handle_from_node_name  # pyright: ignore
        return {
            "topics": accounts,
            "frames": {f: tree.parent(f) for f in sorted(tree.frames)},
            "poses": {
                f: tree.lookup(session.scene.context.fixed_frame, f)
                .matrix.round(6)
                .tolist()
                for f in sorted(tree.frames)
                if tree.can_lookup(session.scene.context.fixed_frame, f)
            },
            "robot": session.robot.model and session.robot.model.name,
            "joints": dict(viz.joint_positions),
            "follows": session.robot.followed.value,
            "config": session.document.config.to_yaml(),
            "statuses": {
                one.config.name: {
                    k: (r.level, r.text) for k, r in one.status.rows.items()
                }
                for one in session.scene.displays
            },
            "nodes": len(nodes),
            "problems": sorted(
                {str(one) for one in session.problems.shown.value.listed}
            ),
            "player": (viz.player.duration, viz.player.time, player.playing),
        }


@pytest.mark.usefixtures("hand_clock")
@pytest.mark.parametrize("config", [None, "look.rviz"])
@pytest.mark.parametrize("has_model", [False, True])
def test_it_is_as_if_it_had_begun_with_it(
    folder: Path,
    show: Callable[..., Visualizer],
    config: str | None,
    has_model: bool,
) -> None:
    names = ["robot", "other", "frames", "ring", "texts", "square"]
    options: dict[str, Any] = {"config": config and folder / config}
    if has_model:
        (folder / "given.urdf").write_text(described("base", "lift"))
        options["source"] = "bag:{}"

    def begin(name: str) -> Visualizer:
        path = folder / f"{name}.mcap"
        if not has_model:
            return show(path, **options)
        return show(folder / "given.urdf", **{**options, "source": f"bag:{path}"})

    fresh = {name: seen(begin(name)) for name in names}
    viz = begin("robot")
    order = random.Random(3).choices(names, k=8)
    for name in order:
        session = session_of(viz)
        assert session.data is not None and session.data.player is not None
        session.data.player.advance(0.7)
        viz.open_recording(folder / f"{name}.mcap")
        assert seen(viz) == fresh[name], (order, name)


def test_only_what_is_shown_is_open(
    folder: Path, show: Callable[..., Visualizer], opened: list[FileBytes]
) -> None:
    viz = show(folder / "robot.mcap")
    for name in ("other", "frames", "square", "robot"):
        viz.open_recording(folder / f"{name}.mcap")
        assert [one.path.stem for one in opened] == [name]
    viz.stop()
    assert opened == []


@pytest.mark.usefixtures("hand_clock")
@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("broken.mcap", "is not a recording"),
        ("empty.mcap", "is empty"),
        ("gone.mcap", "there is no such file"),
    ],
)
def test_one_that_cannot_be_opened_changes_nothing(
    folder: Path,
    show: Callable[..., Visualizer],
    opened: list[FileBytes],
    name: str,
    reason: str,
) -> None:
    viz = show(folder / "robot.mcap")
    before, files = seen(viz), list(opened)
    with pytest.raises(SourceError, match=reason):
        viz.open_recording(folder / name)
    assert (seen(viz), opened) == (before, files)


def test_a_program_without_a_recording_is_told_how_to_begin(
    make_viz: Callable[..., Visualizer], folder: Path
) -> None:
    with pytest.raises(UsageError, match="start with one"):
        make_viz().open_recording(folder / "robot.mcap")


def test_of_several_the_one_that_is_named_is_replaced(
    folder: Path, show: Callable[..., Visualizer]
) -> None:
    (folder / "given.urdf").write_text(described("base", "lift"))
    source = [f"old={folder / 'robot.mcap'}", f"new={folder / 'texts.mcap'}"]
    viz = show(folder / "given.urdf", source=source, source_prefix={"old": "a"})
    assert {"/a/scan", "/note"} <= viz.topics.keys()
    with pytest.raises(UsageError, match="'old' or 'new'"):
        viz.open_recording(folder / "other.mcap")
    with pytest.raises(UsageError, match="'old' or 'new'"):
        viz.open_recording(folder / "other.mcap", source="young")
    viz.open_recording(folder / "other.mcap", source="old")
    assert {"/a/empty", "/note"} <= viz.topics.keys()
    assert "/a/scan" not in viz.topics


# In the page


@pytest.fixture
def peer(
    folder: Path, show: Callable[..., Visualizer], protocol: Protocol
) -> tuple[Visualizer, ProtocolClient]:
    viz = show(folder / "robot.mcap")
    client = protocol(viz.viser.get_port())
    client.wait_until(lambda: "recording/open" in client.rows)
    return viz, client


def value(client: ProtocolClient, row_id: str) -> Any:
    return client.rows.get(row_id, {}).get("value")


def answer(client: ProtocolClient, key: str) -> Any:
    return (value(client, "recording/answer") or {}).get(key)


def open_in(client: ProtocolClient, part: Any, name: Any) -> None:
    client.act("recording/open", part, name)


def test_the_page_lists_what_lies_beside_it_and_opens_one(
    peer: tuple[Visualizer, ProtocolClient], folder: Path, opened: list[FileBytes]
) -> None:
    viz, client = peer
    (folder / ".hidden.mcap").write_bytes(b"")
    outside = folder.parent / f"{folder.name} outside.mcap"
    outside.write_bytes((folder / "robot.mcap").read_bytes())
    (folder / "link.mcap").symlink_to(outside)
    (folder / "inside.mcap").symlink_to(folder / "other.mcap")
    parts = folder / "parts"
    parts.mkdir()
    (parts / "metadata.yaml").write_text("rosbag2_bagfile_information:\n")
    (parts / "a.mcap").symlink_to(outside)
    client.act("recording/list")
    client.wait_until(lambda: bool(value(client, "recording/names")))
    assert value(client, "recording/names") == [
        f"{name}.mcap"
        for name in "broken empty frames inside other ring robot square texts".split()
    ]
    assert value(client, "recording/state")["parts"] == ["robot.mcap"]
    open_in(client, "robot.mcap", "inside.mcap")
    client.wait_until(lambda: answer(client, "done") == "inside.mcap")
    client.wait_until(lambda: value(client, "player/name") == "inside.mcap")
    assert client.row("player/time")["max"] == 4.0
    assert value(client, "names/topics") == ["/empty", "/robot_description", "/tf"]
    assert value(client, "player/playing") is True
    assert viz.player.duration == 4.0


def test_of_many_recordings_the_first_are_listed(
    peer: tuple[Visualizer, ProtocolClient], monkeypatch: pytest.MonkeyPatch
) -> None:
    _, client = peer
    lower(monkeypatch, "RECORDING_NAMES", 3)
    client.act("recording/list")
    client.wait_until(lambda: bool(value(client, "recording/names")))
    names = value(client, "recording/names")
    # What was opened can be opened again all the same.
    assert names == ["broken.mcap", "empty.mcap", "frames.mcap", "robot.mcap"]
    open_in(client, "robot.mcap", "other.mcap")
    client.wait_until(lambda: "no recording 'other" in str(value(client, "notice")))


@pytest.mark.parametrize(
    ("part", "name"),
    [
        ("robot.mcap", "../secret.mcap"),
        ("robot.mcap", "/etc/passwd"),
        ("robot.mcap", "look.rviz"),
        ("robot.mcap", "robot.mcap\x00"),
        ("robot.mcap", ""),
        ("square.mcap", "other.mcap"),
        (["robot.mcap"], "other.mcap"),
        ("robot.mcap", 3),
        ("robot.mcap", None),
    ],
)
def test_a_page_opens_nothing_that_is_not_listed(
    peer: tuple[Visualizer, ProtocolClient],
    folder: Path,
    opened: list[FileBytes],
    part: Any,
    name: Any,
) -> None:
    viz, client = peer
    (folder.parent / "secret.mcap").write_bytes((folder / "other.mcap").read_bytes())
    open_in(client, part, name)
    # It is refused before what is sent next.
    client.act("recording/list")
    client.wait_until(lambda: bool(value(client, "recording/names")))
    assert answer(client, "number") is None
    assert viz.player.duration == 2.0
    assert [one.path for one in opened if one.path.name != "robot.mcap"] == []


def test_a_broken_one_is_said_in_the_page_and_the_last_plays_on(
    peer: tuple[Visualizer, ProtocolClient],
) -> None:
    viz, client = peer
    open_in(client, "robot.mcap", "broken.mcap")
    client.wait_until(lambda: "is not a recording" in (answer(client, "refused") or ""))
    refused = answer(client, "refused")
    assert refused.startswith("broken.mcap is not a recording: ")
    assert refused.endswith("or the folder that holds it. What was shown stays")
    before = viz.player.time
    until(lambda: viz.player.time != before)
    open_in(client, "robot.mcap", "other.mcap")
    client.wait_until(lambda: answer(client, "done") == "other.mcap")


def test_viewers_see_no_names_and_open_nothing(
    folder: Path, show: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = show(folder / "robot.mcap", presenter="in-front")
    viewer = protocol(viz.viser.get_port())
    viewer.wait_until(lambda: "recording/open" in viewer.rows)
    viewer.act("recording/list")
    open_in(viewer, "robot.mcap", "other.mcap")
    viewer.wait_until(lambda: value(viewer, "notice") is not None)
    assert value(viewer, "recording/names") is None
    assert viz.player.duration == 2.0


def durations(sessions: list[Session]) -> list[float]:
    players = [one.data and one.data.player for one in sessions]
    return sorted((p.end_ns - p.start_ns) * 1e-9 for p in players if p)


def test_private_sessions_each_have_their_own(
    folder: Path,
    show: Callable[..., Visualizer],
    protocol: Protocol,
    opened: list[FileBytes],
) -> None:
    viz = show(folder / "robot.mcap", session="private")
    first, second = (protocol(viz.viser.get_port()) for _ in range(2))
    for client in (first, second):
        client.wait_until(lambda: "recording/open" in client.rows)  # noqa: B023
    open_in(first, "robot.mcap", "other.mcap")
    first.wait_until(lambda: value(first, "player/name") == "other.mcap")
    assert durations(viz.server.sessions.all()) == [2.0, 4.0]
    assert value(second, "player/name") == "robot.mcap"
    robots = [one.robot.model for one in viz.server.sessions.all()]
    assert sorted(len(one.links) for one in robots if one) == [2, 3]
    # What several show is open once.
    open_in(second, "robot.mcap", "other.mcap")
    second.wait_until(lambda: value(second, "player/name") == "other.mcap")
    assert sorted(one.path.stem for one in opened) == ["other", "robot"]
    # What a program opens is seen by all of them, also by who comes later.
    viz.open_recording(folder / "square.mcap")
    third = protocol(viz.viser.get_port())
    for client in (first, second, third):
        client.wait_until(lambda: value(client, "player/name") == "square.mcap")  # noqa: B023
    open_in(first, "square.mcap", "other.mcap")
    first.wait_until(lambda: value(first, "player/name") == "other.mcap")
    assert {one.path.stem for one in opened} == {"square", "other"}
    first.close()
    until(lambda: {one.path.stem for one in opened} == {"square"})


def test_copies_keep_what_they_have(
    folder: Path,
    show: Callable[..., Visualizer],
    protocol: Protocol,
    opened: list[FileBytes],
) -> None:
    viz = show(folder / "robot.mcap")
    shared = protocol(viz.viser.get_port())
    shared.wait_until(lambda: "recording/open" in shared.rows)
    copy = protocol(viz.viser.get_port(), path="/copy")
    copy.wait_until(lambda: "recording/open" in copy.rows)
    open_in(shared, "robot.mcap", "other.mcap")
    shared.wait_until(lambda: value(shared, "player/name") == "other.mcap")
    assert value(copy, "player/name") == "robot.mcap"
    _, own = viz.server.sessions.all()
    assert own.robot.model is not None and "arm" in own.robot.model.links
    later = protocol(viz.viser.get_port(), path="/copy")
    later.wait_until(lambda: value(later, "player/name") == "other.mcap")
    assert {one.path.stem for one in opened} == {"robot", "other"}
    copy.close()
    until(lambda: {one.path.stem for one in opened} == {"other"})


def test_recordings_that_were_opened_as_one_can_be_opened_again(
    folder: Path, show: Callable[..., Visualizer], protocol: Protocol
) -> None:
    logs = folder / "logs"
    logs.mkdir()
    for name in ("robot", "texts"):
        os.replace(folder / f"{name}.mcap", logs / f"{name}.mcap")
    viz = show(logs)
    client = protocol(viz.viser.get_port())
    client.wait_until(lambda: "recording/open" in client.rows)
    client.act("recording/list")
    client.wait_until(lambda: bool(value(client, "recording/names")))
    names = ["robot.mcap", "texts.mcap", "logs (whole folder)"]
    assert value(client, "recording/names") == names
    open_in(client, "logs", "texts.mcap")
    client.wait_until(lambda: value(client, "names/topics") == ["/note"])
    # It is shown before the next one may be opened.
    client.wait_until(lambda: answer(client, "done") == "texts.mcap")
    open_in(client, "texts.mcap", "logs (whole folder)")
    client.wait_until(lambda: "/scan" in value(client, "names/topics"))
