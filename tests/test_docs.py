"""The documents say what the program does."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import lesson_page
import limits_page
import manual_page
import pytest
from command_line_page import PAGE, page, parser_of
from tests.benchmarks.peers import report, results

from sambot_viz.cli import COMMANDS
from sambot_viz.flags import declared, flag_of
from sambot_viz.options import Options
from sambot_viz.visualizer import Visualizer

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("README.md", "docs/guide.md", "docs/lessons.md", "docs/python.md")


def written_commands() -> list[str]:
    """Every line in README and guide that calls the program, as a user types it."""
    text = "".join((ROOT / name).read_text("utf-8") for name in PAGES)
    blocks = re.findall(r"```(?:sh|console|text)\n(.*?)```", text, re.DOTALL)
    joined = "\n".join(blocks).replace("\\\n", " ")
    lines = [line.removeprefix("$ ") for line in joined.split("\n")]
    return [line for line in lines if line.startswith("sambot-viz ")]


def test_the_page_of_the_command_line_is_that_of_the_parsers() -> None:
    assert PAGE.read_text("utf-8") == page(), (
        "run: PYTHONPATH=tests/support python tests/support/command_line_page.py"
    )


def test_the_manual_page_is_that_of_the_parsers() -> None:
    assert manual_page.PAGE.read_text("utf-8") == manual_page.page(), (
        "run: PYTHONPATH=tests/support python tests/support/manual_page.py"
    )


def test_the_table_of_conditions_is_that_of_the_classes() -> None:
    assert lesson_page.PAGE.read_text("utf-8") == lesson_page.page(), (
        "run: PYTHONPATH=tests/support python tests/support/lesson_page.py"
    )


def test_the_page_of_limits_is_that_of_the_table() -> None:
    assert limits_page.PAGE.read_text("utf-8") == limits_page.page(), (
        "run: PYTHONPATH=tests/support python tests/support/limits_page.py"
    )


def test_the_readme_calls_the_program() -> None:
    assert len(written_commands()) >= 6


@pytest.mark.parametrize("line", written_commands())
def test_a_command_line_of_the_documents_is_accepted(line: str) -> None:
    words = shlex.split(line, comments=True)[1:]
    command = words.pop(0) if words[0] in COMMANDS else "show"
    parser_of(command).parse_args([word for word in words if ":=" not in word])


def test_every_option_is_documented_for_python_users() -> None:
    doc = Visualizer.__doc__ or ""
    for option in declared(Options):
        assert f"    {option.name}: " in doc
        assert flag_of(option).help


def test_the_examples_for_python_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (ROOT / "docs" / "python.md").read_text("utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 5
    (tmp_path / "assets").symlink_to(ROOT / "assets")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    try:
        exec(compile("\n".join(blocks), "docs/python.md", "exec"), names)
    finally:
        if "viz" in names:
            names["viz"].stop()
    assert (tmp_path / "robot.html").stat().st_size > 100_000


def test_links_of_the_documents_lead_to_files() -> None:
    for name in (
        *PAGES,
        "docs/deploy.md",
        "docs/first-robot.md",
        "docs/install.md",
        "docs/live.md",
        "docs/ros2.md",
        "docs/troubleshooting.md",
        "docs/viser.md",
        ".github/CONTRIBUTING.md",
        ".github/SECURITY.md",
        "CHANGELOG.md",
    ):
        document = ROOT / name
        for link in re.findall(r"\]\(([^)#]+)", document.read_text("utf-8")):
            if not link.startswith("http"):
                assert (document.parent / link).exists(), f"{name}: {link}"


def test_the_site_has_each_page_of_the_documentation() -> None:
    text = (ROOT / ".github" / "mkdocs.yml").read_text("utf-8")
    listed = set(re.findall(r"^ +- .*: (\S+\.md)$", text, re.MULTILINE))
    made = {"index.md", "reference.md", "CHANGELOG.md"}
    ours = {name for name in listed - made if not name.startswith("github/")}
    assert ours == {path.name for path in (ROOT / "docs").glob("*.md")}


def test_nothing_advises_a_package_that_no_index_has() -> None:
    """Anybody could take the name. The first release takes this test away."""
    folders = [ROOT / name for name in ("docs", "src", "deploy", "assets", ".github")]
    files = [path for folder in folders for path in folder.rglob("*.*")]
    advised = re.compile(r"pip3? install [^`\n]*")
    for path in [ROOT / "README.md", *files]:
        if path.suffix in (".md", ".py", ".js", ".yaml", ".yml", ".1"):
            for line in advised.findall(path.read_text("utf-8")):
                words = [word.strip("\"'\\") for word in line.split()]
                assert not [w for w in words if w.startswith("sambot-viz")], path


def test_the_rooms_of_the_contributors_map_exist() -> None:
    text = (ROOT / ".github" / "CONTRIBUTING.md").read_text("utf-8")
    rows = re.findall(r"^\| (`\w+/`.*?) \|", text, re.MULTILINE)
    rooms = {room for row in rows for room in re.findall(r"`(\w+)/`", row)}
    package = ROOT / "src" / "sambot_viz"
    assert rooms == {path.parent.name for path in package.glob("*/__init__.py")}


@pytest.mark.parametrize(
    ("name", "written"),
    [("README.md", report.short_table), ("docs/benchmarks.md", report.for_docs)],
)
def test_figures_beside_peers_are_those_of_the_run_that_is_kept(
    name: str, written: Callable[[results.Results], Iterator[str]]
) -> None:
    kept = results.read(ROOT / "docs" / "benchmarks" / "benchmarks.json")
    document = (ROOT / name).read_text("utf-8")
    assert report.with_figures(document, written(kept)) == document, (
        "run: python -m tests.benchmarks --docs"
    )
