"""What a student has written is graded, as a file of an unknown person."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from lesson_files import BASE
from lower_limit import lower

from sambot_viz import bundled, grade
from sambot_viz.errors import UsageError

SAM_BOT = bundled.model_path()

BODY = """\
<robot name="sam_bot">
  <link name="base_link">
    <visual><geometry><box size="{size}"/></geometry></visual>
  </link>
</robot>
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "robot.urdf"
    file.write_text(text)
    return file


@pytest.mark.parametrize("name", ["sam_bot.urdf.xacro", "sam_bot.sdf"])
def test_a_right_model_passes_all_steps(name: str) -> None:
    found = grade(bundled.model_path(name), BASE)

    assert found.passed
    assert (found.lesson, found.score, found.max_score) == ("base", 5.0, 5.0)
    assert [step.name for step in found.steps] == ["body", "wheel"]


def test_a_wrong_step_says_what_was_found_and_what_was_expected(tmp_path: Path) -> None:
    found = grade(written(tmp_path, BODY.format(size="0.31 0.42 0.18")), BASE)

    body, wheel = found.steps
    assert not found.passed
    assert body.message == (
        "the <visual> of base_link is a box of 0.31 0.42 0.18; "
        "expected: a box of 0.42 0.31 0.18"
    )
    assert (body.points, body.max_points) == (0.0, 2.0)
    assert wheel.message.splitlines()[0] == (
        "there is no joint 'drivewhl_l_joint'; expected: a joint 'drivewhl_l_joint'"
    )


def test_the_answer_of_a_hidden_condition_is_not_said(tmp_path: Path) -> None:
    text = SAM_BOT.read_text("utf-8").replace(
        '"wheel_zoff" value="0.05"', '"wheel_zoff" value="0.08"'
    )
    found = grade(written(tmp_path, text), BASE, step="wheel")

    assert "30 mm off; the last hint says what is expected" in (found.steps[0].message)
    assert "-0.05" not in found.steps[0].message


@pytest.mark.parametrize("step", [1, "1", "body"])
def test_one_step_is_graded_by_its_number_or_name(
    tmp_path: Path, step: int | str
) -> None:
    found = grade(
        written(tmp_path, BODY.format(size="0.42 0.31 0.18")), BASE, step=step
    )

    assert found.passed
    assert [one.name for one in found.steps] == ["body"]


def test_a_folder_is_graded_by_the_model_that_the_lesson_names(tmp_path: Path) -> None:
    written(tmp_path, BODY.format(size="0.42 0.31 0.18"))

    assert grade(tmp_path, BASE, step=1).passed
    (tmp_path / "empty").mkdir()
    assert "there is no such file" in grade(tmp_path / "empty", BASE).refusal


def test_a_model_that_cannot_be_read_fails_every_step_once(tmp_path: Path) -> None:
    found = grade(written(tmp_path, "<robot name='sam_bot'>"), BASE)

    assert all("the model cannot be read" in step.message for step in found.steps)
    assert all("\n" not in step.message for step in found.steps)
    assert "the model cannot be read" in found.refusal


@pytest.mark.parametrize(
    ("path", "lesson", "step", "said"),
    [
        ("missing.urdf", str(BASE), None, "'missing.urdf' does not exist"),
        (str(SAM_BOT), "nav2-frist-robot", None, "no lesson 'nav2-frist-robot'"),
        (str(SAM_BOT), str(BASE), "wheels", "did you mean 'wheel'?"),
        (str(SAM_BOT), str(BASE), 3, "no step 3: its steps are 1 to 2"),
    ],
)
def test_what_does_not_exist_is_a_usage_error(
    path: str, lesson: str, step: int | str | None, said: str
) -> None:
    with pytest.raises(UsageError, match=r".") as raised:
        grade(path, lesson, step=step)
    assert said in str(raised.value)


def test_xacro_of_a_student_reads_no_file_outside_the_folder(tmp_path: Path) -> None:
    secret = tmp_path / "secret.yaml"
    secret.write_text("name: sam_bot\n")
    (tmp_path / "own").mkdir()
    text = (
        '<robot name="sam_bot" xmlns:xacro="http://ros.org/wiki/xacro">'
        f"<link name=\"${{xacro.load_yaml('{secret}')['name']}}\"/></robot>"
    )
    found = grade(written(tmp_path / "own", text), BASE, step=1)

    assert "is outside the model's folder" in found.steps[0].message


def test_a_model_that_takes_too_long_fails_in_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "GRADE_TIME", 2)
    calls = "".join(
        f'<xacro:macro name="m{n}"><xacro:m{n + 1}/><xacro:m{n + 1}/></xacro:macro>'
        for n in range(40)
    )
    text = (
        '<robot name="sam_bot" xmlns:xacro="http://ros.org/wiki/xacro">'
        f'{calls}<xacro:macro name="m40"/><link name="base_link"/><xacro:m0/></robot>'
    )
    found = grade(written(tmp_path, text), BASE)

    assert [step.message for step in found.steps] == [
        "grading took longer than 2 s"
    ] * 2


def test_a_model_that_takes_too_much_memory_fails_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "GRADE_MEMORY", 100)
    text = f"<robot name='sam_bot'><!-- {'x' * 40_000_000} --></robot>"
    found = grade(written(tmp_path, text), BASE)

    assert not found.passed
    assert "memory" in found.steps[0].message or "without a result" in (
        found.steps[0].message
    )


def test_a_large_file_is_graded(tmp_path: Path) -> None:
    comment = f"<!-- {'x' * 5_000_000} -->"
    text = BODY.format(size="0.42 0.31 0.18").replace("</robot>", f"{comment}</robot>")

    assert grade(written(tmp_path, text), BASE, step=1).passed


def test_results_are_json_of_fixed_names(tmp_path: Path) -> None:
    found = grade(written(tmp_path, BODY.format(size="0.42 0.31 0.18")), BASE, step=1)

    assert json.loads(json.dumps(found.as_json())) == {
        "lesson": "base",
        "passed": True,
        "score": 2.0,
        "max_score": 2.0,
        "steps": [
            {
                "name": "body",
                "passed": True,
                "points": 2.0,
                "max_points": 2.0,
                "message": "",
            }
        ],
    }
