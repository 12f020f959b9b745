"""Following files: what counts as a save, and what a save does to the page."""

from __future__ import annotations

import itertools
import os
import queue
import shutil
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import signals_of
from patience import patience
from protocol_client import CAMERA_ASKED, ProtocolClient
from watchfiles import Change

from sambot_viz import Visualizer, bundled
from sambot_viz.errors import Problem
from sambot_viz.files import Stamp
from sambot_viz.server import watch
from sambot_viz.server.watch import FileWatcher, Watched
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

Changes = queue.Queue[frozenset[Path]]
LEFT = "drivewhl_l_joint"


@pytest.fixture
def follow() -> Iterator[Callable[..., Changes]]:
    """``follow(*files)``: a queue of the sets of files that were saved."""
    watchers: list[FileWatcher] = []

    def start(*files: Path, troubles: list[str] | None = None) -> Changes:
        changes: Changes = queue.Queue()

        def changed(files: frozenset[Path], reported: frozenset[Path]) -> None:
            del reported
            if files:
                changes.put(files)

        reasons = [] if troubles is None else troubles
        watched = Watched(frozenset(files))
        watchers.append(FileWatcher(lambda: watched, changed, reasons.append))
        watchers[-1].start()
        return changes

    yield start
    for watcher in watchers:
        watcher.close()


def replace(path: Path, content: str) -> None:
    """Save as careful editors do: a new file takes the old one's name."""
    other = path.with_name(f".{path.name}.new")
    other.write_text(content, "utf-8")
    other.replace(path)


_half_saved: dict[Path, str] = {}
"""What is written into a file after somebody has seen that it is empty or gone."""


def in_two_steps(path: Path, content: str) -> None:
    """Save as careless editors do: the file is empty for a moment."""
    _half_saved[path] = content
    path.write_text("", "utf-8")


def vanishing(path: Path, content: str) -> None:
    _half_saved[path] = content
    path.unlink()


@pytest.fixture(autouse=True)
def _second_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take the second step of such an editor when the watcher has looked."""
    _half_saved.clear()
    look = watch.stamp

    def stamp(file: Path) -> Stamp | None:
        found = look(file)
        if file in _half_saved and (found is None or not found[1]):
            file.write_text(_half_saved.pop(file), "utf-8")
        return found

    monkeypatch.setattr(watch, "stamp", stamp)


@pytest.mark.parametrize("save", [Path.write_text, replace, in_two_steps, vanishing])
def test_a_save_is_reported_once_whichever_way_the_editor_saves(
    tmp_path: Path,
    follow: Callable[..., Changes],
    save: Callable[[Path, str], None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # The file comes back after a moment, which may be long on a busy machine.
    monkeypatch.setattr(watch, "SETTLE", patience(5.0))
    path = tmp_path / "model.urdf"
    path.write_text("old", "utf-8")
    changes = follow(path)
    save(path, "new")
    assert changes.get(timeout=patience(10.0)) == {path}
    assert path.read_text("utf-8") == "new"


def test_only_a_file_that_was_not_there_appears(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is missing is looked for again then, which a save is no reason for."""
    known, new = tmp_path / "model.urdf", tmp_path / "mesh.stl"
    known.write_text("old", "utf-8")
    reported = {(Change.added, str(tmp_path / n)) for n in (known, new, ".x.swp")}

    def report(*_: object, stop_event: threading.Event, **__: object) -> Any:
        yield reported
        stop_event.wait(patience(30.0))

    monkeypatch.setattr(watch, "watch", report)
    told: queue.Queue[frozenset[Path]] = queue.Queue()
    watched = Watched(frozenset([known]))
    watcher = FileWatcher(
        lambda: watched, lambda _, appeared: told.put(appeared), lambda _: None
    )
    watcher.start()
    assert told.get(timeout=patience(10.0)) == {new}
    watcher.close()


@pytest.mark.parametrize("moment", range(1, 6))
def test_a_file_that_is_emptied_in_the_middle_of_a_look_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: int
) -> None:
    monkeypatch.setattr(watch, "SETTLE", patience(5.0))
    path = tmp_path / "model.urdf"
    path.write_text("old", "utf-8")
    contents: queue.Queue[str] = queue.Queue()
    looked = itertools.count()
    look = watch.stamp

    def stamp(file: Path) -> Stamp | None:
        if file == path and next(looked) == moment:
            in_two_steps(path, "new")
        return look(file)

    monkeypatch.setattr(watch, "stamp", stamp)

    def changed(files: frozenset[Path], reported: frozenset[Path]) -> None:
        del files, reported
        contents.put(path.read_text("utf-8"))

    watched = Watched(frozenset([path]))
    watcher = FileWatcher(lambda: watched, changed, lambda _: None)
    watcher.start()
    try:
        assert contents.get(timeout=patience(10.0)) == "new"
    finally:
        watcher.close()


def test_folders_with_blanks_and_korean_letters_are_watched(
    tmp_path: Path, follow: Callable[..., Changes]
) -> None:
    folder = tmp_path / "내 로봇 model"
    folder.mkdir()
    path = folder / "샘봇.urdf"
    path.write_text("old", "utf-8")
    changes = follow(path)
    path.write_text("newer", "utf-8")
    assert changes.get(timeout=patience(10.0)) == {path}


def test_a_file_whose_name_is_no_text_does_not_end_the_watching(
    tmp_path: Path, follow: Callable[..., Changes]
) -> None:
    path, troubles = tmp_path / "model.urdf", list[str]()
    path.write_text("old", "utf-8")
    changes = follow(path, troubles=troubles)
    for content in ("new", "newer"):
        try:
            with open(os.fsencode(tmp_path) + b"/\xff.urdf", "ab") as stream:
                stream.write(b"x")
        except OSError:
            pytest.skip("this file system takes no such names")
        path.write_text(content, "utf-8")
        assert changes.get(timeout=patience(10.0)) == {path}
    assert troubles == []


def test_a_save_behind_a_link_and_another_target_of_it_are_reported(
    tmp_path: Path, follow: Callable[..., Changes]
) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "there").mkdir()
    link = tmp_path / "here" / "model.urdf"
    for name in ("one", "two"):
        (tmp_path / "there" / name).write_text(name, "utf-8")
    link.symlink_to(tmp_path / "there" / "one")
    changes = follow(link)
    (tmp_path / "there" / "one").write_text("changed", "utf-8")
    assert changes.get(timeout=patience(10.0)) == {link}
    new = tmp_path / "here" / "new"
    new.symlink_to(tmp_path / "there" / "two")
    new.replace(link)
    assert changes.get(timeout=patience(10.0)) == {link}


def test_a_folder_that_was_created_again_is_watched_again(
    tmp_path: Path, follow: Callable[..., Changes]
) -> None:
    path = tmp_path / "urdf" / "model.urdf"
    path.parent.mkdir()
    path.write_text("one", "utf-8")
    changes = follow(path)
    shutil.rmtree(path.parent)
    assert changes.get(timeout=patience(10.0)) == {path}
    path.parent.mkdir()
    path.write_text("two", "utf-8")
    assert changes.get(timeout=patience(10.0)) == {path}
    path.write_text("three", "utf-8")
    assert changes.get(timeout=patience(10.0)) == {path}


def test_without_the_systems_help_files_are_polled_and_that_is_reported_once(
    tmp_path: Path, follow: Callable[..., Changes], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*paths: Path, **options: object) -> Iterator[object]:
        del paths, options
        raise OSError("OS file watch limit reached.")
        yield

    monkeypatch.setattr(watch, "watch", refuse)
    monkeypatch.setattr(watch, "LOOK_PERIOD", 0.05)
    path, troubles = tmp_path / "model.urdf", list[str]()
    path.write_text("old", "utf-8")
    changes = follow(path, troubles=troubles)
    path.write_text("newer", "utf-8")
    assert changes.get(timeout=patience(10.0)) == {path}
    assert troubles == ["OS file watch limit reached."]


def test_an_error_while_looking_does_not_end_the_watching(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(watch, "LOOK_PERIOD", 0.05)
    path = tmp_path / "model.urdf"
    path.write_text("old", "utf-8")
    changes: Changes = queue.Queue()
    failed = threading.Event()
    watching: list[bool] = []
    errors = [PermissionError("no permission"), RuntimeError("a ring of links")]

    def watched() -> Watched:
        if watching and errors:
            raise errors.pop()
        failed.set() if watching else watching.append(True)
        return Watched(frozenset([path]))

    def changed(files: frozenset[Path], reported: frozenset[Path]) -> None:
        del reported
        changes.put(files)
        raise ZeroDivisionError("an error of the callback")

    watcher = FileWatcher(watched, changed, lambda _: None)
    watcher.start()
    watcher.ask_again()
    try:
        assert failed.wait(patience(10.0))
        for content in ("new", "newer"):
            replace(path, content)
            assert changes.get(timeout=patience(10.0)) == {path}
    finally:
        watcher.close()
    assert [r.levelname for r in caplog.records] == ["ERROR"] * 3


def test_what_counts_is_asked_only_when_it_may_have_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watch, "LOOK_PERIOD", 0.05)
    first, later = tmp_path / "model.urdf", tmp_path / "part.xacro"
    for path in (first, later):
        path.write_text("old", "utf-8")
    files, asked, changes = [first], itertools.count(), Changes()

    def watched() -> Watched:
        next(asked)
        return Watched(frozenset(files))

    watcher = FileWatcher(watched, lambda files, _: changes.put(files), lambda _: None)
    watcher.start()
    try:
        for content in ("new", "newer"):
            replace(first, content)
            assert changes.get(timeout=patience(10.0)) == {first}
        assert next(asked) == 1
        # It was read, then saved, and only then it is told that it counts.
        files.append(later)
        replace(later, "new")
        watcher.ask_again()
        assert changes.get(timeout=patience(10.0)) == {later}
        replace(later, "newer")
        assert changes.get(timeout=patience(10.0)) == {later}
        assert next(asked) == 3
    finally:
        watcher.close()


def test_what_a_callback_reads_counts_from_then_on_and_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watch, "LOOK_PERIOD", 0.05)
    first, part = tmp_path / "model.urdf", tmp_path / "part.xacro"
    first.write_text("old", "utf-8")
    files, changes = [first], Changes()

    def changed(found: frozenset[Path], reported: frozenset[Path]) -> None:
        del reported
        if found:
            changes.put(found)
        if part not in files and part.exists():
            files.append(part)
            watcher.ask_again()

    watcher = FileWatcher(lambda: Watched(frozenset(files)), changed, lambda _: None)
    watcher.start()
    try:
        replace(part, "old")
        # It was there before the next look.
        os.utime(part, ns=(0, 0))
        replace(first, "new")
        assert changes.get(timeout=patience(10.0)) == {first}
        replace(first, "newer")
        assert changes.get(timeout=patience(10.0)) == {first}
        replace(part, "newer")
        assert changes.get(timeout=patience(10.0)) == {part}
    finally:
        watcher.close()


class Followed:
    """A Visualizer that follows a copy of sam_bot, and waiting for what it does."""

    def __init__(self, folder: Path, name: str = "sam_bot.urdf.xacro") -> None:
        self.model = folder / name
        shutil.copytree(bundled.assets_folder(), folder, dirs_exist_ok=True)
        self.config = folder / "own.rviz"
        shutil.copy(bundled.config_path(), self.config)
        self.reports: queue.Queue[tuple[Problem, ...]] = queue.Queue()
        self.viz = Visualizer(
            self.model,
            self.config,
            watch=True,
            on_reload=lambda problems: self.reports.put(tuple(problems)),
        )
        # The lock of the session: its listeners are called with it, and what tests
        # wait for needs it. Two locks would be taken in both orders.
        self._told = threading.Condition(self.session.lock)
        connect(signals_of(self.session), self._hear)

    @property
    def session(self) -> Session:
        return self.viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]

    def _hear(self) -> None:
        with self._told:
            self._told.notify_all()

    def wait_for(self, condition: Callable[[], object]) -> None:
        with self._told:
            assert self._told.wait_for(condition, patience(10.0))

    def save(self, old: str, new: str, path: Path | None = None) -> None:
        path = path or self.model
        content = path.read_text("utf-8")
        assert old in content
        replace(path, content.replace(old, new))

    @property
    def failed(self) -> list[str]:
        problems = self.session.problems.of_saves
        return [p.code for found in problems.values() for p in found]


@pytest.fixture
def sam_bot(tmp_path: Path) -> Iterator[Followed]:
    followed = Followed(tmp_path)
    yield followed
    followed.viz.stop()


def test_a_saved_model_is_shown_and_joints_keep_their_values(
    sam_bot: Followed,
) -> None:
    sam_bot.viz.set_joint_positions({LEFT: 1.25})
    sam_bot.save("front_caster", "rear_caster")
    sam_bot.wait_for(lambda: "rear_caster" in sam_bot.viz.frames.frames)
    assert "front_caster" not in sam_bot.viz.frames.frames
    assert sam_bot.viz.joint_positions[LEFT] == 1.25


def test_a_mistake_keeps_the_robot_and_is_shown_until_it_is_fixed(
    sam_bot: Followed,
) -> None:
    sam_bot.save("</robot>", "</rob>")
    sam_bot.wait_for(lambda: sam_bot.failed)
    assert sam_bot.reports.get(timeout=patience(10.0))[0].severity == "error"
    assert "front_caster" in sam_bot.viz.frames.frames
    sam_bot.save("</rob>", "</robot>")
    sam_bot.wait_for(lambda: not sam_bot.failed)
    assert sam_bot.reports.get(timeout=patience(10.0)) == ()


def test_an_sdf_file_is_followed_and_its_mistakes_have_their_lines(
    tmp_path: Path,
) -> None:
    sam_bot = Followed(tmp_path, "sam_bot.sdf")
    try:
        sam_bot.viz.set_joint_positions({LEFT: 1.25})
        sam_bot.save("front_caster", "rear_caster")
        sam_bot.wait_for(lambda: "rear_caster" in sam_bot.viz.frames.frames)
        assert sam_bot.viz.joint_positions[LEFT] == 1.25
        sam_bot.save('relative_to="caster_joint"', 'relative_to="castor_joint"')
        (problem,) = sam_bot.reports.get(timeout=patience(10.0))
        lines = sam_bot.model.read_text("utf-8").splitlines()
        wrong = next(n for n, line in enumerate(lines, 1) if "castor" in line)
        assert problem.line == wrong
        assert problem.hint == "write caster_joint"
        assert "rear_caster" in sam_bot.viz.frames.frames
        sam_bot.save("castor_joint", "caster_joint")
        assert sam_bot.reports.get(timeout=patience(10.0)) == ()
    finally:
        sam_bot.viz.stop()


def test_what_a_save_includes_newly_is_followed_from_then_on(
    sam_bot: Followed,
) -> None:
    extra = sam_bot.model.parent / "parts" / "mast.xacro"
    include = '<xacro:include filename="parts/mast.xacro"/></robot>'
    sam_bot.save("</robot>", include)
    sam_bot.wait_for(lambda: sam_bot.failed)
    extra.parent.mkdir()
    text = (
        '<robot xmlns:xacro="http://ros.org/wiki/xacro"><link name="mast"/>'
        '<joint name="mast_joint" type="fixed"><parent link="base_link"/>'
        '<child link="mast"/></joint></robot>'
    )
    extra.write_text(text, "utf-8")
    sam_bot.wait_for(lambda: "mast" in sam_bot.viz.frames.frames)
    extra.write_text(text.replace('"mast"', '"tall_mast"'), "utf-8")
    sam_bot.wait_for(lambda: "tall_mast" in sam_bot.viz.frames.frames)
    sam_bot.wait_for(lambda: sam_bot.failed == [])


def test_a_saved_config_is_shown(sam_bot: Followed) -> None:
    sam_bot.save("Fixed Frame: base_link", "Fixed Frame: front_caster", sam_bot.config)
    sam_bot.wait_for(
        lambda: sam_bot.session.scene.context.fixed_frame == "front_caster"
    )
    sam_bot.wait_for(lambda: sam_bot.failed == [])


def test_a_broken_config_keeps_the_old_one_until_it_is_fixed(
    sam_bot: Followed,
) -> None:
    content = sam_bot.config.read_text("utf-8")
    sam_bot.config.write_text("{", "utf-8")
    sam_bot.wait_for(lambda: sam_bot.failed)
    assert len(sam_bot.session.scene.displays) > 1
    sam_bot.config.write_text(content, "utf-8")
    sam_bot.wait_for(lambda: not sam_bot.failed)


def test_changes_made_in_the_page_are_not_thrown_away(sam_bot: Followed) -> None:
    sam_bot.session.document.set_option("Frame Rate", 12)
    sam_bot.save("Fixed Frame: base_link", "Fixed Frame: front_caster", sam_bot.config)
    sam_bot.wait_for(lambda: sam_bot.failed)
    assert sam_bot.failed == ["config-changes-kept"]
    assert sam_bot.session.document.config.global_options.get("Frame Rate") == 12
    assert sam_bot.session.scene.context.fixed_frame == "base_link"
    sam_bot.session.document.config.save(sam_bot.config)
    sam_bot.wait_for(lambda: not sam_bot.failed)
    assert sam_bot.session.scene.context.fixed_frame == "base_link"


def test_a_config_that_was_saved_elsewhere_is_shown_when_all_changes_are_undone(
    sam_bot: Followed,
) -> None:
    session = sam_bot.session
    client = 7
    for value in (12, 13):
        with session.history.acting(client, value):
            session.document.set_option("Frame Rate", value)
    sam_bot.save("Fixed Frame: base_link", "Fixed Frame: front_caster", sam_bot.config)
    sam_bot.wait_for(lambda: sam_bot.failed)
    session.history.undo(client)
    assert sam_bot.failed == ["config-changes-kept"]
    session.history.undo(client)
    sam_bot.wait_for(lambda: session.scene.context.fixed_frame == "front_caster")
    sam_bot.wait_for(lambda: not sam_bot.failed)


def test_a_view_that_was_moved_stays_and_does_not_keep_a_config_from_being_shown(
    sam_bot: Followed, protocol: Callable[[int], ProtocolClient]
) -> None:
    protocol(int(sam_bot.viz.url.rsplit(":", 1)[1])).settle(sam_bot.viz.viser)
    (browser,) = sam_bot.session.clients.all.values()
    browser.view.set("Distance", 7.5)
    sam_bot.save("Fixed Frame: base_link", "Fixed Frame: front_caster", sam_bot.config)
    sam_bot.wait_for(
        lambda: sam_bot.session.scene.context.fixed_frame == "front_caster"
    )
    sam_bot.wait_for(lambda: sam_bot.failed == [])
    assert browser.view.values["Distance"] == 7.5


def test_another_view_in_the_file_moves_the_cameras(
    sam_bot: Followed, protocol: Callable[[int], ProtocolClient]
) -> None:
    client = protocol(int(sam_bot.viz.url.rsplit(":", 1)[1]))
    client.settle(sam_bot.viz.viser)
    mark = client.mark()
    sam_bot.save("Value: Orbit (rviz)", "Yaw: 1.5", sam_bot.config)
    client.wait_until(lambda: client.types(mark)[CAMERA_ASKED] > 0)
    assert sam_bot.session.document.config.view.get("Yaw") == pytest.approx(
        1.5, abs=0.01
    )


def test_a_saved_link_is_the_only_one_that_is_sent_again(
    sam_bot: Followed, protocol: Callable[[int], ProtocolClient]
) -> None:
    client = protocol(int(sam_bot.viz.url.rsplit(":", 1)[1]))
    client.settle(sam_bot.viz.viser)
    mark = client.mark()
    sam_bot.save('name="base_length" value="0.42"', 'name="base_length" value="0.5"')
    client.wait_until(lambda: client.types(mark)["BoxMessage"] == 1)
    client.settle(sam_bot.viz.viser)
    assert client.types(mark)["BoxMessage"] == 1
    assert client.types(mark)["CylinderMessage"] == 0


def test_a_mesh_that_was_missing_is_found_as_soon_as_it_is_there(
    tmp_path: Path, protocol: Callable[[int], ProtocolClient]
) -> None:
    model = tmp_path / "one.urdf"
    mesh = '<geometry><mesh filename="part.stl"/></geometry>'
    model.write_text(
        f'<robot name="r"><link name="l"><visual>{mesh}</visual></link></robot>'
    )
    with Visualizer(model, watch=True) as viz:
        client = protocol(int(viz.url.rsplit(":", 1)[1]))
        assert client.types()["LineSegmentsMessage"] > 0
        corners = ("0 0 0", "1 0 0", "0 1 0")
        lines = "".join(f"vertex {corner}\n" for corner in corners)
        (tmp_path / "part.stl").write_text(
            f"solid s\nfacet normal 0 0 1\nouter loop\n{lines}endloop\nendfacet\n"
            "endsolid s\n"
        )
        client.wait_until(lambda: client.types()["MeshMessage"] > 0)


def test_a_saved_file_around_the_model_is_checked_and_the_model_is_not_read_again(
    tmp_path: Path,
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>sam_bot</name></package>")
    params = tmp_path / "nav2_params.yaml"
    params.write_text("amcl:\n  ros__parameters:\n    base_frame_id: base_link\n")
    sam_bot = Followed(tmp_path)
    try:
        problems, robot = sam_bot.session.problems, sam_bot.session.robot.model

        def listed() -> list[tuple[str, int | None]]:
            found = problems.shown.value.listed
            return [(p.code, p.line) for p in found if p.file == str(params)]

        sam_bot.wait_for(lambda: params in sam_bot.session.checks.files.value)
        assert listed() == []
        sam_bot.save("base_link", "base_lnk", params)
        sam_bot.wait_for(lambda: listed() == [("frame-unknown", 3)])
        sam_bot.save("base_lnk", "base_link", params)
        sam_bot.wait_for(lambda: listed() == [])
        # CMakeLists.txt was looked for, and is not there yet.
        build = tmp_path / "CMakeLists.txt"
        build.write_text("project(sam_bot")
        sam_bot.wait_for(
            lambda: "cmake-unclosed" in [p.code for p in problems.shown.value.listed]
        )
        assert sam_bot.session.robot.model is robot
        sam_bot.save("front_caster", "rear_caster")
        sam_bot.wait_for(lambda: sam_bot.session.robot.model is not robot)
    finally:
        sam_bot.viz.stop()


def test_each_private_session_follows_and_a_later_one_shows_the_mistake(
    tmp_path: Path, protocol: Callable[[int], ProtocolClient]
) -> None:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    model = tmp_path / "sam_bot.urdf.xacro"
    content = model.read_text("utf-8")

    def told(client: ProtocolClient) -> bool:
        return any("last version that worked" in str(m.fields) for m in client.messages)

    with Visualizer(model, watch=True, session="private") as viz:
        port = int(viz.url.rsplit(":", 1)[1])
        clients = [protocol(port), protocol(port)]
        for client in clients:
            client.wait_until(lambda c=client: c.types()["BoxMessage"] > 0)
        marks = [client.mark() for client in clients]
        replace(model, content.replace('value="0.42"', 'value="0.5"'))
        for client, mark in zip(clients, marks, strict=True):
            client.wait_until(lambda c=client, m=mark: c.types(m)["BoxMessage"] == 1)
        replace(model, content.replace("</robot>", ""))
        for client in clients:
            client.wait_until(lambda c=client: told(c))
        late = protocol(port)
        # The page of a new session comes in parts, the problems before the robot.
        late.wait_until(lambda: told(late) and late.types()["BoxMessage"] > 0)
        late.settle(viz.viser)
        assert late.types()["BoxMessage"] == 1


def test_without_watch_nothing_is_followed(tmp_path: Path) -> None:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    before = {thread.name for thread in threading.enumerate()}
    with Visualizer(tmp_path / "sam_bot.urdf.xacro"):
        now = {thread.name for thread in threading.enumerate()}
    assert "sambot-viz-watch" not in now - before


def test_an_internal_error_is_shown_and_does_not_end_the_watching(
    sam_bot: Followed, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(robot: object) -> None:
        raise ZeroDivisionError("it happens")

    with monkeypatch.context() as patch:
        patch.setattr(sam_bot.session, "show_robot", fail)
        sam_bot.save("front_caster", "rear_caster")
        sam_bot.wait_for(lambda: sam_bot.failed == ["reload-failed"])
    sam_bot.save("rear_caster", "last_caster")
    sam_bot.wait_for(lambda: "last_caster" in sam_bot.viz.frames.frames)
    sam_bot.wait_for(lambda: sam_bot.failed == [])


def ring(path: Path) -> None:
    path.symlink_to(path)


def pipe(path: Path) -> None:
    os.mkfifo(path)


@pytest.mark.parametrize("replace_by", [ring, pipe, Path.mkdir])
def test_what_is_not_a_file_in_place_of_the_model_ends_nothing(
    sam_bot: Followed, replace_by: Callable[[Path], None]
) -> None:
    content = sam_bot.model.read_text("utf-8")
    sam_bot.model.unlink()
    replace_by(sam_bot.model)
    sam_bot.wait_for(lambda: sam_bot.failed)
    sam_bot.model.rmdir() if sam_bot.model.is_dir() else sam_bot.model.unlink()
    replace(sam_bot.model, content.replace("front_caster", "rear_caster"))
    sam_bot.wait_for(lambda: "rear_caster" in sam_bot.viz.frames.frames)
    sam_bot.wait_for(lambda: sam_bot.failed == [])


def test_a_model_that_is_deleted_is_said_to_be_gone(sam_bot: Followed) -> None:
    content = sam_bot.model.read_text("utf-8")
    sam_bot.model.unlink()
    gone = "sam_bot.urdf.xacro is gone; showing the last version that worked."
    sam_bot.wait_for(lambda: sam_bot.session.problems.shown.value.note == gone)
    replace(sam_bot.model, content)
    sam_bot.wait_for(lambda: sam_bot.session.problems.shown.value.note == "")


def test_a_session_that_fails_does_not_keep_the_others_from_a_save(
    tmp_path: Path,
    protocol: Callable[[int], ProtocolClient],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    model = tmp_path / "sam_bot.urdf.xacro"

    def fail(*_: object) -> None:
        raise ZeroDivisionError("it happens")

    with Visualizer(model, watch=True, session="private") as viz:
        clients: list[ProtocolClient] = []
        for _ in range(2):
            # One after the other: the first session is that of the first client.
            clients.append(protocol(viz.viser.get_port()))
            clients[-1].wait_until(lambda: clients[-1].types()["BoxMessage"] > 0)
        first = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        monkeypatch.setattr(first, "show_robot", fail)
        monkeypatch.setattr(first.scene, "refresh", fail)
        monkeypatch.setattr(first.problems, "set_saves", fail)
        marks = [client.mark() for client in clients]
        content = model.read_text("utf-8")
        for size in ("0.5", "0.6"):
            replace(model, content.replace('value="0.42"', f'value="{size}"'))
            clients[1].wait_until(lambda: clients[1].types(marks[1])["BoxMessage"] > 0)
            marks[1] = clients[1].mark()
        assert clients[0].types(marks[0])["BoxMessage"] == 0
