"""What docs/lessons.md shows is accepted, and true."""

from __future__ import annotations

import json
import re
from pathlib import Path

import yaml
from lesson_files import lesson_of

from sambot_viz.lessons.read_lesson import lesson_names

TEXT = (Path(__file__).parents[2] / "docs" / "lessons.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


def test_the_example_of_conditions_is_read(tmp_path: Path) -> None:
    (example,) = (b for b in blocks("yaml") if b.startswith("conditions:\n"))
    lines = [line.removeprefix("  ") for line in example.splitlines()[1:]]
    # What is hidden needs a hint, which the example does not have.
    shown = [line for line in lines if "hidden" not in line]
    (step,) = lesson_of(tmp_path, "\n".join(shown)).steps
    assert len(step.conditions) == 4


def test_files_of_others_are_yaml_json_and_scripts() -> None:
    assert all(yaml.safe_load(text) for text in blocks("yaml"))
    assert all(json.loads(text) for text in blocks("json"))
    assert all(text.startswith("#!/") for text in blocks("sh"))


def test_the_lessons_that_ship_are_named() -> None:
    assert all(f"- *{name}*:" in TEXT for name in lesson_names())
