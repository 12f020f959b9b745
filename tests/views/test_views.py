"""The five views: from properties to cameras and back, as in RViz 14."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest

from sambot_viz.views.camera import (
    ORTHO_FIELD_OF_VIEW,
    Camera,
    angles_of,
    on_sphere,
    vector,
)
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import WORLD, Name, Target, Values, View

MakeView = Callable[..., View]
ALL = [kind.rpartition("/")[2] for kind in VIEWS]
PERSPECTIVE = [name for name in ALL if name != "TopDownOrtho"]


def put(view: View, values: Values) -> View:
    """The view after some of its values were set."""
    for path, value in values.items():
        view.config.set(path, value)
    return view


def value(view: View, path: str) -> Any:
    """A value of the view, as something approx can compare."""
    return view.config.get(path)


def same_picture(one: Camera, two: Camera) -> bool:
    """Whether two cameras show the same."""
    return bool(
        np.allclose(one.position, two.position, atol=1e-3)
        and np.allclose(one.forward, two.forward, atol=1e-5)
        and np.allclose(one.image_up, two.image_up, atol=1e-5)
    )


def test_orbit_puts_the_camera_where_rviz_does(make_view: MakeView) -> None:
    camera = make_view("Orbit").camera()
    assert camera.position == pytest.approx((5, 5, 7.0711), abs=1e-4)
    assert camera.forward == pytest.approx((-0.5, -0.5, -0.7071), abs=1e-4)
    assert camera.image_up == pytest.approx((-0.5, -0.5, 0.7071), abs=1e-4)
    assert camera.fov == math.pi / 4
    camera = make_view("Orbit", Yaw=0.0, Pitch=0.5).camera()
    assert camera.position == pytest.approx((8.7758, 0, 4.7943), abs=1e-4)
    assert camera.image_up == pytest.approx((-0.4794, 0, 0.8776), abs=1e-4)
    camera = make_view("Orbit", Yaw=0.0, Pitch=0.0).camera()
    assert camera.position == pytest.approx((10, 0, 0))


def test_an_inverted_orbit_is_below_and_upside_down(make_view: MakeView) -> None:
    view = make_view("Orbit", Yaw=0.3, Pitch=0.5, Invert_Z_Axis=True)
    camera = view.camera()
    assert camera.position[2] == pytest.approx(-10 * math.sin(0.5))
    assert tuple(camera.up) == (0.0, 0.0, -1.0)


def test_xy_orbit_is_raised_by_a_fifth_of_the_distance(make_view: MakeView) -> None:
    camera = make_view("XYOrbit").camera()
    assert camera.position == pytest.approx((4, 4, 8.4853), abs=1e-4)
    assert camera.forward == pytest.approx((-0.5, -0.5, -0.7071), abs=1e-4)


def test_the_ortho_view_looks_down_with_its_angle(make_view: MakeView) -> None:
    camera = make_view("TopDownOrtho", X=-2.0, Y=2.0).camera()
    assert tuple(camera.position) == (-2, 2, 500)
    assert camera.right == pytest.approx((1, 0, 0))
    assert camera.image_up == pytest.approx((0, 1, 0))
    turned = make_view("TopDownOrtho", Angle=-1.615, Scale=127.9).camera()
    assert turned.image_up == pytest.approx((1, 0, 0), abs=0.05)
    assert turned.scale == 127.9


def test_fps_looks_down_for_a_positive_pitch(make_view: MakeView) -> None:
    camera = make_view("FPS", Yaw=0.4, Pitch=0.3, Position=(1, 2, 3)).camera()
    assert tuple(camera.position) == (1, 2, 3)
    c = math.cos(0.3)
    wanted = (math.cos(0.4) * c, math.sin(0.4) * c, -math.sin(0.3))
    assert camera.forward == pytest.approx(wanted)


@pytest.mark.parametrize("name", ALL)
def test_a_camera_is_read_back_as_the_properties_it_came_from(
    make_view: MakeView, name: str
) -> None:
    view = make_view(name)
    set_by_hand: dict[str, Values] = {
        "TopDownOrtho": {"Scale": 44.0, "Angle": -1.2, "X": 3.0, "Y": -4.0},
        "FPS": {"Yaw": 2.0, "Pitch": -0.7, "Position": (1.0, -2.0, 3.0)},
    }
    values = set_by_hand.get(
        name,
        {"Yaw": 4.0, "Pitch": -0.4, "Distance": 3.0, "Focal Point": (1.0, 2.0, 0.5)},
    )
    put(view, values)
    target = Target(vector(2.0, 3.0, -1.0), 0.8)
    read = view.read(view.camera(target), target)
    for path, wanted in values.items():
        assert read[path] == pytest.approx(wanted), path


def test_an_inverted_orbit_is_read_back(make_view: MakeView) -> None:
    view = make_view("Orbit", Invert_Z_Axis=True, Yaw=1.0, Pitch=0.5)
    read = view.read(view.camera())
    assert (read["Yaw"], read["Pitch"]) == pytest.approx((1.0, 0.5))


@pytest.mark.parametrize("height", [600, 1080])
def test_the_perspective_picture_of_the_ortho_view_is_exact_in_the_target_plane(
    make_view: MakeView, height: int
) -> None:
    camera = make_view("TopDownOrtho", Scale=37.0, X=1.0).camera()
    for fov in (None, ORTHO_FIELD_OF_VIEW):
        drawn = camera.as_perspective(height, fov)
        half = drawn.distance * math.tan(drawn.fov / 2)
        assert height / (2 * half) == pytest.approx(37.0)
        assert drawn.as_orthographic(height).scale == pytest.approx(37.0)
        assert drawn.look_at == pytest.approx(camera.look_at)
        assert drawn.near < drawn.distance < drawn.far
    assert camera.as_perspective(height).distance == pytest.approx(500)


def test_a_target_moves_the_view_but_does_not_turn_it(make_view: MakeView) -> None:
    view = make_view("Orbit", Yaw=0.0, Pitch=0.0)
    camera = view.camera(Target(vector(1.0, 2.0, 3.0), 1.5))
    assert camera.position == pytest.approx((11, 2, 3))
    assert camera.look_at == pytest.approx((1, 2, 3))


def test_the_follower_turns_with_its_target(make_view: MakeView) -> None:
    view = make_view("ThirdPersonFollower", Yaw=math.pi, Pitch=0.5)
    behind = view.camera(Target(vector(1.0, 0.0, 0.0), math.pi / 2))
    assert behind.position[0] == pytest.approx(1.0)
    assert behind.position[1] < -5
    assert behind.forward[1] > 0.8
    local = view.in_target(behind, Target(vector(1.0, 0.0, 0.0), math.pi / 2))
    assert same_picture(local, view.camera())


def test_zero_is_what_rviz_resets_to(make_view: MakeView) -> None:
    fps = make_view("FPS")
    put(fps, fps.zero())
    assert value(fps, "Yaw") == pytest.approx(3.92699, abs=1e-5)
    assert value(fps, "Pitch") == pytest.approx(0.955317, abs=1e-6)
    assert value(fps, "Position") == (5, 5, 10)
    orbit = make_view("Orbit", Distance=2.0, Near_Clip_Distance=0.5)
    put(orbit, orbit.zero())
    assert value(orbit, "Distance") == 10
    assert value(orbit, "Near Clip Distance") == 0.5
    assert value(orbit, "Focal Shape Fixed Size") is False
    ortho = make_view("TopDownOrtho", Scale=3.0, X=1.0)
    put(ortho, ortho.zero())
    assert (value(ortho, "Scale"), value(ortho, "X")) == (10, 0)


def test_orbit_turns_in_place_to_look_at_a_point(make_view: MakeView) -> None:
    view = make_view("Orbit")
    before = view.camera().position
    put(view, view.look_at(vector(1.0, 2.0, 3.0)))
    assert view.camera().position == pytest.approx(before)
    assert value(view, "Focal Point") == pytest.approx((1, 2, 3))


def test_the_others_look_at_a_point_in_their_own_way(make_view: MakeView) -> None:
    xy = make_view("XYOrbit")
    put(xy, xy.look_at(vector(1.0, 2.0, 3.0)))
    assert value(xy, "Focal Point") == pytest.approx((1, 2, 0))
    ortho = make_view("TopDownOrtho", Scale=20.0)
    put(ortho, ortho.look_at(vector(1.0, 2.0, 3.0), Target(vector(1.0, 1.0, 1.0))))
    assert (value(ortho, "X"), value(ortho, "Y")) == (0, 1)
    assert value(ortho, "Scale") == 20
    fps = make_view("FPS")
    put(fps, fps.look_at(vector(5.0, 9.0, 10.0)))
    assert value(fps, "Yaw") == pytest.approx(math.pi / 2)
    assert value(fps, "Pitch") == pytest.approx(0.0)


# Switching types.


@pytest.mark.parametrize("name", ["Orbit", "XYOrbit", "ThirdPersonFollower"])
def test_from_above_an_orbit_looks_down_from_a_hundred_metres(
    make_view: MakeView, name: str
) -> None:
    old = make_view("TopDownOrtho", X=10.0, Y=12.0)
    new = make_view(name)
    put(new, new.mimic(old))
    assert value(new, "Yaw") == pytest.approx(-1.5708, abs=1e-4)
    assert value(new, "Pitch") == pytest.approx(1.5698, abs=1e-4)
    assert value(new, "Focal Point") == (10, 12, 0)
    assert value(new, "Distance") == 100


def test_orbit_keeps_the_angles_of_xy_orbit(make_view: MakeView) -> None:
    old = make_view("XYOrbit", Yaw=0.0, Pitch=0.5, Focal_Point=(4.0, 5.0, 0.0))
    new = make_view("Orbit")
    put(new, new.mimic(old))
    assert value(new, "Yaw") == pytest.approx(0.0, abs=1e-6)
    assert value(new, "Pitch") == pytest.approx(0.5)
    assert same_picture(new.camera(), old.camera())


def test_orbit_copies_orbit(make_view: MakeView) -> None:
    old = make_view("Orbit", Yaw=2.0, Distance=3.0, Focal_Point=(1.0, 2.0, 3.0))
    new = make_view("Orbit")
    put(new, new.mimic(old))
    for path in ("Yaw", "Pitch", "Distance", "Focal Point"):
        assert value(new, path) == pytest.approx(value(old, path))


@pytest.mark.parametrize("name", ["Orbit", "XYOrbit", "ThirdPersonFollower"])
def test_fps_takes_over_the_camera_of_any_orbit(make_view: MakeView, name: str) -> None:
    old = make_view(name, Yaw=2.0, Pitch=0.3, Focal_Point=(1.0, 2.0, 0.0))
    new = make_view("FPS")
    put(new, new.mimic(old))
    assert same_picture(new.camera(), old.camera())


def test_fps_takes_the_height_of_the_ortho_view(make_view: MakeView) -> None:
    new = make_view("FPS")
    put(new, new.mimic(make_view("TopDownOrtho", X=3.0)))
    assert value(new, "Position") == (3, 0, 500)
    assert value(new, "Pitch") == pytest.approx(math.pi / 2 - 0.001)


def test_the_ortho_view_comes_over_what_the_old_one_looked_at(
    make_view: MakeView,
) -> None:
    old = make_view("Orbit", Focal_Point=(10.0, 12.0, 1.0))
    new = make_view("TopDownOrtho")
    put(new, new.mimic(old))
    assert tuple(new.camera().position) == (10, 12, 500)
    put(new, new.mimic(make_view("FPS", Position=(1.0, 2.0, 3.0))))
    assert (value(new, "X"), value(new, "Y")) == (1, 2)


def test_xy_orbit_brings_the_middle_of_the_picture_to_the_ground(
    make_view: MakeView,
) -> None:
    old = make_view("Orbit", Yaw=0.0, Pitch=0.5)
    new = make_view("XYOrbit")
    put(new, new.mimic(old))
    camera, new_camera = old.camera(), new.camera()
    assert value(new, "Focal Point")[2] == pytest.approx(0.0, abs=1e-9)
    assert new_camera.position == pytest.approx(camera.position)
    assert new_camera.forward == pytest.approx(camera.forward)


def test_a_view_of_the_sky_leaves_xy_orbit_its_defaults(make_view: MakeView) -> None:
    new = make_view("XYOrbit")
    assert new.mimic(make_view("FPS", Pitch=-0.5)) == {}


# What the mouse does, as the page's camera does it.


def dragged(camera: Camera, yaw: float, pitch: float) -> Camera:
    """The camera after it was turned about the point in the middle."""
    azimuth, elevation = angles_of(camera.position - camera.look_at)
    away = camera.distance * on_sphere(azimuth + yaw, elevation + pitch)
    position = camera.look_at + away
    return camera.placed(position, camera.look_at, camera.up)


@pytest.mark.parametrize("name", ["Orbit", "XYOrbit", "FPS"])
def test_a_turn_of_the_camera_is_a_change_of_yaw_and_pitch(
    make_view: MakeView, name: str
) -> None:
    view = make_view(name, Yaw=0.0, Pitch=0.5)
    read = view.read(dragged(view.camera(), 0.05, 0.05))
    assert read["Yaw"] == pytest.approx(0.05)
    assert read["Pitch"] == pytest.approx(0.55)
    if name == "FPS":
        assert read["Position"] == pytest.approx((5, 5, 10), abs=1e-3)
    else:
        assert read["Distance"] == pytest.approx(10)


@pytest.mark.parametrize("name", PERSPECTIVE)
def test_a_nearer_camera_has_a_smaller_distance(make_view: MakeView, name: str) -> None:
    view = make_view(name)
    camera = view.camera()
    step = 0.1 * camera.distance * camera.forward
    nearer = camera.placed(camera.position + step, camera.look_at, camera.up)
    read = view.read(nearer)
    if name == "FPS":
        assert read["Position"] == pytest.approx(nearer.position)
    else:
        assert read["Distance"] == pytest.approx(9.0)


# Showing a box whole.


def filled(
    view: View, low: Any, high: Any, width: int, height: int, target: Target = WORLD
) -> tuple[float, float, np.ndarray]:
    """How much of the width and of the height a box fills, and where its middle is,
    from −1 to 1 of the picture."""
    camera = view.camera(target)
    corners = np.array([(x, y, z) for x, y, z in product(*zip(low, high, strict=True))])
    middle = np.append(corners, [corners.mean(axis=0)], axis=0) - camera.position
    depth = middle @ camera.forward
    assert (depth > camera.near).all()
    if camera.scale is None:
        half = depth * math.tan(camera.fov / 2)
    else:
        half = np.full(len(depth), height / (2 * camera.scale))
    at = np.stack(
        [
            middle @ camera.right / (half * width / height),
            middle @ camera.image_up / half,
        ]
    )
    across, up = np.abs(at[:, :-1]).max(axis=1)
    return float(across), float(up), at[:, -1]


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize(("width", "height"), [(1280, 720), (390, 844)])
def test_a_box_is_shown_whole_in_the_middle_of_the_picture(
    make_view: MakeView, name: str, width: int, height: int
) -> None:
    low, high = vector(1.0, 2.0, -0.1), vector(1.4, 2.3, 1.5)
    target = Target(vector(3.0, -1.0, 0.5), 0.7)
    view = make_view(name)
    before = view.camera(target)
    put(view, view.fit(low, high, width, height, target))
    camera = view.camera(target)
    assert camera.forward == pytest.approx(before.forward, abs=1e-9)
    assert camera.image_up == pytest.approx(before.image_up, abs=1e-9)
    across, up, middle = filled(view, low, high, width, height, target)
    assert middle == pytest.approx((0.0, 0.0), abs=1e-9)
    assert across <= 0.9 + 1e-9
    assert up <= 0.7 + 1e-9
    assert across == pytest.approx(0.9) or up == pytest.approx(0.7)


@pytest.mark.parametrize("name", ["Orbit", "TopDownOrtho"])
def test_names_of_a_box_are_shown_whole_too(make_view: MakeView, name: str) -> None:
    low, high = vector(1.0, 2.0, -0.1), vector(1.4, 2.3, 0.5)
    target = Target(vector(3.0, -1.0, 0.5), 0.7)
    view = make_view(name, **({"Orthographic": True} if name == "Orbit" else {}))
    put(view, view.fit(low, high, 800, 600, target))
    without = view.camera(target)
    names = [Name(low, 1.6, 0.1), Name(high, 0.1, 0.05)]
    put(view, view.fit(low, high, 800, 600, target, names))
    camera = view.camera(target)
    assert camera.forward == pytest.approx(without.forward, abs=1e-9)

    def edges(camera: Camera) -> list[bool]:
        ways = (camera.right, -camera.right)
        ends = [at.position + way * at.width / 2 for at in names for way in ways]
        ends += [at.position - camera.image_up * at.height for at in names]
        return [camera.shows(end, 800, 600, 0.901) for end in [*ends, low, high]]

    assert not all(edges(without))
    assert all(edges(camera))


def test_a_view_from_below_and_one_of_a_point_are_fitted_too(
    make_view: MakeView,
) -> None:
    view = make_view("Orbit", Invert_Z_Axis=True, Pitch=1.2)
    low, high = vector(-1.0, -1.0, -1.0), vector(1.0, 1.0, 1.0)
    put(view, view.fit(low, high, 800, 600))
    assert view.camera().position[2] < -1.0
    assert filled(view, low, high, 800, 600)[1] == pytest.approx(0.7)
    put(view, view.fit(high, high, 800, 600))
    assert 0.01 < value(view, "Distance") < 0.1
    assert value(view, "Focal Point") == pytest.approx((1.0, 1.0, 1.0))


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_camera_shows_what_is_in_its_picture(orthographic: bool) -> None:
    camera = Camera(vector(0, 0, 10), vector(0, 0, 0), vector(0, 1, 0))
    half = 10 * math.tan(camera.fov / 2)
    if orthographic:
        camera = camera.as_orthographic(400)
    for part in (1.0, 0.5):
        for sign in (-1, 1):
            assert camera.shows(vector(0, sign * 0.99 * part * half, 0), 800, 400, part)
            assert camera.shows(vector(sign * 1.98 * part * half, 0, 0), 800, 400, part)
            assert not camera.shows(
                vector(0, sign * 1.01 * part * half, 0), 800, 400, part
            )
            assert not camera.shows(
                vector(sign * 2.02 * part * half, 0, 0), 800, 400, part
            )
    assert not camera.shows(vector(0, 0, 2000), 800, 400)


def half_height(camera: Camera) -> float:
    """Half of what is seen in the plane of the focal point [m]."""
    return camera.distance * math.tan(camera.fov / 2)


def test_an_orthographic_orbit_shows_the_focal_point_as_large_from_the_same_side(
    make_view: MakeView,
) -> None:
    where = {"Yaw": 0.3, "Pitch": 0.4, "Distance": 2.0, "Focal_Point": (1, 2, 3)}
    near = make_view("Orbit", **where).camera()
    far = make_view("Orbit", **where, Orthographic=True).camera()
    assert far.fov == ORTHO_FIELD_OF_VIEW
    assert half_height(far) == pytest.approx(half_height(near))
    assert far.forward == pytest.approx(near.forward)
    assert far.look_at == pytest.approx(near.look_at)
    # Half a metre nearer, it is not larger by more than a part in a hundred.
    assert far.distance / (far.distance - 0.5) < 1.01


def test_an_orthographic_orbit_reads_the_camera_that_it_has_sent(
    make_view: MakeView,
) -> None:
    view = make_view("Orbit", Yaw=1.3, Pitch=-0.2, Distance=0.7, Orthographic=True)
    read = view.read(view.camera())
    assert read["Distance"] == pytest.approx(0.7)
    assert (read["Yaw"], read["Pitch"]) == pytest.approx((1.3, -0.2))


def test_an_orthographic_orbit_moves_to_look_at_a_point(make_view: MakeView) -> None:
    view = make_view("Orbit", Yaw=0.0, Pitch=0.0, Orthographic=True)
    before = view.camera()
    put(view, view.look_at(vector(0.0, 3.0, 1.0)))
    assert view.camera().look_at == pytest.approx((0.0, 3.0, 1.0))
    assert view.camera().forward == pytest.approx(before.forward)


def test_an_orthographic_orbit_fits_a_box_as_a_perspective_one_does(
    make_view: MakeView,
) -> None:
    low, high = vector(-1, -2, 0), vector(1, 2, 1)
    view = make_view("Orbit", Yaw=0.0, Pitch=0.0, Orthographic=True)
    put(view, view.fit(low, high, 800, 800))
    # Four metres from side to side fill nine tenths of the width.
    assert half_height(view.camera()) == pytest.approx(2.0 / 0.9, rel=0.01)


@pytest.mark.parametrize("name", [name for name in ALL if name != "Orbit"])
def test_after_an_orthographic_orbit_other_views_are_as_near_as_before(
    name: str, make_view: MakeView
) -> None:
    where = {"Yaw": 0.3, "Pitch": 0.4, "Distance": 2.0}
    values = [
        make_view(name).mimic(make_view("Orbit", **where, Orthographic=flat))
        for flat in (False, True)
    ]
    for path, wanted in values[0].items():
        assert values[1][path] == pytest.approx(wanted, abs=1e-6)


def test_zero_brings_the_perspective_back(make_view: MakeView) -> None:
    assert make_view("Orbit", Orthographic=True).zero()["Orthographic"] is False
    assert "Orthographic" not in make_view("XYOrbit").zero()
