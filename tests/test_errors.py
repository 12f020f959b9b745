"""The tree of errors, and the sentence that offers a valid name."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

import pytest
from work import calls_of

from sambot_viz import RobotError, errors, load_robot
from sambot_viz.errors import did_you_mean


def public_errors(repository: Path) -> dict[str, str]:
    """Every error class that may leave the package: name → its public base."""
    bases: dict[str, str] = {}
    for path in sorted((repository / "src").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef):
                for base in node.bases:
                    if isinstance(base, ast.Name):
                        bases.setdefault(node.name, base.id)

    def public_base(name: str) -> str:
        base = bases.get(name, "")
        return public_base(base) if base.startswith("_") else base

    def is_ours(name: str) -> bool:
        return name == "SambotVizError" or (name in bases and is_ours(bases[name]))

    return {
        name: public_base(name)
        for name in bases
        if not name.startswith("_") and name != "SambotVizError" and is_ours(name)
    }


def drawn_tree() -> dict[str, str]:
    """The tree in the docstring of `errors`: name → the name it is drawn below."""
    above = ["SambotVizError"]
    drawn: dict[str, str] = {}
    for line in (errors.__doc__ or "").splitlines():
        match = re.match(r"    ([│├└─ ]+)(\w+)  ", line)
        if match:
            depth = len(match[1]) // 4
            drawn[match[2]] = above[depth - 1]
            above[depth:] = [match[2]]
    return drawn


def test_the_tree_shows_every_error_that_may_leave_the_package(
    repository: Path,
) -> None:
    assert drawn_tree() == public_errors(repository)


def test_the_nearest_name_is_offered_or_all_names_are_listed() -> None:
    assert did_you_mean("base_lnk", ["base_link"]) == "did you mean 'base_link'?"
    assert did_you_mean("x", ["base_link", "wheel"]) == "known: 'base_link', 'wheel'"
    assert did_you_mean("x", []) == "there are none"
    many = did_you_mean("x", [f"link_{n}" for n in range(9)])
    assert many.endswith("'link_7', …")


def test_a_name_that_is_asked_again_costs_nothing_anew() -> None:
    """A display whose topic is missing asks at each picture."""
    topics = [f"/robot/sensor_{n}/points" for n in range(300)]

    def ask() -> None:
        assert "'/robot/sensor_7/points'" in did_you_mean(
            "/robot/sensr_7/points", topics
        )

    assert calls_of(ask) > 20 * calls_of(ask)


def test_a_notebook_shows_the_line_of_the_user_and_the_message(tmp_path: Path) -> None:
    script = tmp_path / "cell.py"
    script.write_text("def look(path):\n    return load_robot(path)\n", "utf-8")
    names: dict[str, Any] = {"load_robot": load_robot}
    exec(compile(script.read_text("utf-8"), str(script), "exec"), names)
    with pytest.raises(RobotError) as caught:
        names["look"](tmp_path / "no.urdf")
    here, *rest = caught.value._render_traceback_()
    assert here.endswith('names["look"](tmp_path / "no.urdf")')
    assert rest == [
        "line 2: return load_robot(path)",
        f"RobotError: {caught.value}",
    ]
