from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

import sambot_viz
from sambot_viz.checks.registry import RULES
from sambot_viz.checks.rules_page import PAGE, rules_page
from sambot_viz.checks.samples import Sample, all_samples, problems_of
from sambot_viz.robot.xml.diagnose.lexer import SlipKind

CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)+")
TELLING = {
    "Problem",
    "_add",
    "_problem",
    "_refusal",
    "error",
    "fail",
    "info",
    "mesh_error",
    "problem",
    "reject",
    "report",
    "warn",
}


@pytest.mark.parametrize("sample", all_samples(), ids=lambda sample: sample.code)
def test_every_code_has_a_model_that_gives_it(sample: Sample) -> None:
    problems = problems_of(sample.code)

    own = [p for p in problems if p.code == sample.code]
    assert own, problems
    assert all(p.message and p.hint for p in own)
    assert not own[0].message.endswith(".")


def test_no_code_stands_twice() -> None:
    codes = [sample.code for sample in all_samples()]

    assert len(codes) == len(set(codes))


def patterns_in(node: ast.expr) -> Iterator[str]:
    """The codes that an argument can be, as a regular expression."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        if CODE.fullmatch(node.value):
            yield re.escape(node.value)
    elif isinstance(node, ast.JoinedStr):
        parts = [
            re.escape(str(part.value)) if isinstance(part, ast.Constant) else "x"
            for part in node.values
        ]
        if CODE.fullmatch("".join(parts).replace("\\", "")):
            yield "".join("[a-z-]+" if part == "x" else part for part in parts)


def told_in(file: Path) -> Iterator[str]:
    """Patterns of the codes that a module tells."""
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in TELLING:
                for argument in node.args[:4]:
                    yield from patterns_in(argument)
        elif isinstance(node, ast.Tuple) and len(node.elts) >= 3:
            # A row of a table of sentences, not a list of words.
            texts = [e.value for e in node.elts if isinstance(e, ast.Constant)]
            if any(" " in text for text in texts if isinstance(text, str)):
                for element in node.elts[:2]:
                    yield from patterns_in(element)


def test_every_code_in_the_program_has_a_row() -> None:
    root = Path(sambot_viz.__file__).parent
    files = [*root.glob("robot/**/*.py"), *root.glob("checks/*.py")]
    codes = {sample.code for sample in all_samples()}

    told = {pattern for file in files for pattern in told_in(file)}

    assert len(told) > 100
    assert [p for p in sorted(told) if not any(re.fullmatch(p, c) for c in codes)] == []
    assert {f"xml-{kind}" for kind in get_args(SlipKind)} <= codes


def test_every_rule_has_its_own_code_and_tells_why() -> None:
    assert len({rule.code for rule in RULES}) == len(RULES)
    assert all(rule.why and rule.title for rule in RULES)


def test_what_ros_accepts_is_never_called_an_error() -> None:
    assert {rule.severity for rule in RULES} == {"warning", "info"}


def test_the_page_of_rules_is_what_the_rules_say() -> None:
    page = rules_page()

    assert PAGE.read_text("utf-8") == page, "run python -m sambot_viz.checks.rules_page"
    assert all(f"{sample.code}" in page for sample in all_samples())
