"""Meshes are read while the page is open already, and drawn as they come."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from patience import patience
from protocol_client import ROW_PATCH, ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content, MeshCache
from sambot_viz.server import sessions as sessions_module
from sambot_viz.server.mesh_thread import MeshThread
from sambot_viz.session import Session

TRIANGLE = """solid t
facet normal 0 0 1
outer loop
vertex 0 0 {z}
vertex 1 0 {z}
vertex 0 1 {z}
endloop
endfacet
endsolid t
"""
LINK = (
    '<link name="l{i}"><visual><geometry><mesh filename="{i}.stl"/></geometry>'
    "</visual></link>"
)
JOINT = (
    '<joint name="j{i}" type="revolute"><parent link="l0"/><child link="l{i}"/>'
    '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)
COUNT = 4


class Gated(MeshCache):
    """Reads in the background only so many files as a test lets through."""

    def __init__(self) -> None:
        super().__init__()
        self.passes = threading.Semaphore(0)
        self.times: list[Path] = []

    def read(self, asset: Asset) -> Content:
        assert self.passes.acquire(timeout=patience(20.0))
        self.times.append(asset.path)
        return super().read(asset)

    def let(self, files: int) -> None:
        for _ in range(files):
            self.passes.release()


class Opened:
    """A robot of meshes, opened while none of them is read."""

    def __init__(self, folder: Path, store: Gated, connect: Callable[..., object]):
        self.folder = folder
        for i in range(COUNT):
            (folder / f"{i}.stl").write_text(TRIANGLE.format(z=i), "utf-8")
        links = "".join(LINK.format(i=i) for i in range(COUNT))
        joints = "".join(JOINT.format(i=i) for i in range(1, COUNT))
        model = folder / "robot.urdf"
        model.write_text(f'<robot name="r">{links}{joints}</robot>', "utf-8")
        self.store = store
        self.viz = Visualizer(model, watch=True)
        client = connect(int(self.viz.url.rsplit(":", 1)[1]))
        assert isinstance(client, ProtocolClient)
        self.client = client

    @property
    def session(self) -> Session:
        return self.viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]

    @property
    def meshes(self) -> int:
        """How many meshes the browser has been sent."""
        bodies = [m for m in self.client.messages if m.type == "MeshMessage"]
        return sum(len(m.fields["props"]["vertices"]) == 36 for m in bodies)

    @property
    def statuses(self) -> set[str]:
        return {d.status.level for d in self.session.scene.displays}

    def wait(self) -> None:
        sessions = self.viz._server.sessions  # pyright: ignore[reportPrivateUsage]
        sessions.wait_for_meshes(patience(20))
        self.client.settle(self.viz.viser)


@pytest.fixture
def opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, protocol: Callable[..., object]
) -> Iterator[Opened]:
    store = Gated()
    monkeypatch.setattr(sessions_module, "MeshCache", lambda: store)
    opened = Opened(tmp_path, store, protocol)
    yield opened
    store.let(1000)
    opened.viz.stop()


def test_the_page_has_frames_sliders_and_progress_before_the_first_mesh(
    opened: Opened,
) -> None:
    opened.client.settle(opened.viz.viser)
    assert opened.meshes == 0
    assert set(opened.viz.frames.frames) == {f"l{i}" for i in range(COUNT)}
    assert opened.client.shown("joints", "j1") == 0.0
    assert opened.client.row("statusbar/progress")["value"] == [0, COUNT]
    assert "Warn" in opened.statuses
    opened.viz.set_joint_positions({"j1": 0.5})
    opened.client.wait_until(
        lambda: opened.client.types()["SetOrientationMessage"] >= 1
    )


def test_meshes_are_drawn_as_they_come_and_the_status_is_right_at_the_end(
    opened: Opened,
) -> None:
    opened.store.let(1)
    opened.client.wait_until(lambda: opened.meshes == 1)
    opened.store.let(COUNT - 1)
    opened.wait()
    assert opened.meshes == COUNT
    assert opened.statuses == {"Ok"}
    assert opened.session.scene.context.assets.progress is None


def test_a_broken_mesh_has_a_stand_in_a_status_and_a_problem(opened: Opened) -> None:
    (opened.folder / "2.stl").write_text("this is no mesh", "utf-8")
    opened.store.let(COUNT)
    opened.wait()
    assert opened.meshes == COUNT - 1
    assert "Error" in opened.statuses
    problems = [p for p in opened.session.problems.shown.value.listed if p.file]
    assert [Path(p.file or "").name for p in problems] == ["2.stl"]
    assert any("2.stl" in str(m.fields) for m in opened.client.messages)


def test_only_a_mesh_that_was_saved_is_read_and_sent_again(opened: Opened) -> None:
    opened.store.let(COUNT)
    opened.wait()
    mark = opened.client.mark()
    opened.store.times.clear()
    opened.store.let(COUNT)
    # Whole: what is half saved may be read too.
    beside = opened.folder / "1.new"
    beside.write_text(TRIANGLE.format(z=7), "utf-8")
    beside.replace(opened.folder / "1.stl")
    opened.client.wait_until(lambda: opened.client.types(mark)["MeshMessage"] == 1)
    opened.wait()
    assert opened.client.types(mark)["MeshMessage"] == 1
    assert opened.store.times == [opened.folder / "1.stl"]
    assert opened.statuses == {"Ok"}


def test_an_edit_of_the_model_sends_no_mesh_again(opened: Opened) -> None:
    opened.store.let(COUNT)
    opened.wait()
    mark = opened.client.mark()
    model = opened.folder / "robot.urdf"
    content = model.read_text("utf-8")
    model.write_text(content.replace("</robot>", '<link name="new"/></robot>'), "utf-8")
    opened.client.wait_until(lambda: opened.client.types(mark)[ROW_PATCH] > 0)
    joint = JOINT.format(i=9).replace("l9", "new")
    model.write_text(
        content.replace("</robot>", f'<link name="new"/>{joint}</robot>'), "utf-8"
    )
    opened.client.wait_until(lambda: "new" in opened.viz.frames.frames)
    opened.client.settle(opened.viz.viser)
    assert opened.client.types(mark)["MeshMessage"] == 0


class Waiting:
    """A listener that keeps what has arrived, and fails when it is asked to."""

    def __init__(self, fails: bool = False) -> None:
        self.heard: list[frozenset[Asset]] = []
        self.fails = fails
        self.called = threading.Event()

    def arrived(self, assets: frozenset[Asset]) -> None:
        self.heard.append(assets)
        self.called.set()
        if self.fails:
            raise ZeroDivisionError("a session failed")


def test_all_listeners_of_a_file_are_called_and_none_after_the_end(
    tmp_path: Path,
) -> None:
    cache, one, two = Gated(), Waiting(), Waiting()
    errors: list[Exception] = []
    thread = MeshThread(cache, errors.append)
    asset = Asset("texture", tmp_path / "missing.png")
    for listener in (one, two, two):
        thread.request(asset, listener)
    cache.let(1)
    assert one.called.wait(patience(20.0)) and two.called.wait(patience(20.0))
    assert one.heard == two.heard == [{asset}]
    thread.close()
    cache.let(1)
    thread.request(asset, one)
    assert len(one.heard) == 1 and not errors


def test_a_listener_that_fails_ends_neither_the_thread_nor_the_others(
    tmp_path: Path,
) -> None:
    cache, bad, good = Gated(), Waiting(fails=True), Waiting()
    errors: list[Exception] = []
    thread = MeshThread(cache, errors.append)
    cache.let(10)
    for number in range(3):
        for listener in (bad, good):
            listener.called.clear()
            thread.request(Asset("mesh", tmp_path / f"{number}.stl"), listener)
        assert bad.called.wait(patience(20.0)) and good.called.wait(patience(20.0))
    thread.close()
    assert errors and {str(error) for error in errors} == {"a session failed"}


def test_a_session_that_cannot_draw_reports_it_and_draws_the_next_mesh(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    assets, session = opened.session.scene.context.assets, opened.session

    def fail() -> None:
        monkeypatch.setattr(assets, "_on_read", session.scene._assets_read)
        raise ZeroDivisionError("it cannot be drawn")

    monkeypatch.setattr(assets, "_on_read", fail)
    opened.store.let(1)
    opened.client.wait_until(lambda: bool(session.problems.of_saves.get("fault")))
    (problem,) = session.problems.of_saves["fault"]
    assert "internal error while drawing meshes: ZeroDivisionError" in problem.message
    opened.store.let(COUNT)
    opened.wait()
    assert opened.meshes == COUNT


def test_a_mesh_that_is_used_twice_is_read_and_stored_once(opened: Opened) -> None:
    opened.store.let(2 * COUNT)
    opened.wait()
    model = opened.folder / "robot.urdf"
    model.write_text(model.read_text("utf-8").replace("1.stl", "2.stl"), "utf-8")
    gone = Asset("mesh", opened.folder / "1.stl")
    opened.client.wait_until(lambda: opened.store.known(gone) is None)
    assert len(opened.store.times) == COUNT
    kept = Asset("mesh", opened.folder / "2.stl")
    assert opened.store.known(kept) is not None
