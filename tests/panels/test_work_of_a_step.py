"""What one step of a slider makes the panels do: counted as work, not as messages."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest
from hand_clock import HandClock
from inside import session_of
from protocol_client import ProtocolClient
from work import steps

from sambot_viz import Visualizer
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.panels.panel import Panel
from sambot_viz.rviz import FIXED_FRAME
from sambot_viz.session.clients import client_view
from sambot_viz.session.config_file import ConfigFile
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.view import WORLD, Target, View

JOINT = "drivewhl_l_joint"
STEPS = 5


def all_panels(kind: type[Panel] = Panel) -> list[type[Panel]]:
    """The classes of all panels."""
    return [
        kind,
        *(found for one in kind.__subclasses__() for found in all_panels(one)),
    ]


def count_calls(monkeypatch: pytest.MonkeyPatch, method: str) -> Counter[str]:
    """How often a method of each panel has been called."""
    counts: Counter[str] = Counter()

    def counting(make: Callable[[Panel], Any]):
        @functools.wraps(make)
        def counted(panel: Panel) -> Any:
            counts[panel.name] += 1
            return make(panel)

        return counted

    for kind in all_panels():
        if method in vars(kind):
            monkeypatch.setattr(kind, method, counting(vars(kind)[method]))
    return counts


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each panel has made its rows."""
    return count_calls(monkeypatch, "rows")


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each panel has been asked for the values that a motion changes."""
    return count_calls(monkeypatch, "values")


def drag(client: ProtocolClient, viz: Visualizer) -> None:
    """A few steps, one gesture each, every one shown before the next."""
    row = client.id_of("joints", JOINT)
    for step in range(1, STEPS + 1):
        client.edit(row, step / 100, gesture=step)
        client.wait_until(lambda at=step: client.shown("joints", JOINT) == at / 100)
    client.settle(viz.viser)


def test_a_step_makes_rows_again_only_of_undo(
    made: Counter[str], protocol: Callable[..., ProtocolClient]
):
    with Visualizer(port=0) as viz:
        clients = [protocol(viz.viser.get_port()) for _ in range(3)]
        for client in clients:
            client.settle(viz.viser)
        drag(clients[0], viz)
        made.clear()
        drag(clients[0], viz)
    assert set(made) <= {"edit"}
    # The undo list of the client that dragged, and of the others.
    assert made["edit"] <= len(clients) * (STEPS + 1)


def test_a_step_asks_only_panels_that_show_what_moves(
    asked: Counter[str], protocol: Callable[..., ProtocolClient]
):
    with Visualizer(port=0) as viz:
        clients = [protocol(viz.viser.get_port()) for _ in range(3)]
        for client in clients:
            client.settle(viz.viser)
        drag(clients[0], viz)
        asked.clear()
        drag(clients[0], viz)
        assert set(asked) == {"joints"}
        # One browser selects a link, another one looks at a frame.
        clients[1].act("permalink/open", ["select", "v"], ["link:base_link", "1"])
        clients[2].act("frames/show", True)
        clients[2].settle(viz.viser)
        asked.clear()
        drag(clients[0], viz)
        assert set(asked) == {"joints", "selection", "frames"}
        clients[1].act("permalink/open", ["select", "v"], ["", "1"])
        clients[2].act("frames/show", False)
        clients[2].settle(viz.viser)
        drag(clients[0], viz)
        asked.clear()
        drag(clients[0], viz)
        assert set(asked) == {"joints"}


def test_boxes_follow_only_what_they_show_and_the_page_moves_its_camera(
    monkeypatch: pytest.MonkeyPatch, protocol: Callable[..., ProtocolClient]
):
    followed: Counter[str] = Counter()
    boxes, target = Picker.boxes_of, client_view.target_of

    def boxes_of(picker: Picker, items: Iterable[Selectable]):
        followed["boxes"] += 1
        return boxes(picker, items)

    def target_of(scene: Scene, view: View, last: Target = WORLD) -> Target:
        followed["target"] += 1
        return target(scene, view, last)

    monkeypatch.setattr(Picker, "boxes_of", boxes_of)
    monkeypatch.setattr(client_view, "target_of", target_of)
    with Visualizer(port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        session = viz.server.sessions.all()[0]
        (page,) = session.clients.all.values()
        drag(client, viz)
        followed.clear()
        drag(client, viz)
        assert followed == {}
        page.tools.select({Selectable("link", "base_link")}, None)
        page.view.set("Target Frame", "drivewhl_l_link")
        followed.clear()
        drag(client, viz)
        assert set(followed) == {"boxes"}
        page.tools.select(set(), None)
        page.view.set("Target Frame", FIXED_FRAME)
        followed.clear()
        drag(client, viz)
        assert followed == {}


def test_a_step_does_not_ask_the_disk(
    protocol: Callable[..., ProtocolClient], monkeypatch: pytest.MonkeyPatch
):
    asked: list[str] = []
    look_up = ConfigFile.folder.fget
    assert look_up is not None

    def folder(file: ConfigFile):
        asked.append(file.name)
        return look_up(file)

    monkeypatch.setattr(ConfigFile, "folder", property(folder))
    with Visualizer(port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        drag(client, viz)
        assert asked, "the File menu has not said where the config is"
        asked.clear()
        drag(client, viz)
    assert asked == []


def tree_of(joints: int) -> str:
    """A robot whose links have three others each, with limits that can be passed."""
    links = "".join(f'<link name="l{i}"/>' for i in range(joints + 1))
    held = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{(i - 1) // 3}"/>'
        f'<child link="l{i}"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        for i in range(1, joints + 1)
    )
    return f'<robot name="tree">{links}{held}</robot>'


@pytest.mark.parametrize("by", ["a program", "a client"])
def test_the_work_of_a_step_does_not_grow_with_the_robot(
    tmp_path: Path,
    hand_clock: HandClock,
    protocol: Callable[..., ProtocolClient],
    by: str,
):
    def work_of(joints: int) -> list[int]:
        model = tmp_path / f"tree{joints}.urdf"
        model.write_text(tree_of(joints), "utf-8")
        with Visualizer(model, port=0, watch=False) as viz:
            session = session_of(viz)
            client = protocol(viz.viser.get_port())
            client.settle(viz.viser)

            def step(q: float) -> None:
                acting = session.history.acting(1, q)
                with acting if by == "a client" else nullcontext():
                    viz.set_joint_positions({"j1": q})

            def at_once(q: float) -> int:
                # After a pause, poses and rows go out in the thread of the step.
                hand_clock.advance(10.0)
                work = steps(lambda: step(q))
                client.wait_until(lambda: client.shown("joints", "j1") == q)
                return work

            # The first ones fill what is kept; the last one passes the limit.
            return [at_once(q) for q in (0.1, 0.2, 0.3, 0.4, 1.5)][2:]

    many, few = work_of(200), work_of(20)
    # Whether another thread is asleep is chance, and to wake it takes some calls. What
    # is done for each of 180 joints more would be a call for each at least.
    assert all(abs(a - b) < 100 for a, b in zip(many, few, strict=True)), (many, few)
