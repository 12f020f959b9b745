"""Which files of the server a browser can have read or written, whatever it sends."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.server.connections import connection

Connect = Callable[..., ProtocolClient]

URDF = """<robot name="{0}">
  <link name="{0}"/><link name="wheel"/>
  <joint name="turn" type="continuous"><parent link="{0}"/><child link="wheel"/></joint>
</robot>"""
CODE = """<robot name="code" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="${'run'.upper()}"/>
</robot>"""
CONFIG = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: Robot
      TF Prefix: second
"""
MODEL = "displays", "Robot", "Description File"
SOURCE = "displays", "Robot", "Description Source"
WRITES = ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.truncate", "os.symlink")


class Disk:
    """What the program reads and writes inside a `with` block."""

    def __init__(self) -> None:
        self.read: list[Path] = []
        self.written: list[Path] = []
        self._on = False
        # There is no way to take it away again.
        sys.addaudithook(self._take)

    def _take(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self._on or not isinstance(arguments[:1] and arguments[0], str | Path):
            return
        path = Path(os.path.realpath(arguments[0]))
        if event in WRITES or (event == "open" and arguments[2] & os.O_ACCMODE):
            self.written.append(path)
        elif event in ("open", "os.listdir", "os.scandir"):
            self.read.append(path)

    def __enter__(self) -> None:
        self.read, self.written = [], []
        self._on = True

    def __exit__(self, *_: object) -> None:
        self._on = False


@pytest.fixture(scope="module")
def disk() -> Disk:
    return Disk()


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the model and the config; beside it, files of somebody else."""
    for name in ("opened", "outside", "started"):
        (tmp_path / name).mkdir()
    folder, outside = tmp_path / "opened", tmp_path / "outside"
    (folder / "robot.urdf").write_text(URDF.format("base"))
    (folder / "second.urdf").write_text(URDF.format("own"))
    (folder / "code.xacro").write_text(CODE)
    (folder / "mine.rviz").write_text(CONFIG)
    (outside / "secret.rviz").write_text(CONFIG)
    (outside / "secret.urdf").write_text(URDF.format("secret"))
    (tmp_path / "started" / "here.rviz").write_text(CONFIG)
    (folder / "link.rviz").symlink_to(outside / "secret.rviz")
    (folder / "link.urdf").symlink_to(outside / "secret.urdf")
    (folder / "dangling.rviz").symlink_to(outside / "new.rviz")
    monkeypatch.chdir(tmp_path / "started")
    monkeypatch.setattr(connection, "BURST", 1e6)
    return folder


def content(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def send_everything(client: ProtocolClient, outside: Path) -> None:
    """Send paths, and what fits, to every row, there or not."""
    names = [
        "link",
        "dangling",
        f"{outside}/secret.urdf",
        f"file://{outside}/secret.urdf",
        "package://outside/secret.urdf",
        "../outside/secret.urdf",
        "link.urdf",
        "LINK.URDF",
        "~/secret.urdf",
        "~root/secret.urdf",
        "/dev/zero",
        "/etc/passwd",
        "a\nb",
        "a\0b",
        "x" * 300,
        "a/" * 499,
        "second.urdf",
        "none",
    ]
    kinds = {row_id: row["kind"] for row_id, row in client.rows.items()}
    for action in ("save", "save-as", "list", "open", "download"):
        kinds[f"file/{action}"] = "command"
    for row_id, kind in kinds.items():
        if kind == "command" and not row_id.startswith(("edit/", "file/picture")):
            for values in ([], [True], [[]]):
                client.act(row_id, *values)
            for name in names:
                for values in ([name], [name, True, []], [name, name]):
                    client.act(row_id, *values)
        elif kind in ("text", "file", "enum", "frame", "display"):
            for name in (*names, "File", True):
                client.edit(row_id, name)
        elif kind in ("bool", "int", "float", "slider"):
            client.edit(row_id, True if kind == "bool" else 1)


@pytest.mark.parametrize("session", ["shared", "private", "copy"])
def test_a_browser_reaches_nothing_outside_the_opened_folders(
    disk: Disk, opened: Path, protocol: Connect, session: str
) -> None:
    outside = opened.parent / "outside"
    before = content(opened.parent)
    with Visualizer(
        opened / "robot.urdf",
        opened / "mine.rviz",
        port=0,
        session="private" if session == "private" else "shared",
    ) as viz:
        path = "/copy" if session == "copy" else "/"
        client = protocol(viz.viser.get_port(), path=path)
        client.wait_until(lambda: "file/state" in client.rows)
        client.settle(viz.viser)
        client.edit(client.id_of(*SOURCE), "File")
        client.settle(viz.viser)
        with disk:
            send_everything(client, outside)
            client.settle(viz.viser)
            viz.server.sessions.wait_for_meshes(patience(20.0))
    assert opened / "second.urdf" in disk.read
    secret = {*outside.rglob("*"), outside, Path("/etc/passwd"), Path("/dev/zero")}
    secret |= {Path.cwd(), *Path.cwd().iterdir()}
    assert not secret & {*disk.read, *disk.written}
    after = content(opened.parent)
    changed = {path for path in after if after[path] != before.get(path)}
    if session != "shared":
        assert disk.written == []
        assert changed == set()
        return
    assert {path.suffix for path in changed} == {".rviz", ".yaml"}
    assert {path.parent for path in changed} == {opened}
    assert all(path.parent == opened for path in disk.written)


def choose_code(viz: Visualizer, client: ProtocolClient, opened: Path) -> None:
    """Let the RobotModel show a model whose code runs only when it is trusted."""
    for names, value in ((SOURCE, "File"), (MODEL, str(opened / "code.xacro"))):
        client.settle(viz.viser)
        client.edit(client.id_of(*names), value)
    client.settle(viz.viser)
    assert client.shown(*MODEL) == str(opened / "code.xacro")


def test_a_model_in_a_config_that_a_browser_has_saved_is_not_trusted(
    opened: Path, protocol: Connect
) -> None:
    with Visualizer(opened / "robot.urdf", opened / "mine.rviz", port=0) as viz:
        client = protocol(viz.viser.get_port())
        choose_code(viz, client, opened)
        for row_id, *values in (
            ("file/save-as", "saved", False, []),
            ("file/open", "mine.rviz"),
            ("file/open", "saved.rviz"),
        ):
            client.act(row_id, *values)
            client.settle(viz.viser)
        assert client.shown(*MODEL) == str(opened / "code.xacro")
        viz.server.sessions.wait_for_meshes(patience(20.0))
        assert "second/RUN" not in session_of(viz).frames.tree.frames
    with Visualizer(opened / "robot.urdf", opened / "saved.rviz", port=0) as viz:
        viz.server.sessions.wait_for_meshes(patience(20.0))
        assert "second/RUN" in session_of(viz).frames.tree.frames


def test_a_copy_trusts_no_model_that_a_browser_has_named(
    opened: Path, protocol: Connect
) -> None:
    with Visualizer(opened / "robot.urdf", opened / "mine.rviz", port=0) as viz:
        choose_code(viz, protocol(viz.viser.get_port()), opened)
        copy = protocol(viz.viser.get_port(), path="/copy")
        copy.wait_until(lambda: len(viz.server.sessions.all()) == 2)
        copy.wait_until(lambda: "file/state" in copy.rows)
        # A copy names no folder of the server.
        assert copy.shown(*MODEL) == "code.xacro"
        viz.server.sessions.wait_for_meshes(patience(20.0))
        assert "second/RUN" not in viz.server.sessions.all()[1].frames.tree.frames


def test_the_config_of_the_program_opens_no_other_folder(
    opened: Path, protocol: Connect
) -> None:
    with Visualizer(config=opened / "mine.rviz", port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        client.act("file/list")
        client.settle(viz.viser)
        listed = client.row("file/names")["value"]
        assert listed[0] == "mine.rviz"
        client.act("file/open", listed[-1])
        client.act("file/list")
        client.settle(viz.viser)
        assert client.row("file/state")["value"]["folder"] == str(opened)
        assert client.row("file/names")["value"] == listed
