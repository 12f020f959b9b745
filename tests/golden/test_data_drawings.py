"""What data displays are drawn with, beside pictures of the real RViz.

The shapes come from the messages of the recordings, without the displays: a ribbon, a
map or a text has to look as RViz's does whatever display asks for it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pytest
from pictures import SAME, Image, drawn, flat, near_part, picture

if TYPE_CHECKING:
    import viser

    from sambot_viz import RvizConfig
    from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

DATA = Path(__file__).parent / "data"
BACKGROUND = 48
Draw = Callable[["viser.SceneApi"], object]
DrawMessages = Callable[["viser.SceneApi", dict[str, list[Any]]], object]


def messages(name: str) -> dict[str, list[Any]]:
    """The messages of a recording by topic."""
    from rosbags.typesys import Stores, get_typestore

    from sambot_viz.sources.bag import open_recording

    store = get_typestore(Stores.ROS2_JAZZY)
    found: dict[str, list[Any]] = {}
    with open_recording(DATA / name / "messages.mcap") as recording:
        while not recording.index_more():
            pass
        for one in recording.messages():
            kind = one.channel.schema.name
            message = store.deserialize_cdr(bytes(one.payload), kind)
            found.setdefault(one.topic, []).append(message)
    return found


def recorded(name: str) -> Image:
    return picture(DATA / name / "render.png")


def picture_of(
    chromium: Chromium, config: RvizConfig, shape: tuple[int, ...], draw: Draw
) -> Image:
    """What a server shows with a config, without messages, and with more to draw."""
    from sambot_viz.export.view_picture import snapshot
    from sambot_viz.options import Options
    from sambot_viz.server.server import Server

    server = Server(Options(port=0, gui=False, panels=False), lambda: config)
    try:
        session = server.sessions.all()[0]
        draw(session.audience.scene)
        view = session.document_view.camera
        found = snapshot(server, chromium, shape[1], shape[0], view)
        return found.astype(np.int16)
    finally:
        server.stop()


def ours(chromium: Chromium, name: str, draw: DrawMessages) -> Image:
    """What is drawn of the messages of a recording."""
    from sambot_viz import load_config

    config = load_config(DATA / name / "config.rviz")
    said = messages(name)
    shape = recorded(name).shape
    return picture_of(chromium, config, shape, lambda scene: draw(scene, said))


def points_of(positions: list[Any]) -> npt.NDArray[np.float64]:
    return np.array([(p.x, p.y, p.z) for p in positions])


def patches(a: Image, b: Image) -> float:
    """The part of RViz's flat patches whose pixels have the same colour in ours."""
    counts = flat(b) & drawn(b, BACKGROUND)
    return float((np.abs(a - b).max(axis=-1) <= SAME)[counts].mean())


def outline(a: Image, b: Image) -> float:
    """The part of what is drawn that is in the other picture within one pixel."""
    # Half a pixel of a line at the edge is in one picture and not in the other.
    return near_part(*(drawn(one[1:-1, 1:-1], BACKGROUND) for one in (a, b)))


def draw_paths(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    from sambot_viz.displays.scene.ribbons import RibbonNode

    odom = said["/tf_static"][0].transforms[0].transform
    turn, at = odom.rotation, odom.translation
    for topic, width, color, T in (
        ("/plan", 0.1, (255, 0, 0), ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))),
        (
            "/local_plan",
            0.05,
            (0, 12, 255),
            ((turn.w, turn.x, turn.y, turn.z), (at.x, at.y, at.z)),
        ),
    ):
        points = points_of([p.pose.position for p in said[topic][0].poses])
        RibbonNode(scene, f"/~{width}").draw(
            points, width, color, wxyz=T[0], position=T[1]
        )


def draw_thin(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    from sambot_viz.displays.scene.lines import LineNode, chain_segments

    points = points_of([p.pose.position for p in said["/plan"][0].poses])
    LineNode(scene, "/~l").draw(chain_segments(points), (25, 255, 0))


def draw_lines(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    from sambot_viz.displays.scene.ribbons import RibbonNode

    for marker in said["/visualization_marker"]:
        points = points_of(marker.points)
        colors = [(c.r, c.g, c.b, c.a) for c in marker.colors]
        if len(colors) != len(points):
            c = marker.color
            colors = [(c.r, c.g, c.b, c.a)] * len(points)
        p, q = marker.pose.position, marker.pose.orientation
        RibbonNode(scene, f"/~{marker.ns}{marker.id}").draw(
            points,
            marker.scale.x,
            255 * np.array(colors),
            counts=[2] * (len(points) // 2) if marker.type == 5 else None,
            wxyz=(q.w, q.x, q.y, q.z),
            position=(p.x, p.y, p.z),
        )


def draw_map(alpha: float, is_behind: bool = False) -> DrawMessages:
    from sambot_viz.displays.scene.maps import MapNode, palette

    def draw(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
        message = said["/map"][0]
        info = message.info
        cells = message.data.view(np.uint8).reshape(info.height, info.width)
        p, q = info.origin.position, info.origin.orientation
        MapNode(scene, "/~map").draw(
            cells,
            palette("map"),
            info.resolution,
            alpha=alpha,
            is_behind=is_behind,
            wxyz=(q.w, q.x, q.y, q.z),
            position=(p.x, p.y, p.z),
        )

    return draw


def draw_cubes(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    draw_map(1.0, is_behind=True)(scene, said)
    for cube in said["/visualization_marker_array"][0].markers:
        p, s, c = cube.pose.position, cube.scale, cube.color
        scene.add_box(
            f"/~c{cube.id}",
            color=(round(255 * c.r), round(255 * c.g), round(255 * c.b)),
            dimensions=(s.x, s.y, s.z),
            position=(p.x, p.y, p.z),
            cast_shadow=False,
            receive_shadow=False,
        )


def draw_odometry(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    from sambot_viz.displays.scene.covariance import covariance_solids
    from sambot_viz.displays.scene.solid_nodes import ArrowsNode, SolidsNode

    of_map = said["/tf_static"][0].transforms[0].transform
    turn, at = of_map.rotation, of_map.translation
    scene.add_frame(
        "/~odom",
        show_axes=False,
        wxyz=(turn.w, turn.x, turn.y, turn.z),
        position=(at.x, at.y, at.z),
    )
    message = said["/odom"][0].pose
    q, p = message.pose.orientation, message.pose.position
    wxyz, position = (q.w, q.x, q.y, q.z), (p.x, p.y, p.z)
    shaft = 0.4 if p.x else 0.5
    ArrowsNode(scene, "/~odom/a").draw(
        [wxyz], [position], (shaft, 0.05), (0.2, 0.1), (255, 25, 0)
    )
    solids = covariance_solids(message.covariance, wxyz, position)
    SolidsNode(scene, "/~odom/c").draw(solids)


def draw_texts(scene: viser.SceneApi, said: dict[str, list[Any]]) -> None:
    from sambot_viz.displays.scene.texts import TextNode

    for marker in said["/visualization_marker_array"][0].markers:
        p, c = marker.pose.position, marker.color
        TextNode(scene, f"/~t{marker.id}").draw(
            marker.text,
            marker.scale.z,
            (round(255 * c.r), round(255 * c.g), round(255 * c.b)),
            alpha=c.a,
            position=(p.x, p.y, p.z),
        )


@pytest.mark.parametrize(
    ("name", "draw"),
    [
        ("path_billboards", draw_paths),
        ("path_lines", draw_thin),
        ("marker_lines", draw_lines),
        ("map_palette_map", draw_map(1.0)),
        ("map_orbit", draw_map(0.7)),
        ("map_draw_behind", draw_cubes),
        ("odom_cov_3d", draw_odometry),
        ("odom_cov_planar", draw_odometry),
    ],
)
def test_the_picture_is_rvizs(
    chromium: Chromium, name: str, draw: DrawMessages
) -> None:
    found, golden = ours(chromium, name, draw), recorded(name)
    # Lines of one pixel have no flat patch.
    assert name == "path_lines" or patches(found, golden) >= 0.99
    assert outline(found, golden) >= 0.97


def box(found: Image, area: tuple[slice, slice]) -> npt.NDArray[np.float64]:
    """Left, top, right and bottom of what is coloured in a part of a picture."""
    bright = found[area].max(axis=-1)
    rows, columns = np.nonzero(bright > (bright.max() + BACKGROUND) / 2)
    top, left = area[0].start, area[1].start
    right, bottom = left + columns.max() + 1, top + rows.max() + 1
    return np.array((left + columns.min(), top + rows.min(), right, bottom), float)


def color(part: Image) -> npt.NDArray[np.float64]:
    """The colour of letters, away from their edges and from lines below them."""
    bright = part.max(axis=-1)
    inside = bright > BACKGROUND + 0.8 * (np.percentile(bright, 99) - BACKGROUND)
    return np.asarray(np.median(part[inside], axis=0), float)


TEXTS = {
    "Robot_1": (slice(90, 160), slice(200, 440)),
    "two lines": (slice(200, 290), slice(120, 300)),
    "Ag": (slice(245, 360), slice(340, 560)),
}


def test_texts_have_the_boxes_and_colours_of_rviz(chromium: Chromium) -> None:
    """RViz 2's letters are 0.889 of the height of a line, the recording's 0.857."""
    name = "marker_text"
    found, golden = ours(chromium, name, draw_texts), recorded(name)
    for text, area in TEXTS.items():
        us, them = box(found, area), box(golden, area)
        assert (us[:2] + us[2:]) / 2 == pytest.approx((them[:2] + them[2:]) / 2, abs=2)
        larger = 0.889 / 0.857
        width, height = them[2:] - them[:2]
        # One line is as far below the other in both.
        height *= 1.0 if text == "two lines" else larger
        assert us[2:] - us[:2] == pytest.approx((width * larger, height), abs=2)
    # Half of (0, 255, 255) over the background; the recording's letters are blurred.
    assert color(found[TEXTS["Ag"]]) == pytest.approx((24, 151.5, 151.5), abs=3)
    assert color(golden[TEXTS["Ag"]]) == pytest.approx((24, 151.5, 151.5), abs=12)


def test_each_value_of_a_cell_has_its_colour(chromium: Chromium) -> None:
    """The middles of all 256 cells, 28 pixels apart."""
    name = "map_palette_map"
    found, golden = ours(chromium, name, draw_map(1.0)), recorded(name)
    at = slice(240 - 7 * 28 - 14, 240 + 8 * 28, 28), slice(320 - 7 * 28 - 14, 558, 28)
    assert found[at].shape == (16, 16, 3)
    assert np.abs(found[at] - golden[at]).max() <= 1


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


def test_wide_lines_of_a_grid_end_where_the_lines_end(chromium: Chromium) -> None:
    """The grid of RViz 2's own visual test, which is seen edge-on.

    Lines 4 m wide, the nearest 5 m away, cover its picture but for 15 pixels at the
    left and at the right: they have no caps.
    """
    from sambot_viz.inputs import declarations
    from sambot_viz.rviz import RvizConfig

    config = RvizConfig.parse(EDGE_ON, declarations())
    found = picture_of(chromium, config, (751, 756), lambda scene: None)
    covered = drawn(found, BACKGROUND)
    columns = np.nonzero(covered.any(axis=0))[0]
    assert abs(columns[0] - 15) <= 1
    assert abs(columns[-1] - 740) <= 1
    assert (found[:, 17:739] == (255, 255, 0)).all()


def test_colours_between_the_ends_of_a_line_change_as_those_of_rviz(
    chromium: Chromium,
) -> None:
    """Evenly in the numbers of the screen: half red and half blue are (128, 0, 128)."""
    from sambot_viz.displays.scene.lines import LineNode
    from sambot_viz.inputs import declarations
    from sambot_viz.rviz import RvizConfig

    def draw(scene: viser.SceneApi) -> None:
        across = [[(0, -2, z), (0, 2, z)] for z in np.linspace(-0.05, 0.05, 60)]
        red, blue = (255, 0, 0, 255), (0, 0, 255, 255)
        LineNode(scene, "/~l").draw(across, np.array(60 * [[red, blue]]), alpha=0.5)

    text = EDGE_ON.replace("Enabled: true", "Enabled: false")
    config = RvizConfig.parse(text, declarations())
    found = picture_of(chromium, config, (400, 600), draw)
    # Each of many lines over the background and over those behind it: only the ratio
    # of red and blue is known.
    red, green, blue = found[200, 300].tolist()
    assert green < 48
    assert red == pytest.approx(blue, abs=SAME)
    left, right = found[200, 210].tolist(), found[200, 390].tolist()
    assert left[0] > left[2] + 60
    assert right[2] > right[0] + 60


def test_a_mesh_is_shaded_by_the_normals_of_its_file(chromium: Chromium) -> None:
    """Tilted by 60° they make a square seen from above half as bright."""
    from sambot_viz import load_config
    from sambot_viz.meshes.glb import to_glb
    from sambot_viz.meshes.mesh import MeshPart

    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    tilted = np.tile(np.array([0, np.sqrt(0.75), 0.5], np.float32), (4, 1))
    config = load_config(DATA / "map_palette_map" / "config.rviz")

    def draw(scene: viser.SceneApi) -> None:
        for place, normals in ((-1.0, None), (1.0, tilted)):
            part = MeshPart(corners, faces, normals, (1.0, 0.8, 0.4, 1.0))
            data = to_glb(part)
            scene.add_glb(f"/~{place}", data, scale=0.8, position=(place, 0, 0))

    seen = picture_of(chromium, config, (240, 320, 3), draw)
    shown = {tuple(color) for color in seen.reshape(-1, 3).tolist()}
    for color in ((255, 204, 102), (128, 102, 51)):
        assert any(np.abs(np.subtract(one, color)).max() <= 2 for one in shown)
