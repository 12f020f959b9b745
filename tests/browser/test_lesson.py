"""The Lesson panel: a student reads a step, tries, gets a hint, and mends the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from inside import session_of
from lesson_files import BASE
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options

pytestmark = pytest.mark.browser

RIGHT = (
    '<robot name="sam_bot"><link name="base_link"><visual><geometry>'
    '<box size="0.42 0.31 0.18"/></geometry></visual></link></robot>'
)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    file = tmp_path / "robot.urdf"
    file.write_text("")
    return file


@pytest.fixture
def viz(model: Path) -> Iterator[Visualizer]:
    study = Study(open_lesson(BASE), model.parent)
    options = Options(model, edit=True, watch=True, look="rviz", study=study)
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        yield viz


def test_a_step_is_tried_mended_and_left_for_the_next_one(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    user = viewer.user
    user.reads("What has to hold")
    user.reads("the model cannot be read: the file is empty")
    # The text to write is beside it.
    viewer.wait_for("document.querySelector('.model .text')")
    user.click("button", "Check")
    user.reads("Hint 1")
    model.write_text(RIGHT)
    user.reads("All holds.")
    user.reads("2 of 5 points")
    user.click("button", "Next")
    user.reads("2. A wheel")
    user.click("tab", "Displays")
    viewer.wait_for("document.querySelector('.panel.displays')")
    user.click("tab", "Lesson")
    user.click("button", "Back")
    user.reads("1. The body")


def test_in_a_narrow_window_a_mistake_leaves_the_lesson_and_the_text_in_front(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url, width=1024, height=768)
    user = viewer.user
    # The file to begin with is empty, which is an error.
    user.reads("the model cannot be read")
    chosen = "[...document.querySelectorAll('[role=tab][aria-selected=true]')]"
    assert viewer.page.evaluate(f"{chosen}.map((tab) => tab.innerText)") == ["Lesson"]
    user.click("tab", "Model")
    viewer.wait_for("document.querySelector('.model .cm-line')")
    model.write_text(RIGHT)
    user.until(lambda: session_of(viz).robot.model is not None)
    model.write_text(RIGHT.replace("</robot>", ""))
    viewer.wait_for("document.querySelector('.model .cm-lintRange-error')")
    assert viewer.page.evaluate("document.querySelector('.model .cm-line') !== null")
