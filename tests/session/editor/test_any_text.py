"""Whatever is written as the model's text, the last robot that loaded stays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import problem_samples
import pytest
from inside import session_of
from patience import patience

from sambot_viz import RobotError, Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.editor.model_text import ModelText

GOOD = '<robot name="good">\n<link name="hull"/>\n</robot>\n'
HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
HOSTILE = {
    "empty": "",
    "blank": " \n\n",
    "zero": "\0<robot",
    "binary": "".join(map(chr, range(256))),
    "no character": "<robot>\ufffe\uffff\u2028\u202e</robot>",
    "large": f"{GOOD[:-9]}{'<link/>' * 20_000}</robot>",
    "deep": "<a>" * 20_000,
    "comment": f"<!--{GOOD}",
    "entities": '<!DOCTYPE a [<!ENTITY b "bb">]><robot name="&b;"><link name="l"/>',
    "endless": f'{HEAD}<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>'
    "</robot>",
    "itself": f'{HEAD}<xacro:include filename="robot.urdf"/></robot>',
    "other file": f'{HEAD}<xacro:include filename="/etc/passwd"/></robot>',
    "code": f"{HEAD}<link name=\"${{open('/etc/passwd').read()}}\"/></robot>",
}


@pytest.fixture
def viz(tmp_path: Path) -> Iterator[Visualizer]:
    model = tmp_path / "robot.urdf"
    model.write_text(GOOD)
    with Visualizer.of_inputs(Inputs(Options(model, watch=False))) as viz:
        yield viz


@pytest.fixture
def model_text(viz: Visualizer, tmp_path: Path) -> Iterator[ModelText]:
    model, session = tmp_path / "robot.urdf", session_of(viz)

    def load(
        model: Path,
        trusted: bool,
        texts: Mapping[str, str],
        arguments: Mapping[str, str],
    ) -> Robot:
        return load_robot(model, trusted=trusted, edited=texts, xacro_args=arguments)

    text = ModelText(
        ModelFiles(model, load),
        session.robot,
        session.checks,
        session.problems,
        session.saved,
        session.show_edited,
        session.change,
    )
    yield text
    text.close()


def shown(viz: Visualizer, model_text: ModelText, text: str) -> Robot:
    """The robot after the text of the model was replaced."""
    session = session_of(viz)
    with session.lock:
        buffer = model_text.buffer("robot.urdf")
        units = len(buffer.text.encode("utf-16-le")) // 2
        version = buffer.version
        model_text.replace("robot.urdf", version, 0, units, text, more=False)
    assert model_text.wait(patience(30.0))
    assert not session.problems.of_saves
    assert session.robot.model is not None
    return session.robot.model


def loads(path: Path, text: str) -> bool:
    try:
        load_robot(path, trusted=False, edited={str(path): text})
    except RobotError:
        return False
    return True


def texts(*, expanded: bool) -> dict[str, str]:
    """Hostile texts, and models of the problems that the program knows.

    Args:
        expanded: those that xacro has to expand, which takes longer.
    """
    samples = {
        sample.code: content
        for sample in problem_samples.all_samples()
        if isinstance(content := sample.files.get(sample.name), str)
        and sample.name.endswith((".urdf", ".xacro", ".sdf"))
        and "<" in content
    }
    return {
        name: text
        for name, text in {**HOSTILE, **samples}.items()
        if ("xacro" in text) is expanded
    }


@pytest.mark.parametrize(
    "expanded", [False, pytest.param(True, marks=pytest.mark.slow)]
)
def test_no_text_takes_the_last_robot_away(
    viz: Visualizer, model_text: ModelText, tmp_path: Path, expanded: bool
) -> None:
    model, session = tmp_path / "robot.urdf", session_of(viz)
    last = "good"
    for name, text in texts(expanded=expanded).items():
        robot = shown(viz, model_text, text)
        listed = session.problems.shown.value.listed
        if text != GOOD and loads(model, text):
            last = robot.name
            assert not session.problems.of_text, name
        else:
            # It says why, at a place that the text has.
            assert any(p.severity == "error" for p in listed), name
            lines = text.count("\n") + 1
            assert all((p.line or 1) <= lines for p in session.problems.of_text or ())
        assert robot.name == last, name
        assert model.read_text() == GOOD
    assert shown(viz, model_text, GOOD).name == "good"
    assert session.problems.of_text is None and not session.own_model
