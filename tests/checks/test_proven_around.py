"""Edits of launch files, parameters and build files are tried before they are shown."""

from __future__ import annotations

import ast
import shutil
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from sambot_viz.checks import check
from sambot_viz.checks.around import rules
from sambot_viz.checks.around.files import parameters
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.proven_around import proven_around
from sambot_viz.errors import Edit, Problem, Severity

LAUNCH = "launch/display.launch.py"


def finding(
    code: str, severity: Severity = "error", line: int = 1, *, edits: bool = True
) -> Problem:
    edit = (Edit(f"{code}.yaml", 0, 1, code),) if edits else ()
    return Problem(severity, code, f"{code} is wrong", "", "f.yaml", line, edits=edit)


class Files:
    """Finds what is left after edits, and counts how often it looks.

    Args:
        left: code of the finding whose edits are made → what is found then.
    """

    def __init__(self, left: Mapping[str, list[Problem] | None]) -> None:
        self._left = left
        self.looked = 0

    def __call__(self, edits: tuple[Edit, ...]) -> list[Problem] | None:
        self.looked += 1
        return self._left[edits[0].text]


def told(found: list[Problem]) -> list[tuple[str, bool]]:
    return [(problem.code, bool(problem.edits)) for problem in found]


def test_what_is_gone_after_the_edit_of_another_finding_is_left_out() -> None:
    a, b = finding("a"), finding("b", line=2, edits=False)
    files = Files({"a": []})
    assert told(proven_around([a, b], [a, b], files)) == [("a", True)]
    files = Files({"a": [b]})
    assert told(proven_around([a, b], [a, b], files)) == [("a", True), ("b", False)]


def test_a_finding_that_only_moves_or_has_other_words_stays() -> None:
    a, b = finding("a"), finding("b", line=2)
    moved = Problem("error", "b", "b is wrong in line 3", "", "f.yaml", 3)
    files = Files({"a": [moved], "b": [a]})
    assert told(proven_around([a, b], [a, b], files)) == [("a", True), ("b", True)]


def test_no_error_goes_with_a_remark() -> None:
    a, b = finding("a", "info"), finding("b", line=2, edits=False)
    files = Files({"a": []})
    assert len(proven_around([a, b], [a, b], files)) == 2


@pytest.mark.parametrize(
    "after",
    [
        pytest.param([finding("a")], id="stays"),
        pytest.param([finding("x", line=4, edits=False)], id="new error"),
        pytest.param([finding("x", "warning", 4, edits=False)], id="new warning"),
        pytest.param(None, id="file is broken"),
    ],
)
def test_an_edit_that_makes_nothing_better_is_left_out(
    after: list[Problem] | None,
) -> None:
    a, b = finding("a"), finding("b", line=2, edits=False)
    found = proven_around([a, b], [a, b], Files({"a": after}))
    assert told(found) == [("a", False), ("b", False)]


def test_of_many_findings_only_the_first_are_tried() -> None:
    many = [finding(f"f{number}", line=number) for number in range(30)]
    rest = {p.code: [q for q in many if q is not p] for p in many}
    files = Files(rest)
    assert proven_around(many, many, files) == many
    assert files.looked == 8


@pytest.fixture
def package(repository: Path, tmp_path: Path) -> Path:
    """A right package, for Gazebo."""
    folder = tmp_path / "cart_description"
    shutil.copytree(repository / "tests" / "data" / "around" / "gz", folder)
    return folder


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), "utf-8")


def test_only_the_edited_file_is_parsed_again(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts = {"python": Counter[str](), "yaml": Counter[str]()}
    parse = ast.parse
    loader: Any = parameters._LOADER  # pyright: ignore[reportPrivateUsage]

    def parse_counted(text: Any, *rest: Any, **named: Any) -> Any:
        counts["python"][str(text)] += 1
        return parse(text, *rest, **named)

    def load_counted(text: str) -> Any:
        counts["yaml"][text] += 1
        return loader(text)

    edit(package / "config" / "nav2_params.yaml", "ros__parameters", "ros_parameters")
    edits = [edit for problem in check(package) for edit in problem.edits]
    assert [each.text for each in edits] == ["ros__parameters"]
    monkeypatch.setattr(ast, "parse", parse_counted)
    monkeypatch.setattr(parameters, "_LOADER", load_counted)
    check(package)
    # The edited text is another one.
    assert set(counts["python"].values()) == set(counts["yaml"].values()) == {1}
    files = [*package.rglob("*.yaml"), *package.rglob("*.rviz")]
    assert len(counts["yaml"]) == len(files) + 1


@pytest.mark.parametrize(
    ("file", "right", "wrong"),
    [
        ("config/ekf.yaml", "base_link_frame: base_link", "base_link_frame: base_lnk"),
        ("CMakeLists.txt", "config world\n", "config worldd\n"),
        ("package.xml", "<buildtool_depend>ament", "<buildtool_depends>ament"),
        (LAUNCH, 'executable="rviz2"', 'executable="rviz"'),
    ],
)
def test_an_edit_that_a_rule_takes_back_is_not_offered(
    file: str,
    right: str,
    wrong: str,
    package: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A rule refuses the right text too, so no edit leads out."""
    edit(package / file, right, wrong)
    (sound,) = check(package)
    assert sound.edits

    def never_right(around: Surroundings) -> list[Problem]:
        text = around.files.text(file) or ""
        return [finding("never-right", edits=False)] if right in text else []

    monkeypatch.setattr(rules, "OF_BUILD", (*rules.OF_BUILD, never_right))
    (problem,) = (p for p in check(package) if p.message == sound.message)
    assert problem.hint == sound.hint
    assert problem.edits == ()
