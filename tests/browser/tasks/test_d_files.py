"""Tasks with files: configs that are saved and opened, a model with a mistake."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from desk import Desk

pytestmark = pytest.mark.browser

AT_ONCE = 12.0
DIALOG = ("dialog", "Save Config As")


def cell_size(desk: Desk, value: str) -> None:
    """Set something that a config keeps."""
    desk.user.unfold("Displays", "Grid")
    desk.user.enter(desk.user.row("Displays", "Cell Size").one("textbox"), value)
    desk.user.until(lambda: shown_size(desk) == value)
    desk.user.until(lambda: "*" in name_of_config(desk))


def shown_size(desk: Desk) -> str:
    return str(desk.user.row("Displays", "Cell Size").one("textbox").value)


def name_of_config(desk: Desk) -> str:
    """The name in the title of the page, with the mark for changes."""
    return desk.user.see().name.partition(" - ")[0]


def save_as(desk: Desk, name: str) -> None:
    desk.user.menu("File", re.compile("^Save Config As"))
    desk.user.enter(desk.user.find("textbox", "Name", DIALOG), name)


def size_in(file: Path) -> Any:
    document = yaml.safe_load(file.read_text("utf-8"))
    (grid,) = (
        d for d in document["Visualization Manager"]["Displays"] if d["Name"] == "Grid"
    )
    return grid["Cell Size"]


@pytest.fixture
def desk(files: Desk) -> Desk:
    """A desk that only these tasks use: they open other configs."""
    return files


def test_task_32_save_the_config_under_a_new_name(desk: Desk) -> None:
    file = desk.folder / "my look.rviz"
    file.unlink(missing_ok=True)
    cell_size(desk, "0.5")
    desk.user.keys("Control+Shift+s")
    assert str(desk.folder) in desk.user.find(*DIALOG).text
    desk.user.type("my look")
    desk.user.keys("Enter")
    desk.user.gone(*DIALOG)
    desk.user.reads(f"Saved my look.rviz in {desk.folder}")
    desk.user.until(lambda: size_in(file) == 0.5)
    # No letter of the name was the key of a tool.
    assert desk.user.find("button", "Interact", ("toolbar", "Tools")).is_on
    desk.user.until(lambda: desk.user.see().name.startswith("my look.rviz -"))
    other = desk.folder / "of another.rviz"
    other.write_text(file.read_text("utf-8"), "utf-8")
    cell_size(desk, "0.75")
    save_as(desk, "of another")
    desk.user.reads("already exists. Replace it?")
    assert size_in(other) == 0.5
    desk.user.until(lambda: desk.user.find("button", "Cancel", DIALOG).state("focused"))
    desk.user.click("button", "Replace", DIALOG)
    desk.user.gone(*DIALOG)
    desk.user.until(lambda: size_in(other) == 0.75)
    save_as(desk, "in/another/folder")
    desk.user.until(lambda: desk.user.find(*DIALOG).all("alert"))
    desk.user.reads("Enter a name without a folder")
    typed = "in/another/folder"
    desk.user.until(lambda: desk.user.find("textbox", "Name", DIALOG).value == typed)
    desk.user.keys("Escape")
    desk.user.gone(*DIALOG)


def test_task_33_open_that_config_again(desk: Desk) -> None:
    user = desk.user
    cell_size(desk, "0.3")
    user.unfold("Displays", "RobotModel", fold=True)
    user.enter(user.row("Views", "Current View", "Distance").one("textbox"), "2.5")
    user.until(lambda: user.row("Views", "Distance").one("textbox").value == "2.5")
    save_as(desk, "again")
    user.gone(*DIALOG)
    cell_size(desk, "0.9")
    user.unfold("Displays", "Grid", fold=True)
    user.unfold("Displays", "RobotModel")
    user.enter(user.row("Views", "Current View", "Distance").one("textbox"), "7")
    save_as(desk, "other")
    user.gone(*DIALOG)
    cell_size(desk, "0.8")
    user.menu("File", re.compile("^Open"))
    user.find("dialog", "Unsaved changes")
    user.click("button", "Save", ("dialog", "Unsaved changes"))
    user.find("dialog", "Open Config")
    assert size_in(desk.folder / "other.rviz") == pytest.approx(0.8)
    configs = user.find("listbox", "Configs")
    user.choose(configs, "again")
    user.click("button", "Open", ("dialog", "Open Config"))
    user.gone("dialog")
    user.until(lambda: user.row("Displays", "Grid").state("expanded"))
    user.until(lambda: shown_size(desk) == "0.3")
    user.until(lambda: not user.row("Displays", "RobotModel").state("expanded"))
    user.until(lambda: user.row("Views", "Distance").one("textbox").value == "2.5")
    user.until(lambda: name_of_config(desk) == "again.rviz")


@pytest.mark.view
def test_task_34_get_the_config_onto_ones_own_computer(desk: Desk) -> None:
    save_as(desk, "to take away")
    desk.user.gone(*DIALOG)
    desk.user.menu("File", "Download Config")
    file = desk.downloads / "to take away.rviz"
    desk.user.until(file.is_file)
    desk.user.until(lambda: "Visualization Manager" in file.read_text("utf-8"))
    file.unlink()


def test_task_35_save_with_ctrl_s(desk: Desk) -> None:
    save_as(desk, "by key")
    desk.user.gone(*DIALOG)
    cell_size(desk, "0.6")
    # What is typed and not entered yet is saved too.
    desk.user.click_into(desk.user.row("Displays", "Cell Size").one("textbox"))
    desk.user.keys("Control+a")
    desk.user.type("0.7")
    desk.user.keys("Control+s")
    desk.user.until(lambda: size_in(desk.folder / "by key.rviz") == pytest.approx(0.7))
    desk.user.until(lambda: "*" not in name_of_config(desk))


def test_task_36_break_the_model_and_fix_it(desk: Desk) -> None:
    user, joint = desk.user, "drivewhl_l_joint"
    user.enter(user.row("Joints", joint).one("textbox"), "0.5")
    user.until(lambda: desk.viz.joint_positions[joint] == 0.5)
    good = desk.model.read_text("utf-8")
    problems = user.find("button", re.compile("problems|Problems: ")).name
    frames = set(desk.viz.frames.frames)
    desk.model.write_text(good.replace("</robot>", "</rob>"), "utf-8")
    user.until(lambda: user.there("button", re.compile("Problems: 1 error")), AT_ONCE)
    # The list opens by itself.
    user.until(lambda: user.find("button", "Problems: 1 error").state("expanded"))
    user.until(lambda: user.can_see(user.find("treegrid", "Problems")))
    user.reads(f"{desk.model.name}:")
    user.reads("last version that worked")
    extra = good.replace(
        "</robot>",
        '<link name="flag"/><joint name="pole" type="fixed"><parent link="base_link"/>'
        '<child link="flag"/></joint></robot>',
    )
    desk.model.write_text(extra, "utf-8")
    user.until(lambda: set(desk.viz.frames.frames) == {*frames, "flag"}, AT_ONCE)
    user.find("button", problems)
    user.until(lambda: desk.viz.joint_positions[joint] == 0.5)
    user.until(lambda: user.row("Joints", joint).one("textbox").value == "0.5")
    desk.model.write_text(good, "utf-8")
    user.until(lambda: set(desk.viz.frames.frames) == frames, AT_ONCE)


def background(desk: Desk) -> str:
    """The colour behind everything."""
    row = desk.user.row("Displays", "Global Options", "Background Color")
    return str(row.one("textbox").value)


def navigation() -> str:
    """A config of twelve displays, as for a robot that finds its way."""
    kinds = [
        *("Grid", "RobotModel", "TF", "LaserScan", "Map", "Map", "Path", "Path"),
        *("PointCloud2", "Odometry", "MarkerArray", "PoseArray"),
    ]
    displays = [
        {"Class": f"rviz_default_plugins/{k}", "Name": f"{k} {n}", "Enabled": True}
        for n, k in enumerate(kinds, 1)
    ]
    options = {"Background Color": "238; 238; 236", "Fixed Frame": "base_link"}
    view = {"Class": "rviz_default_plugins/Orbit", "Name": "Current View"}
    manager = {
        "Class": "",
        "Displays": displays,
        "Global Options": options,
        "Name": "root",
        "Views": {"Current": view},
    }
    return yaml.safe_dump({"Panels": [], "Visualization Manager": manager})


def test_task_37_open_a_config_of_a_navigation_robot(desk: Desk) -> None:
    desk.folder.joinpath("navigation.rviz").write_text(navigation(), "utf-8")
    save_as(desk, "before")
    desk.user.gone(*DIALOG)
    desk.user.menu("File", re.compile("^Open"))
    desk.user.choose(desk.user.find("listbox", "Configs"), "navigation")
    desk.user.click("button", "Open", ("dialog", "Open Config"))
    desk.user.gone("dialog")
    for name in ("LaserScan 4", "Map 6", "PoseArray 12"):
        desk.user.row("Displays", name)
    desk.user.unfold("Displays", "LaserScan 4")
    desk.user.reads("open a recording or a live robot")
    desk.user.until(lambda: background(desk) == "238; 238; 236")
    desk.user.menu("File", re.compile("^Open"))
    desk.user.choose(desk.user.find("listbox", "Configs"), "before")
    desk.user.click("button", "Open", ("dialog", "Open Config"))
    desk.user.gone("dialog")
    desk.user.until(lambda: background(desk) == "48; 48; 48")


def test_task_38_close_the_page_with_unsaved_changes(
    make_desk: Callable[[str], Desk],
) -> None:
    desk = make_desk("S")
    cell_size(desk, "0.4")
    desk.viewer.page.close()
    desk.viewer = desk.open()
    desk.user.unfold("Displays", "Grid")
    desk.user.until(lambda: shown_size(desk) == "0.4")
    desk.user.until(lambda: "*" in name_of_config(desk))
