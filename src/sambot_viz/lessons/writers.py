"""Writes grades in the formats of other systems."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from xml.sax.saxutils import quoteattr

from sambot_viz.lessons.evaluation import StepResult
from sambot_viz.lessons.grading import Grade
from sambot_viz.text import json_text, line, lines


def _json(grade: Grade) -> str:
    return json_text(grade.as_json())


def _junit(grade: Grade) -> str:
    """Write JUnit's XML, which GitLab, Jenkins and others show."""
    failed = sum(not step.passed for step in grade.steps)
    name = quoteattr(line(grade.lesson))
    head = f'<testsuite name={name} tests="{len(grade.steps)}" failures="{failed}">'
    cases = (_case(name, step) for step in grade.steps)
    begin = '<?xml version="1.0" encoding="UTF-8"?>'
    return "\n".join([begin, head, *cases, "</testsuite>"])


def _case(suite: str, step: StepResult) -> str:
    case = f'  <testcase classname={suite} name={quoteattr(line(step.name))} time="0"'
    if step.passed:
        return f"{case}/>"
    message = quoteattr(lines(step.message), {"\n": "&#10;"})
    return f"{case}>\n    <failure message={message}/>\n  </testcase>"


def _gradescope(grade: Grade) -> str:
    """Write the results.json of a Gradescope autograder."""
    tests = [
        {
            "number": str(step.number),
            "name": step.title,
            "score": step.points,
            "max_score": step.max_points,
            "status": "passed" if step.passed else "failed",
            "output": step.message,
            "output_format": "text",
            "visibility": "visible",
        }
        for step in grade.steps
    ]
    output = f"{grade.lesson}: {_count(grade)}"
    return json_text({"output": output, "output_format": "text", "tests": tests})


def _prairielearn(grade: Grade) -> str:
    """Write the results.json of an external grader of PrairieLearn.

    A model that cannot be read costs no attempt.
    """
    if grade.refusal:
        return json_text({"gradable": False, "format_errors": [grade.refusal]})
    tests = [
        {
            "name": step.title,
            "points": step.points,
            "max_points": step.max_points,
            "message": step.message,
        }
        for step in grade.steps
    ]
    score = grade.score / grade.max_score
    output = {"gradable": True, "score": score, "message": _count(grade)}
    return json_text({**output, "tests": tests})


def _count(grade: Grade) -> str:
    passed = sum(step.passed for step in grade.steps)
    return f"{passed} of {len(grade.steps)} steps hold"


WRITERS: Mapping[str, Callable[[Grade], str]] = {
    "json": _json,
    "junit": _junit,
    "gradescope": _gradescope,
    "prairielearn": _prairielearn,
}
"""Name of the format → its writer; the command itself writes the text for people."""
