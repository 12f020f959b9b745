"""Students' files of every kind are graded without an accident."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.lessons.evaluation import messages
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.student_files import handed_in

LESSON = open_lesson("nav2-first-robot")


def test_no_bad_model_stops_grading(shared: Path) -> None:
    folder = shared / "data" / "bad-models"
    models = sorted([*folder.glob("*.urdf"), *folder.glob("*.xacro")])
    models += sorted(folder.glob("*.sdf"))
    assert len(models) > 40
    for model in models:
        said, _ = messages(LESSON, handed_in(LESSON, model), LESSON.steps)
        assert len(said) == len(LESSON.steps)
        assert said[0], model


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\0" * 1000,
        b"\xff\xfe<\0r\0",
        b"<robot/>" * 10_000,
        b"<robot name='a'>" + b"<link name='b'>" * 5000,
        b"<!DOCTYPE r [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><robot>&b;</robot>",
        b"<sdf version='1.8'/>",
    ],
)
def test_bytes_that_are_no_model_fail_every_step_about_it(
    tmp_path: Path, data: bytes
) -> None:
    model = tmp_path / "sam_bot_description.urdf"
    model.write_bytes(data)
    said, refusal = messages(LESSON, handed_in(LESSON, model), LESSON.steps)
    assert refusal
    assert all(said)


def test_a_link_out_of_the_folder_is_not_read(tmp_path: Path) -> None:
    secret = tmp_path / "ekf.yaml"
    secret.write_text("ekf_filter_node: {ros__parameters: {odom0: secret}}\n")
    own = tmp_path / "own"
    own.mkdir()
    (own / "sam_bot_description.urdf").write_text(
        "<robot name='sam_bot'><link name='base_link'/></robot>"
    )
    (own / "ekf.yaml").symlink_to(secret)
    step = LESSON.step("filter")
    said, _ = messages(LESSON, handed_in(LESSON, own), [step])
    assert "secret" not in said[0]
    assert "the parameter odom0 of ekf_filter_node is not given" in said[0]
