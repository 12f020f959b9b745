"""Each mistake of students is named at its line, with the cause and the fix."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from quick_yaml import quick_yaml

from sambot_viz import Problem, check

WRONG = Path(__file__).parents[2] / "data" / "sdf" / "wrong"
ENTRIES: list[dict[str, Any]] = quick_yaml(WRONG / "index.yaml")

CODES = {
    "joint-pose-without-relative-to.sdf": "sdf-pose-cycle",
    "urdf-origin.sdf": "sdf-urdf-habit",
    "urdf-parent-link.sdf": "sdf-urdf-habit",
    "urdf-box-size.sdf": "sdf-urdf-habit",
    "urdf-material.sdf": "sdf-urdf-habit",
    "first-link-not-root.sdf": "sdf-root-not-canonical",
    "relative-to-typo.sdf": "sdf-frame-unknown",
    "model-pose.sdf": "sdf-model-pose",
    "visual-without-name.sdf": "attribute-missing",
    "script-without-uri.sdf": "sdf-script",
    "world-file.sdf": "sdf-world",
    "wheel-macro-twice.sdf": "sdf-name-taken",
}


def serious(problems: list[Problem]) -> list[Problem]:
    return [problem for problem in problems if problem.severity != "info"]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["file"])
def test_a_mistake_is_named_with_its_line_its_cause_and_its_fix(
    entry: dict[str, Any],
) -> None:
    problems = serious(check(WRONG / entry["file"]))

    problem = problems[0]
    assert problem.code == CODES[entry["file"]]
    assert (problem.severity, problem.line) == (entry["severity"], entry["line"])
    assert problem.hint.startswith(entry["fix"])
    said = set(re.findall(r"\w+", problem.message))
    cause = set(re.findall(r"\w+", entry["cause"]))
    assert len(said & cause) >= 0.7 * len(cause), problem.message


Edit = Callable[[str, str], str]
"""The text with the mistake and what the hint says → the text without it."""


def put(old: str) -> Edit:
    """The fix in place of these words."""

    def edit(text: str, fix: str) -> str:
        assert text.count(old) == 1
        return text.replace(old, fix)

    return edit


def both_poses(text: str, fix: str) -> str:
    joint, link = fix.split(", and ")
    text = put('<origin xyz="0.08 0 0.06" rpy="0 0 0"/>')(text, joint)
    lidar = '<link name="lidar">'
    return put(lidar)(text, lidar + link.removesuffix(" in the link lidar"))


FIXES: dict[str, Edit] = {
    "joint-pose-without-relative-to.sdf": put("<pose>0.08 0 0.06 0 0 0</pose>"),
    "urdf-origin.sdf": both_poses,
    "urdf-box-size.sdf": put('<box size="${length} ${width} 0.06"/>'),
    "urdf-material.sdf": lambda text, fix: put('<color rgba="0.1 0.2 0.5 1"/>')(
        text, fix.replace(" and ", "")
    ).replace('<material name="blue">', "<material>"),
    "first-link-not-root.sdf": lambda text, fix: put('<model name="mbot">')(
        text, fix.partition(", or")[0]
    ),
    "relative-to-typo.sdf": put("lidar_jiont"),
    "model-pose.sdf": lambda text, fix: text.replace("<pose>0 0 0.07 0 0 0</pose>", ""),
    "visual-without-name.sdf": put("<visual>"),
    "script-without-uri.sdf": lambda text, fix: re.sub(
        r"<script>.*</script>", fix.rpartition(" by ")[2], text, flags=re.DOTALL
    ),
    "wheel-macro-twice.sdf": lambda text, fix: put('side="left" y="${-')(
        text, f'{fix} y="${{-'
    ),
}


@pytest.mark.parametrize("name", FIXES)
def test_what_the_fix_says_leaves_no_problem(name: str, tmp_path: Path) -> None:
    (problem,) = serious(check(WRONG / name))
    model = tmp_path / name
    fix = problem.hint.removeprefix("write ")
    model.write_text(FIXES[name]((WRONG / name).read_text(), fix))

    assert serious(check(model)) == []


def test_both_ends_written_as_in_urdf_are_fixed_one_by_one(tmp_path: Path) -> None:
    name = "urdf-parent-link.sdf"
    text = (WRONG / name).read_text()
    for problem in serious(check(WRONG / name)):
        fix = problem.hint.removeprefix("write ")
        tag = fix[1 : fix.index(">")]
        text = re.sub(rf"<{tag} link=[^>]*/>", fix, text)
    model = tmp_path / name
    model.write_text(text)

    assert serious(check(model)) == []
