"""Grades in the formats of those who ask for them."""

from __future__ import annotations

import json
from xml.etree import ElementTree

from sambot_viz.lessons.evaluation import StepResult
from sambot_viz.lessons.grading import Grade
from sambot_viz.lessons.writers import WRITERS

GRADE = Grade(
    "l",
    (
        StepResult(1, "a", "The body", 2.0, 2.0, ""),
        StepResult(2, "b", "Wheels & <more>", 0.0, 3.0, 'one "is" <x>\ntwo\x1b[0m'),
    ),
)
REFUSED = Grade("l", (StepResult(1, "a", "A", 0.0, 2.0, "no"),), "the model is no XML")


def test_json_has_the_fixed_names() -> None:
    said = json.loads(WRITERS["json"](GRADE))
    assert list(said) == ["lesson", "passed", "score", "max_score", "steps"]
    assert (said["passed"], said["score"], said["max_score"]) == (False, 2.0, 5.0)
    assert list(said["steps"][0]) == [
        "name",
        "passed",
        "points",
        "max_points",
        "message",
    ]


def test_junit_is_xml_that_counts_failures() -> None:
    suite = ElementTree.fromstring(WRITERS["junit"](GRADE))
    assert suite.attrib == {"name": "l", "tests": "2", "failures": "1"}
    assert [case.attrib["name"] for case in suite] == ["a", "b"]
    failure = suite[1][0]
    assert failure.tag == "failure"
    assert failure.attrib["message"] == 'one "is" <x>\ntwo\ufffd[0m'


def test_gradescope_has_a_score_for_each_test() -> None:
    tests = json.loads(WRITERS["gradescope"](GRADE))["tests"]
    assert [(t["number"], t["score"], t["max_score"], t["status"]) for t in tests] == [
        ("1", 2.0, 2.0, "passed"),
        ("2", 0.0, 3.0, "failed"),
    ]
    assert {t["output_format"] for t in tests} == {"text"}


def test_prairielearn_has_a_share_and_points() -> None:
    said = json.loads(WRITERS["prairielearn"](GRADE))
    assert (said["gradable"], said["score"]) == (True, 0.4)
    assert [(t["points"], t["max_points"]) for t in said["tests"]] == [(2, 2), (0, 3)]


def test_a_model_that_cannot_be_read_costs_no_attempt_in_prairielearn() -> None:
    assert json.loads(WRITERS["prairielearn"](REFUSED)) == {
        "gradable": False,
        "format_errors": ["the model is no XML"],
    }
