"""Tasks with an arm of meshes, and with the links of robots."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from ax_tree import Thing
from desk import Desk
from judge import on_page
from PIL import Image
from robots import ARM_LINKS
from viewer_page import ViewerPage

from sambot_viz import FrameError

pytestmark = pytest.mark.browser

FIRST, SECOND = "upper_joint", "lower_joint"


def enter(viewer: ViewerPage, joint: str, text: str) -> None:
    viewer.user.enter(viewer.user.row("Joints", joint).one("textbox"), text)


def number(viewer: ViewerPage, joint: str) -> float:
    return float(viewer.user.row("Joints", joint).one("textbox").value)


def save_pose(desk: Desk, name: str) -> None:
    desk.user.click("button", "Poses")
    desk.user.enter(desk.user.find("textbox", "Name of the pose"), name)
    desk.user.find("button", f"Remove pose {name}")
    desk.user.keys("Escape")


def take_pose(desk: Desk, name: str) -> None:
    desk.user.click("button", "Poses")
    desk.user.click("button", name)


def test_task_61_two_poses_of_an_arm_while_another_watches(
    make_desk: Callable[[str], Desk],
) -> None:
    a = make_desk("A")
    other = a.open()
    save_pose(a, "home")
    for joint, value in ((FIRST, 0.5), (SECOND, -0.75)):
        enter(a.viewer, joint, str(value))
        other.user.until(lambda j=joint, v=value: number(other, j) == v)
    save_pose(a, "reach")
    take_pose(a, "home")
    for joint in (FIRST, SECOND):
        a.user.until(lambda j=joint: a.viz.joint_positions[j] == 0.0)
        other.user.until(lambda j=joint: number(other, j) == 0.0)
    take_pose(a, "reach")
    for joint, value in ((FIRST, 0.5), (SECOND, -0.75)):
        a.user.until(lambda j=joint, v=value: a.viz.joint_positions[j] == v)
        other.user.until(lambda j=joint, v=value: number(other, j) == v)
    # One undo for the whole of a pose.
    a.user.click("button", "Undo")
    a.user.until(lambda: set(a.viz.joint_positions.values()) == {0.0})


@pytest.mark.view
def test_task_61_the_way_to_a_pose_and_its_ghost(
    make_desk: Callable[[str], Desk],
) -> None:
    a = make_desk("A")
    other, motion = a.open(), a.session.motion
    save_pose(a, "home")
    enter(a.viewer, FIRST, "0.5")
    a.user.until(lambda: a.viz.joint_positions[FIRST] == 0.5)
    save_pose(a, "reach")
    # The test takes the steps: halfway both pages show the arm on its way.
    motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    take_pose(a, "home")
    a.user.until(lambda: motion.moving)
    motion.advance(0.15)
    for viewer in (a.viewer, other):
        viewer.user.until(lambda v=viewer: number(v, FIRST) == 0.25)
    motion.advance(0.15)
    for viewer in (a.viewer, other):
        viewer.user.until(lambda v=viewer: number(v, FIRST) == 0.0)
    # The ghost of a pose is in the page of the one who asks for it.
    a.user.click("button", "Poses")
    assert (ghosts(a.viewer), ghosts(other)) == (0, 0)
    ghost = a.user.find("button", "Show reach as ghost")
    a.user.click_on(ghost)
    a.user.until(lambda: ghosts(a.viewer) == len(ARM_LINKS))
    assert ghosts(other) == 0
    assert number(a.viewer, FIRST) == 0.0
    a.user.click("button", "Show reach as ghost")
    a.user.until(lambda: ghosts(a.viewer) == 0)


def ghosts(viewer: ViewerPage) -> int:
    """How many shapes of a ghost the view has."""
    return int(viewer.page.evaluate(_GHOSTS))


_GHOSTS = """(() => {
  let count = 0;
  __viserMutable.scene.traverse(object => {
    if (object.isMesh && object.material?.color?.getHex?.() === 0x55aaff) count += 1;
  });
  return count;
})()"""


@pytest.mark.view
def test_task_62_the_distances_of_all_that_is_selected(a: Desk) -> None:
    a.user.click_on(a.user.row("Displays", "Grid").one("checkbox"))
    a.user.until(lambda: not a.user.row("Displays", "Grid").one("checkbox").is_on)
    look_along_y(a)
    a.user.tab("Selection")
    a.choose_tool("Select")
    left, top, width, height = a.page.evaluate(
        "(r => [r.x, r.y, r.width, r.height])"
        "(__viserMutable.canvas.getBoundingClientRect())"
    )
    a.page.mouse.drag((left + 20, top + 20), (left + width - 20, top + height - 20))
    a.user.click("button", "Copy Distances")
    a.user.until(lambda: a.user.clipboard.count("\n") == len(ARM_LINKS))
    _, *lines = (line.split() for line in a.user.clipboard.split("\n"))
    names = [line[1] for line in lines]
    assert set(names) == set(ARM_LINKS)
    for line in lines:
        for name, shown in zip(names, line[2:], strict=True):
            at = a.viz.frames.lookup(line[1], name).translation
            length = float((at @ at) ** 0.5)
            assert shown == ("-" if name == line[1] else f"{length:.4g}")


def look_along_y(desk: Desk) -> None:
    """Look at the middle of the arm from a side."""
    for name, value in (
        ("Focal Point", "0; 0; 0.6"),
        ("Distance", "3"),
        ("Yaw", "1.5708"),
        ("Pitch", "0"),
    ):
        field = desk.user.row("Views", "Current View", name).one("textbox")
        desk.user.enter(field, value)
    desk.settle()


@pytest.mark.view
def test_task_63_measure_between_two_meshes(a: Desk) -> None:
    look_along_y(a)
    a.choose_tool("Measure")
    # On the sides of cubes that face the view, each before the origin of its frame.
    a.page.mouse.click(*on_page(a, 0.0, 0.05, 0.3))
    a.user.reads("second point")
    a.page.mouse.click(*on_page(a, 0.0, 0.05, 0.9))
    a.user.reads("0.6 m from upper to hand.")


def test_task_64_hide_all_links_but_one(a: Desk) -> None:
    def is_on(link: str) -> bool:
        return row(link).one("checkbox").is_on

    def row(link: str) -> Thing:
        return a.user.row("Displays", "RobotModel", "Links", link)

    a.user.unfold("Displays", "RobotModel")
    a.user.unfold("Displays", "RobotModel", "Links")
    # Two clicks.
    a.user.click_on(row("All Links Enabled").one("checkbox"))
    a.user.until(lambda: not is_on("hand"))
    a.user.click_on(row("hand").one("checkbox"))
    a.user.until(lambda: [n for n in ARM_LINKS if is_on(n)] == ["hand"])
    for _ in range(2):
        a.user.click("button", "Undo")
    a.user.until(lambda: all(map(is_on, ARM_LINKS)))


def test_task_65_a_second_robot_from_a_file(a: Desk) -> None:
    user = a.user
    other = a.folder / "other.urdf"
    other.write_text('<robot name="o"><link name="post"/></robot>', "utf-8")
    frames = set(a.viz.frames.frames)
    user.click("button", "Add", ("region", "Displays"))
    user.click("option", re.compile("^RobotModel"))
    user.enter(user.find("textbox", "Name", ("dialog", "Add Display")), "Second")
    user.gone("dialog")
    second = "Displays", "Second"
    user.until(lambda: user.row(*second).state("expanded"))
    source = user.row(*second, "Description Source").one("combobox")
    user.choose(source, "File")
    user.until(
        lambda: user.row(*second, "Description Source").one("combobox").value == "File"
    )
    # A file that is not there is refused, with the folders that count.
    field = user.row(*second, "Description File").one("textbox")
    user.enter(field, "nofile.urdf")
    said = f"the folders that were opened: {a.folder.name}"
    # The status says so too, perhaps before the refusal is there.
    user.until(lambda: said in user.row(*second, "Description File").one("alert").text)
    # Escape ends the refusal, which lies over the field.
    user.keys("Escape")
    user.until(lambda: not user.row(*second, "Description File").all("alert"))
    user.enter(user.row(*second, "TF Prefix").one("textbox"), "b")
    user.enter(
        user.until(lambda: user.row(*second, "Description File").one("textbox")),
        str(other),
    )
    user.until(lambda: set(a.viz.frames.frames) == {*frames, "b/post"})
    user.until(lambda: "Error" in user.row("Displays", "Second", "Status").text)
    user.tab("Frames")
    user.click("button", "Add static transform …")
    form = "form", "Static transform"
    user.enter(user.find("combobox", "Parent", form), ARM_LINKS[0], end="")
    user.enter(user.find("textbox", "x", form), "50 cm", end="")
    user.enter(user.find("textbox", "Child", form), "b/post", end="")
    user.click("button", "Add", form)
    user.until(lambda: place(a) == pytest.approx((0.5, 0.0, 0.0)))
    user.until(lambda: "Ok" in user.row("Displays", "Second", "Status").text)
    user.click("button", "Add static transform …")


def place(desk: Desk) -> tuple[float, ...]:
    """Where the second robot is; nowhere until a transform joins it to the first."""
    try:
        found = desk.viz.frames.lookup(ARM_LINKS[0], "b/post")
    except FrameError:
        return ()
    return tuple(float(v) for v in found.translation)


@pytest.mark.view
def test_task_74_a_picture_of_a_robot_with_meshes(a: Desk) -> None:
    a.viewer.set_resolution(1.0)
    a.user.until(lambda: a.user.row("Displays", "TF").one("checkbox").is_on)
    a.user.menu("File", re.compile("^Save Image"))
    for side, size in (("Width", "1280"), ("Height", "720")):
        a.user.enter(a.user.find("spinbutton", side), size, end="")
    a.user.click("button", "Save", ("dialog", "Save Image"))
    file = a.user.until(lambda: [*a.downloads.glob("*.png")], 30.0)[0]
    with Image.open(file) as image:
        assert image.size == (1280, 720)
        colors = image.convert("RGB").getcolors(1280 * 720)
    assert colors is not None
    # The grid, the arm with its lit sides, and the names, none of them blurred away.
    assert len(colors) > 50
    file.unlink()
