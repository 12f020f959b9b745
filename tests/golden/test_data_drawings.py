"""Lines and meshes beside what is known of those of RViz, without its pictures."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from pictures import SAME, Image, drawn

if TYPE_CHECKING:
    import viser
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

BACKGROUND = 48
Draw = Callable[["viser.SceneApi"], object]
EDGE_ON = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
      Plane: XZ
      Alpha: 1
      Color: 255; 255; 0
      Line Style:
        Line Width: 4
        Value: Billboards
  Global Options:
    Background Color: 48; 48; 48
    Fixed Frame: map
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 10
      Yaw: 0
      Pitch: 0
"""
FROM_ABOVE = """
Visualization Manager:
  Views:
    Current:
      Class: rviz_default_plugins/TopDownOrtho
      Scale: 112
"""


def picture_of(
    shared_page: SharedPage, text: str, shape: tuple[int, ...], draw: Draw
) -> Image:
    """What is shown with the text of a config, and with more to draw."""
    from sambot_viz.inputs import declarations
    from sambot_viz.rviz import RvizConfig

    config = RvizConfig.parse(text, declarations())
    with shared_page.shows(config=config) as session:
        draw(session.audience.scene)
        return shared_page.picture(session, shape)


def test_wide_lines_of_a_grid_end_where_the_lines_end(shared_page: SharedPage) -> None:
    """The grid of RViz 2's own visual test, which is seen edge-on.

    Lines 4 m wide, the nearest 5 m away, cover its picture but for 15 pixels at the
    left and at the right: they have no caps.
    """
    found = picture_of(shared_page, EDGE_ON, (751, 756), lambda scene: None)
    covered = drawn(found, BACKGROUND)
    columns = np.nonzero(covered.any(axis=0))[0]
    assert abs(columns[0] - 15) <= 1
    assert abs(columns[-1] - 740) <= 1
    assert (found[:, 17:739] == (255, 255, 0)).all()


def test_colours_between_the_ends_of_a_line_change_as_those_of_rviz(
    shared_page: SharedPage,
) -> None:
    """Evenly in the numbers of the screen: half red and half blue are (128, 0, 128)."""
    from sambot_viz.displays.scene.lines import LineNode

    def draw(scene: viser.SceneApi) -> None:
        across = [[(0, -2, z), (0, 2, z)] for z in np.linspace(-0.05, 0.05, 60)]
        red, blue = (255, 0, 0, 255), (0, 0, 255, 255)
        LineNode(scene, "/~l").draw(across, np.array(60 * [[red, blue]]), alpha=0.5)

    text = EDGE_ON.replace("Enabled: true", "Enabled: false")
    found = picture_of(shared_page, text, (400, 600), draw)
    # Each of many lines over the background and over those behind it: only the ratio
    # of red and blue is known.
    red, green, blue = found[200, 300].tolist()
    assert green < 48
    assert red == pytest.approx(blue, abs=SAME)
    left, right = found[200, 210].tolist(), found[200, 390].tolist()
    assert left[0] > left[2] + 60
    assert right[2] > right[0] + 60


def test_a_mesh_is_shaded_by_the_normals_of_its_file(shared_page: SharedPage) -> None:
    """Tilted by 60° they make a square seen from above half as bright."""
    from sambot_viz.meshes.glb import to_glb
    from sambot_viz.meshes.mesh import MeshPart

    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    tilted = np.tile(np.array([0, np.sqrt(0.75), 0.5], np.float32), (4, 1))

    def draw(scene: viser.SceneApi) -> None:
        for place, normals in ((-1.0, None), (1.0, tilted)):
            part = MeshPart(corners, faces, normals, (1.0, 0.8, 0.4, 1.0))
            data = to_glb(part)
            scene.add_glb(f"/~{place}", data, scale=0.8, position=(place, 0, 0))

    seen = picture_of(shared_page, FROM_ABOVE, (240, 320), draw)
    shown = {tuple(color) for color in seen.reshape(-1, 3).tolist()}
    for color in ((255, 204, 102), (128, 102, 51)):
        assert any(np.abs(np.subtract(one, color)).max() <= 2 for one in shown)


def test_triangles_are_lit_on_the_side_from_which_they_turn_left(
    shared_page: SharedPage,
) -> None:
    """The other side is black, as in RViz, also when a scale mirrors them."""
    from sambot_viz.displays.data.markers.marker_triangles import TrianglesNode

    def draw(scene: viser.SceneApi) -> None:
        left = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        for number, (corners, x) in enumerate(
            [(left, 1.0), (left, -1.0), (left[::-1], 1.0), (left[::-1], -1.0)]
        ):
            marker = SimpleNamespace(
                points=[SimpleNamespace(x=a, y=b, z=c) for a, b, c in corners],
                scale=SimpleNamespace(x=x, y=1.0, z=1.0),
                color=SimpleNamespace(r=1.0, g=0.0, b=number / 3, a=1.0),
                colors=[],
                texture_resource="",
                uv_coordinates=[],
            )
            place = (1.5 * (number % 2) - 0.75, 1.5 * (number // 2) - 0.75, 0.0)
            node = TrianglesNode(scene, f"/~t{number}")
            node.draw(marker, (1.0, 0.0, 0.0, 0.0), place)

    seen = picture_of(shared_page, FROM_ABOVE, (480, 640, 3), draw)
    shown = {tuple(color) for color in seen.reshape(-1, 3).tolist()}
    assert {(255, 0, 0), (255, 0, 85), (0, 0, 0)} <= shown
    assert not {(255, 0, 170), (255, 0, 255)} & shown


def test_points_of_a_depth_image_grow_with_their_depth(shared_page: SharedPage) -> None:
    """Two squares, 0.2 m for each metre along z, at 112 pixels a metre."""
    from sambot_viz.displays.scene.points import PointNode, PointStyle

    style = PointStyle("Flat Squares", (0.2, 0.2, 0.2), is_by_depth=True)
    colors = np.array([[255, 0, 0], [0, 255, 0]], np.uint8)

    def draw(scene: viser.SceneApi) -> None:
        PointNode(scene, "/~p").draw([(-1, 0, 1), (1, 0, 3)], colors, style)

    seen = picture_of(shared_page, FROM_ABOVE, (240, 320), draw)
    for channel, metres in ((0, 0.2), (1, 0.6)):
        pixels = (seen[..., channel] == 255).sum()
        assert np.sqrt(pixels) == pytest.approx(112 * metres, abs=1)


def test_the_centre_of_mass_is_seen_through_the_robot(shared_page: SharedPage) -> None:
    """Its ball is yellow and black, in the middle of an opaque box."""
    from sambot_viz import bundled, load_config

    config = load_config(bundled.config_path())
    config.view.set("Distance", 1.0)
    # Of the box and of the wheels together.
    config.view.set("Focal Point", (-0.05 / 16.5, 0.0, -0.095 / 16.5))
    for display in config.displays:
        display.set_enabled(display.name == "RobotModel")
        if display.name == "RobotModel":
            display.set("Alpha", 1.0)
            display.set("Mass Properties/Balance", True)
    model = bundled.model_path("sam_bot_collision.urdf.xacro")
    with shared_page.shows(model=model, config=config) as session:
        seen = shared_page.picture(session, (480, 640))
    middle = seen[240 - 8 : 240 + 8, 320 - 8 : 320 + 8]
    for color in ((255, 210, 0), (0, 0, 0)):
        assert (np.abs(middle - color).max(axis=-1) <= 1).mean() > 0.1
