"""The Model panel: a model is written in the page, and the robot follows."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from inside import session_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

pytestmark = pytest.mark.browser

GOOD = """<robot name="r">
<link name="hull"/>
<link name="arm"/>
<joint name="a" type="fixed"><parent link="hull"/><child link="arm"/></joint>
</robot>
"""

SHOWN = "document.querySelector('.model .cm-content')?.innerText.includes('hull')"
"""The editor is empty at first, and has its text then."""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    file = tmp_path / "r.urdf"
    file.write_bytes(GOOD.replace("\n", "\r\n").encode())
    return file


@pytest.fixture
def viz(model: Path) -> Iterator[Visualizer]:
    options = Options(model, edit=True, watch=True, look="rviz")
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        yield viz


def middle_of(viewer: ViewerPage, selector: str) -> tuple[float, float]:
    box = viewer.page.evaluate(
        f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])"
        f"(document.querySelector('{selector}').getBoundingClientRect())"
    )
    return box[0], box[1]


def test_a_mistake_is_marked_as_it_is_typed_and_its_fix_mends_the_text(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    user, page = viewer.user, viewer.page
    asked = "codemirror.js"
    assert not any(asked in url for url in page.requests)
    user.click("tab", "Model")
    viewer.wait_for(SHOWN)
    assert sum(asked in url for url in page.requests) == 1

    # The cursor goes behind link="hull; a letter is taken away.
    page.evaluate("document.querySelector('.model .cm-content').focus()")
    user.keys("Control+Home", *["ArrowDown"] * 3, *["ArrowRight"] * 47, "Backspace")
    viewer.wait_for("document.querySelector('.model .cm-lintRange-error')")
    line = page.evaluate(
        "document.querySelector('.model .cm-lintRange-error')"
        ".closest('.cm-line').textContent"
    )
    assert 'link="hul"' in line
    robot = session_of(viz).robot.model
    assert robot is not None and set(robot.links) == {"hull", "arm"}
    page.mouse.move(*middle_of(viewer, ".model .cm-lintRange-error"))
    viewer.wait_for("document.querySelector('.model .cm-diagnosticAction')")
    page.mouse.click(*middle_of(viewer, ".model .cm-diagnosticAction"))
    viewer.wait_for("!document.querySelector('.model .cm-lintRange-error')")
    assert model.read_bytes() == GOOD.replace("\n", "\r\n").encode()

    user.keys("Control+End", "ArrowUp")
    page.keyboard.insert('<link name="leg"/>')
    page.keyboard.insert(
        '<joint name="b" type="fixed"><parent link="arm"/><child link="leg"/></joint>'
    )
    user.until(lambda: "leg" in getattr(session_of(viz).robot.model, "links", {}))
    # Where the config has no changes, the text is meant from everywhere.
    user.click("tab", "Model")
    user.keys("Control+s")
    user.reads("Saved r.urdf")
    written = model.read_bytes()
    assert b'<link name="leg"/>' in written and written.count(b"\r\n") == 5
    user.find("button", re.compile("Download"))

    # Completion has the words that the checks know, and the names of the model.
    page.evaluate("document.querySelector('.model .cm-content').focus()")
    user.keys("Control+Home", "ArrowDown")
    page.keyboard.type("<jo")
    offered = "document.querySelector('.cm-tooltip-autocomplete')"
    viewer.wait_for(f"{offered}?.innerText.includes('joint')")


def test_what_another_program_has_changed_too_is_chosen_and_undone(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    user, page = viewer.user, viewer.page
    user.click("tab", "Model")
    viewer.wait_for(SHOWN)
    focus = "document.querySelector('.model .cm-content').focus()"
    page.evaluate(focus)
    user.keys("Control+Home", "ArrowDown", "End")
    line = "document.querySelector('.model .cm-activeLine')?.textContent"
    viewer.wait_for(f"{line}.includes('name=\"hull\"')")
    page.keyboard.insert("<!-- mine -->")
    viewer.wait_for(f"{line}.endsWith('<!-- mine -->')")
    user.reads("Not saved")
    # The same line, and others, of which nobody is asked.
    model.write_text(GOOD.replace("hull", "body"))
    user.reads("changed lines that are changed here too")
    viewer.wait_for("document.querySelectorAll('.cm-conflict').length === 1")
    text = "document.querySelector('.model .cm-content').innerText"
    assert "<!-- mine -->" in page.evaluate(text)
    user.click("button", "Take the saved text")
    viewer.wait_for("!document.querySelector('.conflict, .cm-conflict')")
    viewer.wait_for(f"{text}.includes('link name=\"body\"/>\\n')")
    page.evaluate(focus)
    user.keys("Control+z")
    viewer.wait_for(f"{text}.includes('<!-- mine -->')")
    user.reads("Not saved")
    user.click("button", "Revert")
    viewer.wait_for(f"!{text}.includes('<!-- mine -->')")
    page.evaluate(focus)
    user.keys("Control+z")
    viewer.wait_for(f"{text}.includes('<!-- mine -->')")


WITH_NUMBERS = """<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">
<xacro:property name="tilt" value="0"/>
<xacro:property name="reach" value="0.20"/>
<link name="hull"/>
<link name="arm"/>
<joint name="a" type="fixed"><parent link="hull"/><child link="arm"/>
<origin xyz="${reach} 0 0" rpy="0 ${tilt} 0"/></joint>
</robot>
"""


def test_a_number_is_moved_by_keys_and_written_so_that_the_editor_undoes_it(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    file = tmp_path / "r.urdf.xacro"
    file.write_text(WITH_NUMBERS)
    options = Options(file, edit=True, watch=True, look="rviz")
    with Visualizer.of_inputs(Inputs(options)) as viz:
        viewer = open_viewer(viz.url)
        user, page = viewer.user, viewer.page

        def x() -> float:
            robot = session_of(viz).robot.model
            assert robot is not None
            return round(robot.joints["a"].origin.xyz[0], 6)

        user.click("tab", "Model")
        user.find("slider", "reach")
        viewer.wait_for(SHOWN)
        page.evaluate(
            "document.querySelector('[type=range][aria-label=reach]').focus()"
        )
        user.keys("ArrowRight", "ArrowRight")
        user.until(lambda: x() == 0.202)
        text = "document.querySelector('.model .cm-content').innerText"
        assert 'value="0.20"' in page.evaluate(text)
        # The robot is there before the page is told of it.
        user.reads("1 moved, not in the text")
        user.click("button", "Write into the text")
        viewer.wait_for(f"{text}.includes('value=\"0.202\"')")
        user.reads("Not saved")
        page.evaluate("document.querySelector('.model .cm-content').focus()")
        user.keys("Control+z")
        viewer.wait_for(f"{text}.includes('value=\"0.20\"')")
        user.until(lambda: x() == 0.2)
        user.keys("Control+y", "Control+s")
        user.reads("Saved r.urdf.xacro")
        assert 'name="reach" value="0.202"' in file.read_text()
        # Without xacro, as ROS gets it.
        user.click("tab", "Expanded")
        viewer.wait_for("document.querySelectorAll('.model .cm-content').length == 2")
        viewer.wait_for(
            "[...document.querySelectorAll('.model .cm-content')]"
            ".some((one) => one.innerText.includes('xyz=\"0.202 0 0\"'))"
        )
