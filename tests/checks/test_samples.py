"""Every code has a sample that gives it, and the page of problems is up to date."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest
from docs_parts.problem_page import refusals
from oracle import CORPORA
from problem_codes import code_patterns
from problem_samples import Sample, all_samples

import sambot_viz
from sambot_viz.robot.xml.diagnose.lexer import LexicalErrorKind


@pytest.mark.parametrize("sample", all_samples(), ids=lambda sample: sample.code)
def test_every_code_has_a_model_that_gives_it(sample: Sample) -> None:
    own = [p for p in sample.problems() if p.code == sample.code]
    assert own, sample.problems()
    assert all(p.message and p.hint for p in own)
    assert not own[0].message.endswith(".")
    assert own[0].line == sample.line
    assert sample.says in own[0].message


def test_the_cause_is_named_in_the_message_of_the_usual_mistakes() -> None:
    assert sum(bool(sample.says) for sample in all_samples()) > 50


def test_no_code_is_listed_twice() -> None:
    codes = [sample.code for sample in all_samples()]
    assert len(codes) == len(set(codes))


def test_every_code_in_the_source_has_a_sample() -> None:
    codes = {sample.code for sample in all_samples()}
    found = code_patterns(Path(sambot_viz.__file__).parent.rglob("*.py"))
    assert len(found) > 150
    unknown = [p for p in found if not any(re.fullmatch(p, c) for c in codes)]
    assert sorted(unknown) == []
    assert {f"xml-{kind}" for kind in get_args(LexicalErrorKind)} <= codes


def test_a_new_code_without_a_sample_would_be_noticed(tmp_path: Path) -> None:
    module = tmp_path / "new.py"
    module.write_text(
        "def complain(code: str): ...\n"
        "complain('new-code')\n"
        "Problem.at(place, 'error', f'{kind}-new', 'text')\n"
        "class Problem:\n    code: str\n"
        "rows = [('an-old-row', 'a sentence', 'a hint')]\n"
        "other = 'not-a-code'\n"
    )
    assert code_patterns([module]) == {r"new\-code", r"[a-z-]+\-new", r"an\-old\-row"}


def test_a_model_that_ros_accepts_is_never_an_error() -> None:
    accepted = [sample for sample in all_samples() if sample.why]
    assert len(accepted) > 12
    assert {sample.problem.severity for sample in accepted} == {"warning", "info"}


def test_every_error_names_the_program_that_it_is_about() -> None:
    """In what is stored of many models, too: a code may be an error in some only."""
    codes = [code for row in refusals() for code in row["codes"].split()]
    assert len(codes) == len(set(codes))
    samples = all_samples()
    assert set(codes) <= {sample.code for sample in samples}
    errors = {s.code for s in samples if s.problem.severity == "error"}
    for corpus in CORPORA:
        told = corpus.file.read_text("utf-8")
        errors.update(re.findall(r" error\[([a-z0-9-]+)\]", told))
    assert errors - set(codes) == set()
