"""The cameras of browsers: what they are told, and what the document takes over."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
import yaml
from camera_reports import (
    FRESH,
    asked,
    confirm,
    follows,
    move,
    number,
    positions,
    report_to_viser,
)
from inside import node_of, session_of, viser_server
from patience import until
from protocol_client import CAMERA_ASKED, ROW_PATCH, ProtocolClient

from sambot_viz import Visualizer, bundled
from sambot_viz.session.clients.client_view import ClientView
from sambot_viz.views.camera import FIELD_OF_VIEW

ORBIT = "rviz_default_plugins/Orbit"


@pytest.fixture
def config(tmp_path: Path) -> Callable[..., Path]:
    """The bundled config with another current view."""

    def write(kind: str = ORBIT, **values: object) -> Path:
        document = yaml.safe_load(bundled.config_path().read_text("utf-8"))
        manager = document["Visualization Manager"]
        manager["Global Options"]["Fixed Frame"] = "base_link"
        manager["Views"] = {
            "Current": {"Class": kind, "Name": "Current View", **values},
            "Saved": None,
        }
        path = tmp_path / "view.rviz"
        path.write_text(yaml.safe_dump(document), "utf-8")
        return path

    return write


@pytest.fixture
def viz(config: Callable[..., Path], make_viz: Callable[..., Visualizer]) -> Visualizer:
    return make_viz(config=config(Distance=4.0, Yaw=0.0, Pitch=0.0))


def views_of(viz: Visualizer) -> list[ClientView]:
    """Those of all browsers, the first one first."""
    return [browser.view for browser in session_of(viz).clients.all.values()]


Protocol = Callable[..., ProtocolClient]


def join(
    viz: Visualizer, protocol: Protocol, position: tuple[float, float, float]
) -> ProtocolClient:
    client = protocol(urlsplit(viz.url).port or 0, camera=False)
    report_to_viser(client, position)
    client.settle(viser_server(viz))
    return client


def test_a_fresh_page_gets_the_view_and_a_returning_one_keeps_its_own(
    viz: Visualizer, protocol: Protocol
) -> None:
    fresh = join(viz, protocol, FRESH)
    assert positions(fresh)[-1] == pytest.approx([4, 0, 0])
    assert asked(join(viz, protocol, (7.0, 1.0, 2.0))) == []
    first, second = views_of(viz)
    assert first.values["Distance"] == 4.0
    assert second.values["Distance"] == pytest.approx(np.linalg.norm((7, 1, 2)))
    assert not session_of(viz).history.modified.value


@pytest.mark.parametrize("driven", [True, False])
def test_a_fresh_page_shows_the_robot_where_it_was_driven_to(
    viz: Visualizer, protocol: Protocol, driven: bool
) -> None:
    join(viz, protocol, FRESH)
    session = session_of(viz)
    with session.history.acting(next(iter(session.clients.all))):
        session.follow_view.show_motion()
    if driven:
        session.drive.set_velocity(10.0, 0.0, 1.0)
        until(lambda: not session.drive.moving)
    join(viz, protocol, FRESH)
    middle = views_of(viz)[-1].camera.look_at
    expected = [session.drive.pose.x, 0.0, 0.0]
    assert (middle[0] > 5.0) == driven
    assert middle == pytest.approx(expected, abs=1e-6)


def test_a_page_that_comes_back_from_above_stays_above(
    viz: Visualizer, protocol: Protocol
) -> None:
    first = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    view.set_kind("rviz_default_plugins/TopDownOrtho")
    view.set("Scale", 55.0)
    view.set("X", 1.5)
    first.settle(viser_server(viz))
    newest = asked(first)[-1]["camera"]
    look_at, fov = newest["look_at"], newest["fov"]
    # viser's picture has 480 pixels, and its camera leans a little.
    away = 480 / 55.0 / 2.0 / math.tan(fov / 2.0)
    above = np.add(look_at, (0.0, -1e-5 * away, away)).tolist()
    again = protocol(urlsplit(viz.url).port or 0, camera=False)
    report_to_viser(again, above, look_at, fov=fov)
    again.settle(viser_server(viz))
    assert asked(again) == []
    kept = views_of(viz)[-1]
    assert kept.view.kind == "rviz_default_plugins/TopDownOrtho"
    assert kept.values["Scale"] == pytest.approx(55.0, rel=1e-3)
    assert kept.values["X"] == pytest.approx(1.5, abs=1e-3)
    assert session_of(viz).document.config.view.kind == ORBIT


def test_a_camera_that_was_asked_for_is_no_move_but_a_mouse_is(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    before = dict(view.values)
    assert not view.confirmed
    confirm(client)
    client.settle(viser_server(viz))
    assert view.values == before
    assert view.confirmed
    move(client, (0.0, 2.0, 0.0))
    client.settle(viser_server(viz))
    assert view.values["Distance"] == pytest.approx(2.0)
    assert view.values["Yaw"] == pytest.approx(1.5707963)
    assert not session_of(viz).history.modified.value


def test_a_report_of_an_earlier_camera_is_not_taken_whenever_it_comes(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    confirm(client)
    before = number(client)
    view.set("Distance", 7.0)
    move(client, (0.0, 2.0, 0.0), of=before)
    client.settle(viser_server(viz))
    assert view.values["Distance"] == 7.0
    assert not view.confirmed
    # Many of them change nothing either; the first one of the new camera is taken.
    for step in range(5):
        move(client, (0.0, 2.0, 0.1 * step), of=before)
    move(client, (0.0, 3.0, 0.0), of=number(client) + 1)
    client.settle(viser_server(viz))
    assert view.values["Distance"] == 7.0
    move(client, (0.0, 5.0, 0.0))
    client.settle(viser_server(viz))
    assert view.values["Distance"] == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("position", (0.0, 0.0)),
        ("position", (0.0, 0.0, None)),
        ("position", (0.0, 0.0, 1e12)),
        ("position", (0.0, 0.0, 0.0)),
        ("up", (0.0, 4.0, 0.0)),
        ("up", "up"),
        ("fov", 0.0),
        ("fov", 4.0),
        ("scale", -1.0),
        ("camera", 1.5),
        ("more", 1),
    ],
)
def test_what_is_no_camera_changes_nothing(
    viz: Visualizer, protocol: Protocol, field: str, value: object
) -> None:
    client = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    camera = {
        "camera": number(client),
        "position": (0.0, 2.0, 0.0),
        "look_at": (0.0, 0.0, 0.0),
        "up": (0.0, 0.0, 1.0),
        "fov": 0.785,
        "scale": None,
    }
    client.send_edit({**camera, field: value})
    client.settle(viser_server(viz))
    assert view.values["Distance"] == 4.0
    client.send_edit(camera)
    client.settle(viser_server(viz))
    assert view.values["Distance"] == pytest.approx(2.0)


def test_the_yaw_stays_while_a_camera_above_its_target_moves(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = join(viz, protocol, (0.004, 0.0, 4.0))
    (view,) = views_of(viz)
    move(client, (0.104, 0.0, 4.0), (0.1, 0.0, 0.0), up=(-1.0, 0.0, 0.001))
    client.settle(viser_server(viz))
    assert view.values["Yaw"] == pytest.approx(0.0, abs=1e-4)
    assert view.values["Focal Point"] == pytest.approx((0.1, 0, 0), abs=1e-6)


def test_each_browser_has_its_own_camera_unless_all_follow_the_presenter(
    viz: Visualizer, protocol: Protocol
) -> None:
    first, second = (join(viz, protocol, (4.0, 0.0, 0.0)) for _ in range(2))
    move(first, (0.0, 2.0, 0.0))
    first.settle(viser_server(viz))
    second.settle(viser_server(viz))
    assert asked(second) == []
    first.edit("view/:lead", True)
    second.wait_until(lambda: asked(second) != [])
    assert positions(second)[-1] == pytest.approx([0, 2, 0], abs=1e-5)
    move(first, (0.0, 3.0, 0.0))
    second.wait_until(lambda: len(asked(second)) > 1)
    assert positions(second)[-1] == pytest.approx([0, 3, 0], abs=1e-5)
    assert asked(first) == []
    one, other = views_of(viz)
    assert one.values == other.values
    one.set_kind("rviz_default_plugins/TopDownOrtho")
    assert other.view.kind == "rviz_default_plugins/TopDownOrtho"


def test_cameras_go_with_the_target_frame_and_keep_their_own_places(
    viz: Visualizer, protocol: Protocol
) -> None:
    viz.set_static_transform("base_link", "target", (1.0, 0.0, 0.0))
    first, second = (join(viz, protocol, at) for at in (FRESH, (7.0, 1.0, 2.0)))
    views = views_of(viz)
    for view in views:
        view.set("Target Frame", "target")
        assert view.values["Focal Point"] == pytest.approx((-1, 0, 0))
    first.settle(viser_server(viz))
    node = node_of(viz, "target")
    assert follows(first) == {
        "node": node,
        "place": True,
        "turns": False,
        "at": [1.0, 0.0, 0.0, 0.0],
    }
    before = [len(asked(client)) for client in (first, second)]
    viz.set_static_transform("base_link", "target", (1.0, 2.0, 0.0))
    for client in (first, second):
        client.settle(viser_server(viz))
    assert [len(asked(client)) for client in (first, second)] == before
    assert [view.camera.position.tolist() for view in views] == [
        pytest.approx([4, 2, 0]),
        pytest.approx([7, 3, 2]),
    ]
    for view in views:
        assert view.values["Focal Point"] == pytest.approx((-1, 0, 0))


def test_a_target_that_moves_changes_nothing_in_what_a_hand_does(
    viz: Visualizer, protocol: Protocol
) -> None:
    viz.set_static_transform("base_link", "target", (1.0, 0.0, 0.0))
    client = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    view.set("Target Frame", "target")
    client.settle(viser_server(viz))
    mark = client.mark()
    for step in range(1, 6):
        viz.set_static_transform("base_link", "target", (1.0, 0.5 * step, 0.0))
        move(client, (1.0 + step, 0.0, 0.0))
        nearly = pytest.approx(1.0 + step)
        client.wait_until(lambda wanted=nearly: view.values["Distance"] == wanted)
        assert view.values["Focal Point"] == pytest.approx((0.0, 0.0, 0.0))
    assert CAMERA_ASKED not in client.types(mark)


def test_a_frame_that_is_hung_elsewhere_or_lost_is_another_node(
    viz: Visualizer, protocol: Protocol
) -> None:
    viz.set_static_transform("base_link", "target", (1.0, 0.0, 0.0))
    client = join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    view.set_kind("rviz_default_plugins/ThirdPersonFollower")
    view.set("Target Frame", "target")
    before = number(client)
    viz.set_static_transform("drivewhl_l_link", "target", (1.0, 0.0, 0.0))
    client.wait_until(lambda: follows(client)["node"] == node_of(viz, "target"))
    assert follows(client)["turns"]
    session_of(viz).frames.remove("target")
    client.wait_until(lambda: not follows(client)["place"])
    assert follows(client)["node"] == ""
    client.settle(viser_server(viz))
    assert number(client) >= before


def test_a_view_that_follows_nothing_costs_no_message(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = join(viz, protocol, FRESH)
    mark = client.mark()
    viz.set_joint_positions({"drivewhl_l_joint": 1.0})
    client.settle(viser_server(viz))
    sent = [m.type for m in client.since(mark) if m.type != ROW_PATCH]
    assert sent == ["SetOrientationMessage"]


@pytest.mark.parametrize("kind", ["Orbit", "XYOrbit", "TopDownOrtho", "FPS"])
def test_every_type_opens(
    config: Callable[..., Path], protocol: Protocol, kind: str
) -> None:
    path = config(f"rviz_default_plugins/{kind}")
    with Visualizer(config=path, port=0) as viz:
        client = join(viz, protocol, FRESH)
        assert asked(client)
        (view,) = views_of(viz)
        assert view.supported


def test_a_type_nobody_knows_is_shown_as_orbit_and_kept(
    config: Callable[..., Path], protocol: Protocol
) -> None:
    path = config("somebody/FrameAligned", Distance=2.0, Yaw=0.0, Pitch=0.0)
    with Visualizer(config=path, port=0) as viz:
        client = join(viz, protocol, FRESH)
        (view,) = views_of(viz)
        assert positions(client)[-1] == pytest.approx([2, 0, 0])
        assert not view.supported
        move(client, (0.0, 5.0, 0.0))
        client.settle(viser_server(viz))
        document = session_of(viz).document.config
        view.store()
        assert not document.modified
        view.set_kind("rviz_default_plugins/XYOrbit")
        assert view.supported
        assert not document.modified
        view.store()
        assert "rviz_default_plugins/XYOrbit" in document.to_yaml()


def test_a_new_type_takes_over_the_target_and_forgets_the_rest(
    viz: Visualizer, protocol: Protocol
) -> None:
    join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    view.set("Target Frame", "drivewhl_l_link")
    view.set("Near Clip Distance", 0.5)
    view.set_kind("rviz_default_plugins/FPS")
    assert view.values["Target Frame"] == "drivewhl_l_link"
    assert view.values["Near Clip Distance"] == 0.01
    assert view.camera.position == pytest.approx((4, 0, 0))


def test_a_view_from_above_shows_the_robot_as_large_as_before_and_back(
    viz: Visualizer, protocol: Protocol
) -> None:
    join(viz, protocol, FRESH)
    (view,) = views_of(viz)
    view.set("Distance", 4.0)
    view.set_kind("rviz_default_plugins/TopDownOrtho")
    height = 2.0 * 4.0 * math.tan(FIELD_OF_VIEW / 2.0)
    (client,) = viser_server(viz).get_clients().values()
    assert view.values["Scale"] == pytest.approx(client.camera.image_height / height)
    view.set_kind(ORBIT)
    assert view.values["Distance"] == pytest.approx(4.0)


def test_saved_views_are_copies_that_can_be_named_and_removed(
    viz: Visualizer, protocol: Protocol
) -> None:
    join(viz, protocol, FRESH)
    (view,), config = views_of(viz), session_of(viz).document.config
    saved = view.save()
    assert saved.name == "Orbit"
    view.set("Distance", 9.0)
    view.saved.rename(saved, "  near ")
    view.saved.rename(saved, "   ")
    assert [view.name for view in config.saved_views] == ["near"]
    view.use(saved)
    assert view.values["Distance"] == 4.0
    view.zero()
    assert (view.values["Distance"], saved.get("Distance")) == (10.0, 4.0)
    view.saved.remove(saved)
    assert config.saved_views == ()


def test_the_panel_shows_every_type_also_the_steepest_pitch(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = join(viz, protocol, FRESH)
    (views,) = views_of(viz)
    for name in ("TopDownOrtho", "Orbit", "FPS", "ThirdPersonFollower", "XYOrbit"):
        views.set_kind(f"rviz_default_plugins/{name}")
        client.settle(viser_server(viz))
        assert client.row("view/type")["value"] == f"{name} (rviz_default_plugins)"
    views.set_kind("rviz_default_plugins/TopDownOrtho")
    views.set_kind(ORBIT)
    client.settle(viser_server(viz))
    assert client.row("view/Pitch")["value"] == pytest.approx(1.569796)
