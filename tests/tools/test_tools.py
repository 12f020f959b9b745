"""The tools of a session: what clicks, rectangles and keys of a browser do."""

from __future__ import annotations

import itertools
import math
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
import yaml
from inside import session_of, viser_server
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, bundled, load_config, load_robot
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.errors import UsageError
from sambot_viz.session import Session
from sambot_viz.session.clients.client_tools import ClientTools
from sambot_viz.session.clients.client_view import ClientView
from sambot_viz.session.scene.picker import INLINE
from sambot_viz.tools.picking.pick_scene import PickSnapshot
from sambot_viz.tools.registry import TOOLS

PREFIX = "rviz_default_plugins/"
LABELS = [tool.label for tool in TOOLS.values()]
BESIDE = (0.3, 0.3)
"""A place of the grid with nothing of the robot above or below it."""


@dataclass
class Browser:
    """A browser that clicks and presses keys, without a page."""

    viz: Visualizer
    session: Session
    client: ProtocolClient

    def settle(self) -> None:
        self.client.settle(viser_server(self.viz))

    def click(
        self, origin: Any, direction: Any = (0.0, 0.0, -1.0), modifier: Any = None
    ) -> None:
        """Click along a ray of the fixed frame."""
        self.client.send(
            "ScenePointerMessage",
            event_type="click",
            ray_origin=origin,
            ray_direction=direction,
            screen_pos=((0.5, 0.5),),
            modifier=modifier,
        )
        self.settle()

    def click_down(self, x: float, y: float, modifier: str | None = None) -> None:
        """Click from 5 m above."""
        self.click((x, y, 5.0), modifier=modifier)

    def look_down(self, **wrong: Any) -> None:
        """Put the camera 5 m above the origin, with x to the right."""
        camera = {
            "wxyz": (0.0, 1.0, 0.0, 0.0),
            "position": (0.0, 0.0, 5.0),
            "fov": 0.785,
            "near": 0.01,
            "far": 1000.0,
            "image_height": 480,
            "image_width": 640,
            "look_at": (0.0, 0.0, 0.0),
            "up_direction": (0.0, 1.0, 0.0),
        }
        self.client.send("ViewerCameraMessage", **camera | wrong)
        self.settle()

    def rectangle(self, low: Any, high: Any) -> None:
        """Draw a rectangle, given from 0 to 1 of the picture."""
        self.client.send(
            "ScenePointerMessage",
            event_type="rect-select",
            ray_origin=None,
            ray_direction=None,
            screen_pos=(low, high),
            modifier=None,
        )
        self.settle()

    def act(self, row_id: str, *values: object) -> None:
        """Do what a button or a key of the page does."""
        self.client.act(row_id, *values)
        self.settle()

    def choose(self, label: str) -> None:
        """Press the button of a tool."""
        self.act("tools/choose", label)

    @property
    def tools(self) -> ClientTools:
        """Those of the browser, which is the only one."""
        (browser,) = self.session.clients.all.values()
        return browser.tools

    @property
    def view(self) -> ClientView:
        """That of the browser."""
        (browser,) = self.session.clients.all.values()
        return browser.view

    @property
    def current(self) -> str:
        return self.tools.current.label

    @property
    def selected(self) -> list[str]:
        return [item.name for item in self.tools.selection]


def document(path: Path, *displays: str, color: str = "1; 2; 3") -> Path:
    """The bundled config with only some of its displays, and three tools."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = config["Visualization Manager"]
    manager["Displays"] = [
        d for d in manager["Displays"] if d["Class"].rpartition("/")[2] in displays
    ]
    manager["Global Options"]["Fixed Frame"] = "base_link"
    manager["Tools"] = [
        {"Class": f"{PREFIX}MoveCamera"},
        {"Class": f"{PREFIX}Select"},
        {"Class": f"{PREFIX}Measure", "Line color": color},
    ]
    path.write_text(yaml.safe_dump(config), "utf-8")
    return path


@pytest.fixture
def open_browser(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> Iterator[Callable[..., Browser]]:
    """Show sam_bot with some displays: ``open_browser("RobotModel", "Grid")``."""
    opened: list[Visualizer] = []

    def start(*displays: str, camera: bool = True) -> Browser:
        viz = Visualizer(config=document(tmp_path / "t.rviz", *displays), port=0)
        opened.append(viz)
        session = session_of(viz)
        client = protocol(urlsplit(viz.url).port or 0, camera=camera)
        browser = Browser(viz, session, client)
        if camera:
            browser.settle()
        return browser

    yield start
    for viz in opened:
        viz.stop()


@pytest.fixture
def browser(open_browser: Callable[..., Browser]) -> Browser:
    """sam_bot and a grid, without the axes of frames."""
    return open_browser("RobotModel", "Grid")


# Choosing tools.


def test_the_first_tool_of_the_file_is_current(browser: Browser) -> None:
    assert browser.current == "Move Camera"
    assert len(browser.tools.tools) == len(TOOLS)


@pytest.mark.parametrize("before", LABELS)
def test_a_button_chooses_its_tool_whichever_is_current(
    browser: Browser, before: str
) -> None:
    for after in LABELS:
        browser.choose(before)
        browser.choose(after)
        assert browser.current == after, f"{before} to {after}"


def test_a_key_chooses_its_tool_whichever_is_current(browser: Browser) -> None:
    for before, after in itertools.permutations(LABELS, 2):
        browser.choose(before)
        browser.act("tools/press", after)
        assert browser.current == after, f"{before} to {after}"


@pytest.mark.parametrize("label", LABELS)
def test_the_key_of_the_current_tool_leaves_it_and_so_does_escape(
    browser: Browser, label: str
) -> None:
    browser.choose(label)
    browser.act("tools/press", label)
    assert browser.current == "Move Camera"
    browser.choose(label)
    browser.act("tools/escape")
    assert browser.current == "Move Camera"


def test_a_tool_that_does_not_exist_is_refused(browser: Browser) -> None:
    for act in (browser.tools.choose, browser.tools.press):
        with pytest.raises(UsageError, match=r"there is no tool 'x/Y'; there are "):
            act("x/Y")
    with pytest.raises(UsageError, match=r"there is no view type 'x/Y'; there are "):
        browser.view.set_kind("x/Y")


# Selecting.


def test_a_click_selects_adds_and_removes(browser: Browser) -> None:
    browser.choose("Select")
    browser.click_down(0.0, 0.0)
    assert list(browser.tools.selection) == [Selectable("link", "base_link")]
    browser.click_down(-0.12, 0.18, "shift")
    assert browser.selected == ["base_link", "drivewhl_l_link"]
    browser.click_down(0.0, 0.0, "shift")
    assert len(browser.selected) == 2
    browser.click_down(0.0, 0.0, "cmd/ctrl")
    assert browser.selected == ["drivewhl_l_link"]
    browser.click_down(3.0, 3.0)
    assert browser.selected == []


def test_a_rectangle_selects_what_can_be_seen_in_it(browser: Browser) -> None:
    browser.choose("Select")
    browser.look_down()
    browser.rectangle((0.4, 0.4), (0.6, 0.6))
    wheels = {"drivewhl_l_link", "drivewhl_r_link"}
    # The caster is seen through the base; nothing is seen through a solid one.
    assert set(browser.selected) == {"base_link", "front_caster", *wheels}
    model = browser.session.scene.displays[1]
    browser.session.display_edits.set_property(model, "Alpha", 1.0)
    browser.rectangle((0.4, 0.4), (0.6, 0.6))
    assert set(browser.selected) == {"base_link", *wheels}
    # The same rectangle, from the other corner, around the left wheel alone.
    browser.rectangle((0.481, 0.459), (0.475, 0.454))
    assert browser.selected == ["drivewhl_l_link"]


def test_a_grid_hides_nothing_that_is_behind_it(browser: Browser) -> None:
    browser.choose("Select")
    # The grid is in the middle of the base; from below the base is behind it.
    browser.click((-0.12, 0.5, -0.08), (0.0, -1.0, 0.0))
    assert browser.selected == ["drivewhl_l_link"]
    browser.click((0.0, 0.18, -5.0), (-0.12 / 5, 0.0, 1.0))
    assert browser.selected == ["drivewhl_l_link"]
    browser.click((0.6, 0.0, 0.3), (-0.6, 0.0, -0.38))
    assert browser.selected == ["base_link"]


def test_a_frame_is_selected_by_its_axes_and_a_link_beside_them(
    open_browser: Callable[..., Browser],
) -> None:
    browser = open_browser("RobotModel", "TF")
    browser.choose("Select")
    wheel = "drivewhl_l_link"
    # From the side, the wheel's y axis sticks out of its middle.
    browser.click((-0.12, 5.0, -0.05), (0.0, -1.0, 0.0))
    assert list(browser.tools.selection) == [Selectable("frame", wheel)]
    browser.click((-0.12, 5.0, -0.12), (0.0, -1.0, 0.0))
    assert list(browser.tools.selection) == [Selectable("link", wheel)]


def test_the_axes_of_a_link_hide_it(open_browser: Callable[..., Browser]) -> None:
    browser = open_browser("RobotModel")
    (model,) = browser.session.scene.displays
    browser.choose("Select")
    for on, selected in ((True, []), (False, ["drivewhl_l_link"])):
        browser.session.display_edits.set_entry(
            model, "Links", "drivewhl_l_link", "Show Axes", on
        )
        browser.click_down(-0.12, 0.18)
        assert browser.selected == selected


@pytest.mark.parametrize(
    ("name", "height"),
    [("Mass Properties/Mass", 0.2758), ("Mass Properties/Inertia", 0.0775)],
)
def test_masses_and_inertias_can_be_measured(
    open_browser: Callable[..., Browser], tmp_path: Path, name: str, height: float
) -> None:
    """Of 1 t: a ball of lead, and a box of 0.155 m."""
    model = tmp_path / "m.urdf"
    model.write_text(
        '<robot name="m"><link name="base_link"><inertial><mass value="1000"/>'
        '<inertia ixx="4" iyy="4" izz="4" ixy="0" ixz="0" iyz="0"/></inertial>'
        "</link></robot>",
        "utf-8",
    )
    browser = open_browser("RobotModel")
    browser.session.show_robot(load_robot(model))
    (display,) = browser.session.scene.displays
    browser.session.display_edits.set_property(display, name, True)
    browser.choose("Focus Camera")
    browser.click_down(0.0, 0.0)
    point = browser.view.values["Focal Point"]
    assert point == pytest.approx((0.0, 0.0, height), abs=1e-3)


def test_the_arrow_of_a_joint_can_be_measured(
    open_browser: Callable[..., Browser],
) -> None:
    browser = open_browser("RobotModel")
    (model,) = browser.session.scene.displays
    browser.session.display_edits.set_property(model, "Alpha", 0.0)
    browser.session.display_edits.set_entry(
        model, "Joints", "drivewhl_l_joint", "Show Joint Axis", True
    )
    browser.choose("Measure")
    for y in (0.25, 0.28):
        browser.click_down(-0.12, y)
    assert browser.tools.status.startswith("0.03 m. ")


def test_frames_and_links_that_are_not_drawn_are_not_selected(
    open_browser: Callable[..., Browser],
) -> None:
    browser = open_browser("RobotModel", "TF")
    tf, model = browser.session.scene.displays
    if tf.kind.endswith("RobotModel"):
        tf, model = model, tf
    browser.choose("Select")
    browser.look_down()
    browser.rectangle((0.0, 0.0), (1.0, 1.0))
    kinds = {item.kind for item in browser.tools.selection}
    assert kinds == {"link", "frame"}
    browser.session.display_edits.set_property(tf, "Frames/All Enabled", False)
    browser.session.display_edits.set_property(model, "Alpha", 0.0)
    browser.rectangle((0.0, 0.0), (1.0, 1.0))
    assert browser.selected == []


@pytest.mark.parametrize(
    ("origin", "direction"),
    [
        ((float("nan"), 0.0, 5.0), (0.0, 0.0, -1.0)),
        ((0.0, 0.0, 5.0), (0.0, 0.0, float("inf"))),
        ((0.0, 0.0, 5.0), (0.0, 0.0, 0.0)),
        (None, None),
    ],
)
def test_a_click_that_is_not_a_ray_is_ignored(
    browser: Browser, capfd: pytest.CaptureFixture[str], origin: Any, direction: Any
) -> None:
    browser.choose("Select")
    browser.click_down(0.0, 0.0)
    browser.click(origin, direction)
    assert browser.selected == ["base_link"]
    assert "Traceback" not in "".join(capfd.readouterr())


def test_a_rectangle_that_is_not_one_is_ignored(
    browser: Browser, capfd: pytest.CaptureFixture[str]
) -> None:
    browser.choose("Select")
    browser.look_down()
    browser.rectangle((0.4, 0.4), (0.6, 0.6))
    before = browser.selected
    nan = float("nan")
    browser.rectangle((nan, 0.4), (0.6, 0.6))
    assert browser.selected == before
    browser.look_down(fov=nan)
    browser.rectangle((0.4, 0.4), (0.6, 0.6))
    assert browser.selected == before
    assert "Traceback" not in "".join(capfd.readouterr())


def test_selection_boxes_move_with_their_links(browser: Browser) -> None:
    browser.choose("Select")
    browser.click_down(-0.12, 0.18)
    mark = browser.client.mark()
    browser.viz.set_joint_positions({"drivewhl_l_joint": 0.4})
    browser.settle()
    names = [m.fields.get("name") for m in browser.client.since(mark)]
    assert "/~selected1" in names
    browser.click_down(3.0, 3.0)
    assert browser.client.types(mark)["RemoveSceneNodeMessage"] == 1


# Measuring and focusing.


def test_measure_shows_the_distance_of_two_points(browser: Browser) -> None:
    tools = browser.tools
    browser.choose("Measure")
    browser.click_down(1.0, 1.0)
    assert tools.status == "Click the second point."
    browser.click_down(2.0, 1.0)
    assert tools.status.startswith("1 m. ")
    browser.click_down(200.0, 1.0)
    assert tools.status.startswith("1 m. "), "a click on the background does nothing"
    browser.click_down(3.0, 1.0)
    assert tools.status == "Click the second point."
    browser.act("tools/escape")
    assert browser.current == "Move Camera"
    assert tools.status == ""


def test_a_measurement_that_was_left_half_begins_anew(browser: Browser) -> None:
    tools = browser.tools
    browser.choose("Measure")
    browser.click_down(1.0, 1.0)
    browser.choose("Move Camera")
    browser.choose("Measure")
    browser.click_down(3.0, 1.0)
    assert tools.status == "Click the second point."
    browser.click_down(4.0, 1.0)
    assert tools.status.startswith("1 m. ")


def test_measure_is_the_same_with_and_without_a_grid_in_between(
    open_browser: Callable[..., Browser],
) -> None:
    lengths: list[str] = []
    for displays in (("RobotModel", "Grid"), ("RobotModel",)):
        browser = open_browser(*displays)
        browser.choose("Measure")
        # Two points of the base's front, the second below the plane of the grid.
        browser.click((1.0, 0.0, 0.5), (-0.79, 0.0, -0.45))
        browser.click((1.0, 0.0, 0.5), (-0.79, 0.0, -0.55))
        lengths.append(browser.tools.status)
    assert lengths[0] == lengths[1] != ""
    assert lengths[0].startswith("0.1")


def test_measure_takes_points_of_what_is_drawn_near_a_frame(
    open_browser: Callable[..., Browser],
) -> None:
    browser = open_browser("Grid", "TF")
    session, x = browser.session, -0.12 + 0.03
    with session.lock:
        session.document.config.displays[0].set("Offset", (x, 0.0, 0.0))
    browser.settle()
    browser.choose("Measure")
    # On a line beside the axes of the wheel, in the sphere that selects the frame, and
    # farther from its origin than a click means it.
    browser.click((x, 0.18 + 0.03, 1.0))
    browser.click((x, 2.21, 1.0))
    assert browser.tools.status.startswith("2 m. ")


def test_measure_takes_the_origins_of_frames_and_says_which(
    open_browser: Callable[..., Browser],
) -> None:
    browser = open_browser("RobotModel", "Grid")
    with browser.session.lock:
        origins = browser.tools.frame_origins()
    left, right = (origins[f"drivewhl_{side}_link"].tolist() for side in "lr")
    browser.choose("Measure")
    # A few millimetres beside the axle, which is inside of the wheel.
    browser.click((left[0] + 0.004, left[1] + 0.003, 5.0))
    assert browser.tools.status == "From drivewhl_l_link. Click the second point."
    browser.click((right[0] - 0.004, right[1], 5.0))
    assert browser.tools.status.startswith(
        "0.36 m from drivewhl_l_link to drivewhl_r_link. "
    )


def on_screen(x: float, y: float) -> tuple[float, float]:
    """Where a point of the ground is in the picture of `Browser.look_down`."""
    pixels = 480 / (2 * 5.0 * math.tan(0.785 / 2))
    return 0.5 + x * pixels / 640, 0.5 - y * pixels / 480


def test_the_line_follows_the_mouse_until_the_second_click(browser: Browser) -> None:
    tools = browser.tools
    browser.look_down()
    browser.choose("Measure")
    tools.hover(on_screen(1.0, 1.0))
    assert (tools.status, tools.current.wants_hover) == ("", False)
    browser.click_down(1.0, 1.0)
    assert tools.current.wants_hover
    tools.hover(on_screen(2.0, 1.0))
    assert tools.status.startswith(
        "1 m. Click two points or frames; a right click starts again, Esc "
    )
    tools.hover(on_screen(1.0, 1.5))
    assert tools.status.startswith("0.5 m. ")
    tools.hover((2.0, 0.5))
    tools.hover((math.nan, 0.5))
    assert tools.status.startswith("0.5 m. "), "not a place in the picture"
    browser.click_down(1.0, 3.0)
    assert not tools.current.wants_hover
    tools.hover(on_screen(2.0, 1.0))
    assert tools.status.startswith("2 m. ")


def test_a_line_that_follows_the_mouse_is_not_added_again(browser: Browser) -> None:
    browser.look_down()
    browser.choose("Measure")
    browser.click_down(1.0, 1.0)
    browser.tools.hover(on_screen(2.0, 1.0))
    browser.settle()
    mark = browser.client.mark()
    for x in (1.5, 1.2, 1.7):
        browser.tools.hover(on_screen(x, 1.0))
        browser.settle()
    sent = browser.client.types(mark)
    assert sent["SceneNodeUpdateMessage"] >= 3
    assert not [name for name in sent if "Remove" in name or "LineSegments" in name]


def test_a_right_click_starts_the_measurement_again(browser: Browser) -> None:
    tools = browser.tools
    browser.choose("Measure")
    for x in (1.0, 2.0):
        browser.click_down(x, 1.0)
    tools.right_click()
    assert tools.status == ""
    assert browser.current == "Measure"
    browser.click_down(1.0, 1.0)
    tools.right_click()
    assert not tools.current.wants_hover
    browser.click_down(1.0, 1.0)
    assert tools.status == "Click the second point."


def test_focus_shows_the_point_under_the_mouse(browser: Browser) -> None:
    browser.look_down()
    browser.choose("Focus Camera")
    browser.tools.hover(on_screen(0.05, 0.05))
    assert browser.tools.status.startswith("[0.0491, 0.0491, 0.09] ")
    browser.click((3.0, 0.0, 0.5), (0.0, 0.0, 1.0))
    browser.tools.hover(on_screen(0.05, 0.05))
    assert browser.tools.status == "", "the tool was used, and is left"


def test_focus_looks_at_the_point_and_goes_back(browser: Browser) -> None:
    browser.choose("Focus Camera")
    browser.click_down(0.05, 0.05)
    focal = browser.view.values["Focal Point"]
    assert focal == pytest.approx((0.05, 0.05, 0.09), abs=1e-3)
    assert browser.current == "Move Camera"


def test_over_the_background_focus_looks_one_metre_ahead(browser: Browser) -> None:
    browser.choose("Focus Camera")
    browser.click((3.0, 0.0, 0.5), (0.0, 0.0, 1.0))
    values = browser.view.values
    assert values["Focal Point"] == pytest.approx((3.0, 0.0, 1.5))


def test_focus_looks_at_what_is_selected_under_the_mouse_or_the_robot(
    browser: Browser,
) -> None:
    values = browser.view.values
    browser.look_down()
    browser.act("tools/focus", *on_screen(1.0, 0.5))
    assert values["Focal Point"] == pytest.approx((1.0, 0.5, 0.0), abs=0.02)
    browser.choose("Select")
    browser.click_down(-0.12, 0.18)
    browser.act("tools/focus", *on_screen(1.0, 0.5))
    assert values["Focal Point"] == pytest.approx((-0.12, 0.18, -0.05), abs=1e-6)
    browser.choose("Move Camera")
    browser.look_down()
    browser.act("tools/focus", *on_screen(1.0, 0.5))
    assert values["Focal Point"] == pytest.approx((1.0, 0.5, 0.0), abs=0.02)
    browser.act("tools/focus", None, None)
    assert values["Focal Point"] == pytest.approx((-0.12, 0.18, -0.05), abs=1e-6)


def test_focus_on_nothing_shows_the_whole_robot(browser: Browser) -> None:
    values = browser.view.values
    for place in ((None, None), (0.01, 0.01), (2.0, 0.5)):
        browser.look_down(position=(50.0, 0.0, 500.0), look_at=(50.0, 0.0, 0.0))
        browser.act("tools/focus", *place)
        assert np.abs(values["Focal Point"]).max() < 0.3, place
        assert values["Distance"] < 2.0, place


# Settings.


def test_settings_come_from_the_file_and_go_back(browser: Browser) -> None:
    session = browser.session
    session.document.set_tool_property(f"{PREFIX}Measure", "Line color", (4, 5, 6))
    assert "4; 5; 6" in browser.session.document.config.to_yaml()
    with pytest.raises(UsageError, match="the config has no tool"):
        session.document.set_tool_property(
            f"{PREFIX}Interact", "Hide Inactive Objects", False
        )


def test_settings_go_into_the_document_that_was_read_last(
    browser: Browser, tmp_path: Path
) -> None:
    path = document(tmp_path / "new.rviz", "Grid", color="7; 8; 9")
    browser.session.document.replace(load_config(path))
    browser.settle()
    color = "tool_properties/Measure/Line color"
    assert browser.client.row(color)["value"] == [7, 8, 9]
    browser.client.edit(color, [4, 5, 6])
    browser.settle()
    assert "4; 5; 6" in browser.session.document.config.to_yaml()


def test_a_click_reads_no_file(browser: Browser, tmp_path: Path) -> None:
    """A mesh that is not read yet is not under the cursor yet; nobody waits for it."""
    mesh = tmp_path / "m.stl"
    mesh.write_text("solid m\n" + FACET + "endsolid m\n", "utf-8")
    model = tmp_path / "m.urdf"
    model.write_text(
        '<robot name="m"><link name="base_link"><visual><geometry>'
        f'<mesh filename="file://{mesh}"/></geometry></visual></link></robot>',
        "utf-8",
    )
    browser.session.show_robot(load_robot(model))
    browser.viz.server.sessions.wait_for_meshes(patience(30.0))
    browser.choose("Select")
    browser.click_down(0.0, 0.0)
    assert browser.selected == ["base_link"]
    mesh.unlink()
    browser.click_down(0.0, 0.0)
    assert np.isfinite(browser.view.camera.position).all()


@pytest.fixture
def large(browser: Browser, tmp_path: Path) -> Browser:
    """A browser that sees a mesh of more than a hundred thousand triangles."""
    mesh = tmp_path / "large.stl"
    count = write_flat_mesh(mesh, side=225)
    assert count > INLINE
    model = tmp_path / "large.urdf"
    model.write_text(
        '<robot name="m"><link name="base_link"><visual><geometry>'
        f'<mesh filename="file://{mesh}"/></geometry></visual></link></robot>',
        "utf-8",
    )
    browser.session.show_robot(load_robot(model))
    browser.viz.server.sessions.wait_for_meshes(patience(30.0))
    browser.choose("Select")
    return browser


def test_a_click_into_a_large_mesh_is_followed_in_a_thread(large: Browser) -> None:
    large.click_down(0.1, 0.2)
    large.client.wait_until(lambda: large.selected == ["base_link"])
    threads = [thread.name for thread in threading.enumerate()]
    assert any(name.startswith("sambot-viz-rays") for name in threads)
    large.click_down(5.0, 5.0)
    large.client.wait_until(lambda: large.selected == [])


def test_of_many_clicks_that_wait_only_the_last_is_followed(
    large: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    go_on, followed = threading.Event(), list[float]()
    first_hit = PickSnapshot.first_hit

    def slow(self: PickSnapshot, origin: Any, *rest: Any) -> Any:
        followed.append(float(origin[0]))
        assert go_on.wait(patience(20.0))
        return first_hit(self, origin, *rest)

    monkeypatch.setattr(PickSnapshot, "first_hit", slow)
    large.click_down(5.0, 5.0)
    large.client.wait_until(lambda: len(followed) == 1)
    for number in range(20):
        large.click_down(number / 100, 0.2)
    go_on.set()
    large.client.wait_until(lambda: large.selected == ["base_link"])
    assert followed == [5.0, 0.19]


def write_flat_mesh(path: Path, side: int) -> int:
    """Write a square of 2 m as a binary STL; returns its number of triangles."""
    at = np.linspace(-1.0, 1.0, side + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(at[:-1], at[:-1]))
    step = at[1] - at[0]
    triangles = np.zeros(
        2 * len(x), [("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("attributes", "<u2")]
    )
    for first, corners in (
        (0, ((0, 0), (1, 0), (1, 1))),
        (1, ((0, 0), (1, 1), (0, 1))),
    ):
        for corner, (dx, dy) in enumerate(corners):
            triangles["at"][first::2, corner, 0] = x + dx * step
            triangles["at"][first::2, corner, 1] = y + dy * step
    header = bytes(80) + len(triangles).to_bytes(4, "little")
    path.write_bytes(header + triangles.tobytes())
    return len(triangles)


FACET = """facet normal 0 0 1
outer loop
vertex -1 -1 0
vertex 1 -1 0
vertex 0 1 0
endloop
endfacet
"""
