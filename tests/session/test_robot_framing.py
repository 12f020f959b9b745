"""The camera shows the whole robot at first, where the file says no distance."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from camera_reports import FRESH, confirm, move, positions, report_to_viser
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, bundled
from sambot_viz.inputs import Inputs
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content, MeshCache
from sambot_viz.options import Options
from sambot_viz.server import sessions as sessions_module
from sambot_viz.session import Session
from sambot_viz.session.clients.client_view import ClientView
from sambot_viz.views.camera import FILLED_HEIGHT, FILLED_WIDTH

Protocol = Callable[..., ProtocolClient]
BOX = '<visual><geometry><box size="{0} {0} {0}"/></geometry></visual>'


def opened(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    """A page of 640 x 480 pixels that was just opened."""
    client = protocol(viz.viser.get_port(), camera=False)
    report_to_viser(client, FRESH)
    client.settle(viz.viser)
    return client


def session_of(viz: Visualizer) -> Session:
    return viz.server.sessions.all()[0]


def view_of(viz: Visualizer) -> ClientView:
    return list(session_of(viz).clients.all.values())[-1].view


def resize(client: ProtocolClient, size: tuple[int, int]) -> None:
    """Give the window of a page another size."""
    report_to_viser(client, FRESH, size=size)


def filled(viz: Visualizer, size: tuple[int, int] = (640, 480)) -> tuple[float, float]:
    """Which parts of the width and the height the box around the robot fills."""
    box = session_of(viz).picker.robot_box()
    assert box is not None
    camera = view_of(viz).camera
    corners = np.stack(np.meshgrid(*np.transpose(box)), axis=-1).reshape(-1, 3)
    seen = corners - camera.position
    ahead = np.tan(camera.fov / 2) * (seen @ camera.forward)
    across = np.abs(seen @ camera.right) / ahead * size[1] / size[0]
    return float(across.max()), float(np.abs(seen @ camera.image_up / ahead).max())


@pytest.fixture
def config(tmp_path: Path) -> Callable[[str], Path]:
    """The bundled config with something more in its current view."""

    def write(more: str) -> Path:
        path = tmp_path / "own.rviz"
        text = bundled.config_path().read_text()
        path.write_text(text.replace("Value: Orbit (rviz)", more))
        return path

    return write


def test_without_a_distance_the_whole_robot_fills_the_picture_and_nothing_is_changed(
    protocol: Protocol,
) -> None:
    with Visualizer() as viz:
        client = opened(viz, protocol)
        across, above = filled(viz)
        assert above == pytest.approx(FILLED_HEIGHT, abs=0.01)
        assert across < FILLED_WIDTH
        assert positions(client)[-1] == pytest.approx(view_of(viz).camera.position)
        assert not session_of(viz).history.modified.value


@pytest.mark.parametrize("more", ["Distance: 10", "Distance: 2.5"])
def test_a_distance_of_the_file_is_taken_exactly(
    more: str, config: Callable[[str], Path], protocol: Protocol
) -> None:
    with Visualizer(config=config(more)) as viz:
        opened(viz, protocol)
        values = view_of(viz).values
        assert values["Distance"] == float(more.split()[1])
        assert values["Focal Point"] == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("kind", "given", "name"),
    [
        ("TopDownOrtho", "Scale: 10", "Scale"),
        ("FPS", "Position: {X: 5, Y: 5, Z: 10}", "Position"),
        ("XYOrbit", "Distance: 10", "Distance"),
        ("ThirdPersonFollower", "Distance: 10", "Distance"),
    ],
)
def test_every_view_shows_the_robot_unless_the_file_says_how_near_it_is(
    kind: str, given: str, name: str, tmp_path: Path, protocol: Protocol
) -> None:
    text = bundled.config_path().read_text()
    path = tmp_path / "own.rviz"
    values: list[object] = []
    for more in (given, "Name: Mine"):
        kinds = text.replace(
            "rviz_default_plugins/Orbit", f"rviz_default_plugins/{kind}"
        )
        path.write_text(kinds.replace("Value: Orbit (rviz)", more))
        with Visualizer(config=path) as viz:
            opened(viz, protocol)
            values.append(view_of(viz).values[name])
    assert values[0] in (10.0, (5.0, 5.0, 10.0))
    assert values[1] not in (10.0, (5.0, 5.0, 10.0))


def test_a_side_view_shows_the_names_of_frames_whole(protocol: Protocol) -> None:
    """Letters are 0.027 m high, and those of this name 0.43 times as wide."""
    half = len("drivewhl_l_link") * 0.43 * 0.0267 / 2
    with Visualizer() as viz:
        opened(viz, protocol)
        view = view_of(viz)
        for side in ("front", "back", "top"):
            view.look_from(side)
            camera = view.camera
            at = viz.frames.lookup("base_link", "drivewhl_l_link").translation
            for sign in (-1, 1):
                assert camera.shows(at + sign * half * camera.right, 640, 480)
        view.look_from("front")
        with_names = view.values["Distance"]
        viz.displays["TF"].set("Show Names", False)
        view.look_from("front")
        assert view.values["Distance"] < with_names


def test_a_window_of_another_size_shows_the_whole_robot_again(
    protocol: Protocol,
) -> None:
    with Visualizer() as viz:
        client = opened(viz, protocol)
        confirm(client)
        resize(client, (200, 480))
        client.settle(viz.viser)
        across, above = filled(viz, (200, 480))
        assert across == pytest.approx(FILLED_WIDTH, abs=0.01)
        assert above < FILLED_HEIGHT


def test_a_camera_that_the_user_has_moved_stays(protocol: Protocol) -> None:
    with Visualizer() as viz:
        client = opened(viz, protocol)
        confirm(client)
        move(client, (4.0, 1.0, 2.0))
        client.settle(viz.viser)
        resize(client, (200, 480))
        client.settle(viz.viser)
        assert view_of(viz).camera.position == pytest.approx((4.0, 1.0, 2.0))


def test_a_value_that_was_set_stays(protocol: Protocol) -> None:
    with Visualizer() as viz:
        client = opened(viz, protocol)
        view_of(viz).set("Distance", 7.0)
        resize(client, (200, 480))
        client.settle(viz.viser)
        assert view_of(viz).values["Distance"] == 7.0


def test_a_saved_model_leaves_the_camera_where_it_is(
    tmp_path: Path, protocol: Protocol
) -> None:
    model = tmp_path / "r.urdf"
    text = f'<robot name="r"><link name="a">{BOX}</link></robot>'
    model.write_text(text.format(1))
    with Visualizer(model, watch=True) as viz:
        client = opened(viz, protocol)
        before = dict(view_of(viz).values)
        mark = client.mark()
        model.write_text(text.format(1.9))
        client.wait_until(lambda: client.types(mark)["BoxMessage"] == 1)
        client.settle(viz.viser)
        assert dict(view_of(viz).values) == before


@pytest.mark.parametrize("first", ["", BOX.format(1)])
@pytest.mark.parametrize("moved", [False, True])
def test_a_model_with_its_first_shape_or_much_larger_is_shown_whole_again(
    first: str, moved: bool, tmp_path: Path, protocol: Protocol
) -> None:
    model = tmp_path / "r.urdf"
    text = '<robot name="r"><link name="a">{}</link></robot>'
    model.write_text(text.format(first))
    with Visualizer(model, watch=True) as viz:
        client = opened(viz, protocol)
        confirm(client)
        if moved:
            move(client, (4.0, 1.0, 2.0))
        client.settle(viz.viser)
        mark = client.mark()
        model.write_text(text.format(BOX.format(5)))
        client.wait_until(lambda: client.types(mark)["BoxMessage"] == 1)
        client.settle(viz.viser)
        is_whole = filled(viz)[1] == pytest.approx(FILLED_HEIGHT, abs=0.01)
        assert is_whole is not moved


def test_the_name_of_a_lone_frame_is_seen_whole(
    tmp_path: Path, protocol: Protocol
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text('<robot name="r"><link name="base_link"/></robot>')
    with Visualizer(model) as viz:
        opened(viz, protocol)
        camera = view_of(viz).camera
        (name,) = session_of(viz).picker.names_in((np.zeros(3), np.zeros(3)))
        for side in (-1, 1):
            end = name.position + side * name.width / 2 * camera.right
            assert camera.shows(end, 640, 480)


def test_the_robot_of_a_fixed_model_is_shown_whole(
    tmp_path: Path, protocol: Protocol
) -> None:
    model = tmp_path / "r.urdf"
    box = '<visual><geometry><box size="3 3 3"/></geometry></visual>'
    text = f'<robot name="r"><link name="a">{box}</link></robot>'
    model.write_text(text.replace("</robot>", ""))
    options = Options(model, watch=True)
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        client = opened(viz, protocol)
        assert view_of(viz).values["Distance"] == 10.0
        model.write_text(text)
        client.wait_until(lambda: client.types()["BoxMessage"] == 1)
        client.settle(viz.viser)
        assert filled(viz)[1] == pytest.approx(FILLED_HEIGHT, abs=0.01)


class Gated(MeshCache):
    """Reads files only as soon as the gate is open."""

    def __init__(self) -> None:
        super().__init__()
        self.gate = threading.Event()

    def read(self, asset: Asset) -> Content:
        assert self.gate.wait(patience(20.0))
        return super().read(asset)


@pytest.mark.parametrize("moved", [False, True])
def test_the_robot_is_shown_whole_once_its_meshes_are_read_unless_the_camera_was_moved(
    moved: bool, tmp_path: Path, protocol: Protocol, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = Gated()
    monkeypatch.setattr(sessions_module, "MeshCache", lambda: cache)
    (tmp_path / "m.obj").write_text(
        "v 0 0 0\nv 7 0 0\nv 0 7 0\nv 0 0 7\nf 1 2 3\nf 1 3 4\n"
    )
    model = tmp_path / "r.urdf"
    mesh = '<visual><geometry><mesh filename="m.obj"/></geometry></visual>'
    # With this name its frame is shown, until the mesh is.
    model.write_text(f'<robot name="sam_bot"><link name="a">{mesh}</link></robot>')
    try:
        with Visualizer(model) as viz:
            client = opened(viz, protocol)
            assert view_of(viz).values["Distance"] < 3.0
            confirm(client)
            client.settle(viz.viser)
            if moved:
                move(client, (4.0, 1.0, 2.0))
                client.settle(viz.viser)
            cache.gate.set()
            viz.server.sessions.wait_for_meshes(patience(20))
            client.settle(viz.viser)
            if moved:
                assert view_of(viz).camera.position == pytest.approx((4.0, 1.0, 2.0))
            else:
                assert filled(viz)[1] == pytest.approx(FILLED_HEIGHT, abs=0.01)
    finally:
        cache.gate.set()
