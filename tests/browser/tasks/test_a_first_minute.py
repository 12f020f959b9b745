"""Tasks of the first minute: start, mistakes, help, a status."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from desk import Desk
from program import address, running
from recorded_page import open_page
from user import User
from viewer_page import viewer_url

from sambot_viz import __version__, bundled
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

AT_ONCE = 12.0
A_REMARK = """<robot name="r"><link name="base_link"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
<visual><geometry><box size="0.3 0.3 0.3"/></geometry></visual></link>
<link name="arm"/><joint name="turn" type="continuous"><parent link="base_link"/>
<child link="arm"/></joint></robot>"""


@pytest.fixture
def started(chromium: Chromium, tmp_path: Path) -> Iterator[Callable[[Path], User]]:
    """Start the program with a model, and open the address that it prints."""
    left: list[Callable[[], None]] = []

    def start(model: Path) -> User:
        program = running(str(model), "--port", "0", cwd=tmp_path)
        process = program.__enter__()
        left.append(lambda: program.__exit__(None, None, None) and None)
        page = open_page(chromium)
        left.append(page.close)
        page.goto(viewer_url(address(process), view=False))
        return User(page)

    yield start
    for end in reversed(left):
        end()


def model_with(folder: Path, change: Callable[[str], str]) -> Path:
    """The robot of the program, changed."""
    shutil.copytree(bundled.assets_folder(), folder, dirs_exist_ok=True)
    model = folder / "sam_bot.urdf.xacro"
    model.write_text(change(model.read_text("utf-8")), "utf-8")
    return model


@pytest.mark.view
def test_task_01_the_whole_robot_at_first_sight(own: Desk) -> None:
    own.settle()
    pixels = own.viewer.pixels()[..., :3].astype(int)
    height, width, _ = pixels.shape
    # Grid and background are grey, the robot is not.
    colourful = pixels.max(axis=-1) - pixels.min(axis=-1) > 40
    rows, columns = np.nonzero(colourful)
    assert rows.max() - rows.min() > height / 3
    assert rows.min() > 5 and rows.max() < height - 5
    assert columns.min() > 5 and columns.max() < width - 5
    assert "*" not in own.user.see().name


def test_task_02_start_with_a_mistake(
    started: Callable[[Path], User], tmp_path: Path
) -> None:
    model = model_with(tmp_path, lambda text: text.replace("</robot>", "</rob>"))
    lines = model.read_text("utf-8").splitlines()
    line = next(n for n, text in enumerate(lines, 1) if "</rob>" in text)
    user = started(model)
    user.reads(f"{model.name}:{line}")
    for said in ("is closed by </rob>", "write </robot>", f" {line} "):
        user.until(lambda s=said: s in re.sub(r"\s+", " ", user.see().text))
    # A status leads to the lines, also when the list is closed.
    user.click("button", "Close Problems")
    user.gone("treegrid", "Problems")
    user.unfold("Displays", "RobotModel")
    button = user.row("Displays", "RobotModel", "Status", "Model").one("button")
    assert button.name == f"Show line {line}"
    user.click_on(button)
    user.until(lambda: f" {line} " in re.sub(r"\s+", " ", problems(user)))
    model.write_text(model.read_text("utf-8").replace("</rob>", "</robot>"), "utf-8")
    user.row("Joints", "drivewhl_l_joint")
    user.find("button", "No problems")


def problems(user: User) -> str:
    """The text of the open list of problems."""
    return user.see().one("treegrid", "Problems").text


def test_task_03_what_is_wrong_if_anything(make_desk: Callable[[str], Desk]) -> None:
    user = make_desk(A_REMARK).user
    count = user.find("button", re.compile("^Problems: 1 warning"))
    assert user.can_see(count)
    assert not user.there("treegrid", "Problems")
    _, _, _, before = user.box(user.find("treegrid", "Joints"))
    user.click_on(count)
    user.find("treegrid", "Problems")
    user.reads("moment of inertia")
    height = pytest.approx(before, abs=2)
    user.until(lambda: user.box(user.find("treegrid", "Joints"))[3] == height)
    user.click("button", re.compile("^Problems: 1 warning"))
    user.gone("treegrid", "Problems")


def test_task_04_which_keys_and_which_version(s: Desk) -> None:
    s.user.menu("Help", "Keys")
    text = s.user.find("dialog", "Keys").text
    for said in ("Measure", "Undo", "undo", "wheel", "Ctrl+S"):
        assert said.lower() in text.lower(), said
    s.user.click("button", "Close", ("dialog", "Keys"))
    s.user.menu("Help", "About")
    s.user.until(lambda: __version__ in s.user.find("dialog", re.compile("About")).text)
    s.user.keys("Escape")
    s.user.gone("dialog")


def test_task_05_a_link_without_a_joint(
    started: Callable[[Path], User], tmp_path: Path
) -> None:
    joint = re.compile(r'<joint name="caster_joint".*?</joint>', re.DOTALL)
    model = model_with(tmp_path, lambda text: joint.sub("", text))
    user = started(model)
    user.until(lambda: user.there("button", re.compile("^Problems: .*error")))
    # The grid is there before its rows.
    for said in ("front_caster", rf"{model.name}:\d+", "joint"):
        user.until(lambda s=said: re.search(s, user.find("treegrid", "Problems").text))


def test_task_06_copy_a_status(s: Desk) -> None:
    user = s.user
    options = "Displays", "Global Options", "Fixed Frame"
    user.enter(user.row(*options).one("combobox"), "map")
    status = "Displays", "Global Status", "Fixed Frame"
    user.until(lambda: "does not exist" in user.row(*status).text)
    # Other statuses come too, and move it.
    s.settle()
    shown = user.row(*status).all("gridcell")[1].all("StaticText")[0]
    user.go_to(shown)
    left, top, width, height = user.box(shown)
    s.page.mouse.drag((left + 1, top + 4), (left + width, top + height - 3))
    user.keys("Control+c")
    user.until(lambda: user.clipboard.startswith("Frame [map] does not"))
    assert user.clipboard in shown.name
