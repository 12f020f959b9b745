"""A lesson in the page: a student mends a file, checks a step, and goes on."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from lesson_files import BASE
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.progress import PROGRESS_FILE
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options

RIGHT = (
    '<robot name="sam_bot"><link name="base_link"><visual><geometry>'
    '<box size="0.42 0.31 0.18"/></geometry></visual></link></robot>'
)
WRONG = RIGHT.replace("0.18", "0.2")


class Desk:
    """A student with a page and a folder."""

    def __init__(self, viz: Visualizer, client: ProtocolClient, folder: Path) -> None:
        self.viz, self.client, self.folder = viz, client, folder
        client.settle(viser_server(viz))
        self.until_outcomes()

    def value(self, name: str) -> Any:
        return self.client.rows.get(f"lesson/{name}", {}).get("value")

    def until_outcomes(self) -> None:
        self.client.wait_until(lambda: (self.value("state") or {}).get("outcomes"))

    def write(self, text: str, name: str = "robot.urdf") -> None:
        (self.folder / name).write_text(text)

    @property
    def faults(self) -> list[str]:
        outcomes = self.value("state")["outcomes"] or ()
        return [one["text"] for one in outcomes if not one["holds"]]

    @property
    def passed(self) -> list[bool]:
        return [step["passed"] for step in self.value("steps")["steps"]]

    def check(self) -> None:
        tries = self.value("state")["tries"]
        self.client.act("lesson/check")
        self.client.wait_until(
            lambda: self.value("state")["tries"] > tries or self.passed[0]
        )

    def refused(self, command: str, *values: object) -> str:
        """What the page is told of a command that is not taken."""
        number = (self.client.rows["notice"].get("value") or {}).get("number", 0)
        self.client.act(command, *values)
        notice = self.client.rows["notice"]
        self.client.wait_until(
            lambda: (
                (self.client.rows["notice"].get("value") or {}).get("number", 0)
                > number
            )
        )
        notice = self.client.rows["notice"]
        return str(notice["value"]["text"])


@pytest.fixture
def learn(tmp_path: Path, protocol: Callable[..., ProtocolClient]) -> Iterator[Any]:
    with ExitStack() as stack:

        def start(text: str = "", lesson: Path = BASE) -> Desk:
            folder = tmp_path / "mine"
            folder.mkdir(exist_ok=True)
            study = Study(open_lesson(lesson), folder)
            model = folder / "robot.urdf"
            model.write_text(text)
            options = Options(model, watch=True, edit=True, study=study)
            inputs = Inputs(options, may_be_broken=True)
            viz = stack.enter_context(Visualizer.of_inputs(inputs))
            return Desk(viz, protocol(viz.viser.get_port()), folder)

        yield start


Learn = Callable[..., Desk]


def test_a_save_brings_the_tick_and_counts_no_try(learn: Learn) -> None:
    desk = learn()
    assert desk.value("text")["title"] == "The body"
    assert desk.faults == ["the model cannot be read: the file is empty"]
    desk.write(WRONG)
    desk.client.wait_until(lambda: any("0.42 0.31 0.2" in one for one in desk.faults))
    assert desk.value("state")["tries"] == 0
    desk.write(RIGHT)
    desk.client.wait_until(lambda: desk.passed == [True, False])
    desk.client.wait_until(lambda: not desk.faults)
    said = [one["text"] for one in desk.value("state")["outcomes"]]
    assert said == ["robot", "shape: base_link", "no errors"]
    assert '"passed": true' in (desk.folder / PROGRESS_FILE).read_text()
    # The next step is shown when the student goes there.
    assert desk.value("steps")["shown"] == 1
    desk.client.act("lesson/show", 2)
    desk.client.wait_until(lambda: desk.value("text")["title"] == "A wheel")
    desk.until_outcomes()
    assert any("drivewhl_l_joint" in one for one in desk.faults)


def test_a_step_that_holds_while_another_one_is_read_counts_at_once(
    learn: Learn,
) -> None:
    desk = learn(RIGHT)
    desk.client.wait_until(lambda: desk.passed == [True, False])
    assert desk.value("state")["also"] == []
    wheel = """<link name="base_footprint"/><joint name="f" type="fixed">
    <parent link="base_link"/><child link="base_footprint"/>
    <origin xyz="0 0 -0.15"/></joint>
    <link name="drivewhl_l_link"><visual><geometry><sphere radius="0.1"/></geometry>
    </visual></link>
    <joint name="drivewhl_l_joint" type="continuous"><parent link="base_link"/>
    <child link="drivewhl_l_link"/><origin xyz="-0.12 0.18 -0.05"/>
    <axis xyz="0 1 0"/></joint></robot>"""
    desk.write(RIGHT.replace("</robot>", wheel))
    desk.client.wait_until(lambda: desk.passed == [True, True])
    assert desk.value("steps")["shown"] == 1
    desk.client.wait_until(lambda: desk.value("state")["also"] == [2])
    desk.client.act("lesson/show", 2)
    desk.client.wait_until(lambda: desk.value("state")["also"] == [])


def test_what_is_wrong_with_the_whole_model_has_its_place_once(learn: Learn) -> None:
    desk = learn(RIGHT.replace("</robot>", ""))
    desk.until_outcomes()
    (outcome,) = desk.value("state")["outcomes"]
    assert outcome["place"] == "robot.urdf:1"
    assert "never closed" in outcome["text"] and "robot.urdf" not in outcome["text"]


def test_a_check_counts_a_try_and_brings_the_hints(learn: Learn) -> None:
    desk = learn(WRONG)
    assert desk.value("hints") == [] and desk.value("state")["hint_in"] == 1
    desk.check()
    desk.client.wait_until(lambda: len(desk.value("hints")) == 1)
    assert desk.value("state")["hint_in"] == 2
    desk.client.wait_until(lambda: not desk.value("state")["checking"])
    # A Check while one goes on is none.
    for tries in (2, 3):
        desk.check()
        desk.client.wait_until(lambda n=tries: desk.value("state")["tries"] == n)
        desk.client.wait_until(lambda: not desk.value("state")["checking"])
    desk.client.wait_until(lambda: len(desk.value("hints")) == 2)
    (block,) = desk.value("hints")[1]
    assert block["lines"][0][1] == ['<box size="0.42 0.31 0.18"/>', "code", ""]


def test_what_is_typed_in_the_page_counts_when_it_is_saved(learn: Learn) -> None:
    desk = learn(WRONG)
    client = desk.client
    client.act("model/show", True)
    client.wait_until(lambda: client.rows.get("model/text", {}).get("value"))
    at = WRONG.index("0.2")
    client.act("model/type", "robot.urdf", 0, at, at + 3, "0.18", False)
    client.wait_until(lambda: not desk.faults)
    assert desk.passed == [False, False]
    client.act("model/save", "robot.urdf")
    client.wait_until(lambda: desk.passed == [True, False])


def test_a_new_file_in_the_folder_is_seen(learn: Learn, tmp_path: Path) -> None:
    lesson = tmp_path / "lesson"
    shutil.copytree(BASE, lesson)
    text = (lesson / "lesson.yaml").read_text()
    asked = "    conditions:\n      - file: {name: launch/go.launch.py}\n"
    text = text.replace("    conditions:\n", asked, 1)
    (lesson / "lesson.yaml").write_text(text)
    desk = learn(RIGHT, lesson)
    assert len(desk.faults) == 1 and "launch/go.launch.py" in desk.faults[0]
    (desk.folder / "launch").mkdir()
    desk.write("", "launch/go.launch.py")
    desk.client.wait_until(lambda: desk.passed == [True, False])


@pytest.mark.parametrize(
    ("command", "values"),
    [
        ("lesson/show", (3,)),
        ("lesson/show", (0,)),
        ("lesson/show", ("wheel",)),
        ("lesson/show", (1.5,)),
        ("lesson/show", (True,)),
        ("lesson/check", (1,)),
    ],
)
def test_what_no_page_of_ours_sends_is_refused(
    learn: Learn, command: str, values: tuple[object, ...]
) -> None:
    desk = learn(WRONG)
    assert desk.refused(command, *values)
    assert desk.value("steps")["shown"] == 1 and desk.value("state")["tries"] == 0


def test_the_last_robot_stays_while_the_file_is_wrong(learn: Learn) -> None:
    desk = learn(RIGHT)
    desk.write("<robot")
    desk.client.wait_until(lambda: desk.faults)
    assert "cannot be read" in desk.faults[0]
    robot = session_of(desk.viz).robot.model
    assert robot is not None and set(robot.links) == {"base_link"}


def test_a_picture_of_the_lesson_comes_with_its_text(
    learn: Learn, tmp_path: Path
) -> None:
    lesson = tmp_path / "lesson"
    shutil.copytree(BASE, lesson)
    text = (lesson / "lesson.yaml").read_text()
    (lesson / "lesson.yaml").write_text(
        text.replace(
            "text: Write a box", "text: |\n      ![a box](box.svg)\n\n      Write a box"
        )
    )
    (lesson / "box.svg").write_text("<svg/>")
    desk = learn(WRONG, lesson)
    picture = desk.value("text")["blocks"][0]
    assert picture["text"] == "a box"
    assert picture["data"] == "data:image/svg+xml;base64,PHN2Zy8+"


def test_progress_that_cannot_be_kept_is_told(learn: Learn) -> None:
    desk = learn(WRONG)
    (desk.folder / PROGRESS_FILE).mkdir()
    desk.check()
    desk.client.wait_until(lambda: desk.value("state")["trouble"])
    assert desk.value("state")["trouble"].startswith("the progress cannot be kept: ")


def test_the_view_and_the_text_follow_the_file_of_a_step(
    learn: Learn, tmp_path: Path
) -> None:
    lesson = tmp_path / "lesson"
    shutil.copytree(BASE, lesson)
    text = (lesson / "lesson.yaml").read_text()
    own = "title: A wheel\n    model: wheel.urdf"
    (lesson / "lesson.yaml").write_text(text.replace("title: A wheel", own))
    desk = learn(RIGHT, lesson)
    desk.write(RIGHT.replace("base_link", "wheel"), "wheel.urdf")
    session = session_of(desk.viz)

    def shows(link: str) -> bool:
        robot = session.robot.model
        return robot is not None and set(robot.links) == {link}

    def opened(name: str) -> bool:
        content = desk.client.rows["model/text"].get("value") or {}
        return content.get("file") == name

    desk.client.act("model/show", True)
    desk.client.wait_until(lambda: shows("base_link") and opened("robot.urdf"))
    desk.client.act("lesson/show", 2)
    desk.client.wait_until(lambda: shows("wheel") and opened("wheel.urdf"))
    # A save of that file is followed, also after a mistake.
    desk.write("<robot", "wheel.urdf")
    desk.client.wait_until(lambda: bool(session.problems.of_text))
    assert shows("wheel")
    desk.write(RIGHT.replace("base_link", "tyre"), "wheel.urdf")
    desk.client.wait_until(lambda: shows("tyre") and not session.problems.of_text)
    # Back again, the server's model is followed as before.
    desk.client.act("lesson/show", 1)
    desk.client.wait_until(lambda: shows("base_link") and opened("robot.urdf"))
    desk.write(RIGHT.replace("base_link", "hull"))
    desk.client.wait_until(lambda: shows("hull"))
    assert not session.own_model


@pytest.mark.parametrize("fixes", [True, False])
def test_a_lesson_may_keep_the_fixes_of_problems_away(
    learn: Learn, tmp_path: Path, fixes: bool
) -> None:
    lesson = tmp_path / "lesson"
    shutil.copytree(BASE, lesson)
    text = (lesson / "lesson.yaml").read_text()
    (lesson / "lesson.yaml").write_text(f"fixes: {str(fixes).lower()}\n{text}")
    slip = RIGHT.replace("<visual>", "<visul>").replace("</visual>", "</visul>")
    desk = learn(slip, lesson)
    problems = session_of(desk.viz).problems.shown
    desk.client.wait_until(
        lambda: not problems.value.checking and bool(problems.value.listed)
    )
    assert any(problem.edits for problem in problems.value.listed) is fixes


def test_each_text_is_loaded_once(learn: Learn) -> None:
    """The view, the lesson, and what follows the saved file take the same robot."""
    desk = learn(WRONG)
    client, session = desk.client, session_of(desk.viz)
    sessions, model = desk.viz.server.sessions, desk.folder / "robot.urdf"

    def known() -> object:
        text = sessions.model_text
        assert text is not None
        with session.lock:
            return text.known(model, text.texts, True)

    client.act("model/show", True)
    client.wait_until(lambda: "model/text" in client.rows)
    assert known() is None
    at = WRONG.index("0.2")
    client.act("model/type", "robot.urdf", 0, at, at + 3, "0.18", False)
    client.wait_until(lambda: not desk.faults)
    robot = session.robot.model
    assert robot is not None and known() is robot
    client.act("model/save", "robot.urdf")
    # What follows the files takes it too.
    client.wait_until(lambda: sessions.robot is robot)
    assert known() is robot
    # What another program saves is read.
    desk.write(WRONG)
    client.wait_until(lambda: any("0.42 0.31 0.2" in one for one in desk.faults))
    assert known() is None and session.robot.model is not robot
