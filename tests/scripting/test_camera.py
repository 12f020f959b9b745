"""`viz.camera`: what open pages are sent, what their Views panel shows, and who comes
later."""

from __future__ import annotations

import math
from collections.abc import Callable
from urllib.parse import urlsplit

import numpy as np
import pytest
from camera_reports import FRESH, asked, confirm, follows, move, report_to_viser
from inside import session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import UsageError, Visualizer
from sambot_viz.errors import FrameError, SambotVizError, ServerError

Protocol = Callable[..., ProtocolClient]


@pytest.fixture
def join(protocol: Protocol) -> Callable[[Visualizer], ProtocolClient]:
    """Open a page, whose camera is where viser puts it first."""

    def open_page(viz: Visualizer) -> ProtocolClient:
        client = protocol(urlsplit(viz.url).port or 0, camera=False)
        report_to_viser(client, FRESH)
        client.wait_until(lambda: "view/Distance" in client.rows)
        client.settle(viser_server(viz))
        return client

    return open_page


Join = Callable[[Visualizer], ProtocolClient]


def numbers(client: ProtocolClient, *names: str) -> list[float]:
    """The rows of the Views panel."""
    return [float(client.row(f"view/{name}")["value"]) for name in names]


def camera(client: ProtocolClient) -> tuple[list[float], list[float]]:
    """Position and point in the middle, as the page was asked for them last."""
    newest = asked(client)[-1]["camera"]
    return newest["position"], newest["look_at"]


def test_a_camera_is_put_somewhere_in_all_pages_and_in_later_ones(
    viz: Visualizer, join: Join
) -> None:
    pages = [join(viz), join(viz)]
    viz.camera.look_at((0.0, 0.0, 0.5), position=(2.0, 0.0, 0.5))
    for page in pages:
        page.settle(viser_server(viz))
    pages.append(join(viz))
    for page in pages:
        position, look_at = camera(page)
        assert position == pytest.approx([2.0, 0.0, 0.5])
        assert look_at == pytest.approx([0.0, 0.0, 0.5])
        assert numbers(page, "Distance", "Yaw", "Pitch") == [2.0, 0.0, 0.0]
    assert not session_of(viz).history.modified.value


def test_rviz_s_own_distance_is_kept_when_a_program_has_chosen_it(
    viz: Visualizer, join: Join
) -> None:
    viz.camera.look_at((0.0, 0.0, 0.0), (10.0, 0.0, 0.0))
    page = join(viz)
    assert numbers(page, "Distance") == [10.0]
    assert camera(page)[0] == pytest.approx([10.0, 0.0, 0.0])


def test_the_panel_follows_the_mouse_after_a_program(
    viz: Visualizer, join: Join
) -> None:
    page = join(viz)
    viz.camera.look_at((0.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    page.settle(viser_server(viz))
    confirm(page)
    page.settle(viser_server(viz))
    assert numbers(page, "Distance", "Yaw") == [2.0, 0.0]
    move(page, (0.0, 3.0, 0.0))
    page.settle(viser_server(viz))
    assert numbers(page, "Distance", "Yaw") == pytest.approx([3.0, math.pi / 2])


def test_the_camera_turns_in_place_to_a_frame(viz: Visualizer, join: Join) -> None:
    page = join(viz)
    viz.camera.look_at((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    viz.camera.look_at("drivewhl_l_link")
    page.settle(viser_server(viz))
    position, look_at = camera(page)
    wheel = viz.frames.lookup("base_link", "drivewhl_l_link").matrix[:3, 3]
    assert position == pytest.approx([1.0, 1.0, 1.0], abs=1e-6)
    assert look_at == pytest.approx(wheel.tolist(), abs=1e-6)


def test_before_any_page_the_camera_turns_from_where_a_page_begins(
    viz: Visualizer, join: Join
) -> None:
    viz.camera.look_at("front_caster")
    page = join(viz)
    position, look_at = camera(page)
    caster = viz.frames.lookup("base_link", "front_caster").matrix[:3, 3]
    assert look_at == pytest.approx(caster.tolist(), abs=1e-6)
    assert 0.5 < float(np.linalg.norm(position)) < 3.0


def test_a_type_of_view_is_chosen_with_its_numbers(viz: Visualizer, join: Join) -> None:
    page = join(viz)
    viz.camera.view("TopDownOrtho", {"Scale": 250.0, "X": 0.25})
    page.settle(viser_server(viz))
    assert page.row("view/type")["value"] == "TopDownOrtho (rviz_default_plugins)"
    assert numbers(page, "Scale", "X") == [250.0, 0.25]
    viz.camera.look_at("base_link", (1.0, 0.0, 1.0))
    page.settle(viser_server(viz))
    assert page.row("view/type")["value"] == "Orbit (rviz_default_plugins)"
    assert camera(page)[0] == pytest.approx([1.0, 0.0, 1.0], abs=1e-6)
    viz.camera.view(values={"Distance": 0.5})
    page.settle(viser_server(viz))
    assert numbers(page, "Distance", "Pitch") == pytest.approx([0.5, math.pi / 4])


def test_a_saved_view_is_shown_by_its_name(viz: Visualizer, join: Join) -> None:
    page = join(viz)
    viz.camera.view("Orbit", {"Distance": 3.5})
    page.act("views/save")
    page.settle(viser_server(viz))
    with session_of(viz).lock:
        (saved,) = session_of(viz).document.config.saved_views
        saved.rename("Side")
    viz.camera.view("Orbit", {"Distance": 1.0})
    viz.camera.view("Side")
    page.settle(viser_server(viz))
    assert numbers(page, "Distance") == [3.5]
    with pytest.raises(UsageError, match=r"no view 'Sdie'; did you mean 'Side'\?"):
        viz.camera.view("Sdie")


def test_the_camera_goes_with_a_frame(viz: Visualizer, join: Join) -> None:
    page = join(viz)
    viz.set_static_transform("base_link", "arm", (0.0, 0.0, 1.0))
    viz.camera.look_at((0.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    viz.camera.follow("arm")
    page.settle(viser_server(viz))
    assert page.row("view/Target Frame")["value"] == "arm"
    assert camera(page)[0] == pytest.approx([2.0, 0.0, -1.0])
    assert follows(page)["at"] == [0.0, 0.0, 1.0, 0.0]
    viz.set_static_transform("base_link", "arm", (0.5, 0.0, 1.0))
    page.settle(viser_server(viz))
    assert camera(page)[0] == pytest.approx([2.0, 0.0, -1.0])
    viz.camera.follow(None)
    page.settle(viser_server(viz))
    assert page.row("view/Target Frame")["value"] == "<Fixed Frame>"
    assert camera(page)[0] == pytest.approx([2.5, 0.0, 0.0])


def test_a_page_shows_the_whole_robot_first_also_when_it_follows_a_frame(
    viz: Visualizer, join: Join
) -> None:
    viz.camera.follow("base_footprint")
    (distance,) = numbers(join(viz), "Distance")
    assert 0.5 < distance < 3.0


WRONG: list[tuple[Callable[[Visualizer], None], type[SambotVizError], str]] = [
    (lambda viz: viz.camera.look_at("bse_link"), FrameError, "mean 'base_link'"),
    (lambda viz: viz.camera.follow("bse_link"), FrameError, "mean 'base_link'"),
    (lambda viz: viz.camera.look_at((0.0, math.nan, 0.0)), UsageError, "not a point"),
    (lambda viz: viz.camera.look_at((0.0, 0.0)), UsageError, "not a point"),
    (
        lambda viz: viz.camera.look_at("base_link", (0.0, 0.0, 0.0)),
        UsageError,
        "cannot be in the point",
    ),
    (lambda viz: viz.camera.view("Orbti"), UsageError, "did you mean 'Orbit'"),
    (
        lambda viz: viz.camera.view("FPS", {"Pich": 1.0}),
        UsageError,
        "did you mean 'Pitch'",
    ),
    (lambda viz: viz.camera.view(values={"Yaw": "x"}), UsageError, "must be a number"),
]


@pytest.mark.parametrize(("wrong", "error", "text"), WRONG)
def test_what_is_wrong_is_said_and_changes_nothing(
    viz: Visualizer,
    join: Join,
    wrong: Callable[[Visualizer], None],
    error: type[SambotVizError],
    text: str,
) -> None:
    page = join(viz)
    sent = asked(page)
    with pytest.raises(error, match=text):
        wrong(viz)
    page.settle(viser_server(viz))
    assert asked(page) == sent
    assert page.row("view/type")["value"] == "Orbit (rviz_default_plugins)"
    assert session_of(viz).document.config.view.kind.endswith("/Orbit")


def test_private_sessions_that_come_later_begin_with_the_same_view(
    make_viz: Callable[..., Visualizer], join: Join
) -> None:
    viz = make_viz(session="private")
    with pytest.raises(ServerError, match="no browser"):
        viz.camera.look_at((0.0, 0.0, 0.0))
    first = join(viz)
    viz.camera.look_at((0.0, 0.0, 0.0), (0.0, 4.0, 0.0))
    first.settle(viser_server(viz))
    for page in (first, join(viz)):
        assert numbers(page, "Distance", "Yaw") == pytest.approx([4.0, math.pi / 2])
