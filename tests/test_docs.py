"""The documents say what the program does."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import docs
import pytest
from docs import Part
from docs_parts import quotes
from docs_parts.command_line_page import parser_of

from sambot_viz.cli import COMMANDS
from sambot_viz.export.browser_process import find_browser
from sambot_viz.flags import declared, flag_of
from sambot_viz.options import Options
from sambot_viz.visualizer import Visualizer

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("README.md", "docs/guide.md", "docs/lessons.md", "docs/python.md")
NOTHING_SAID = re.compile(
    r"^.*\b(?:says|prints|answers):\n\s*(?:\Z|```\w*\n```|> *$|(?!>|```|\||[-*] ).+)",
    re.MULTILINE,
)
"""What announces a quotation, and what follows it when there is none."""


def written_commands() -> list[str]:
    """Every line in README and guide that calls the program, as a user types it."""
    text = "".join((ROOT / name).read_text("utf-8") for name in PAGES)
    blocks = re.findall(r"```(?:sh|console|text)\n(.*?)```", text, re.DOTALL)
    joined = "\n".join(blocks).replace("\\\n", " ")
    lines = [line.removeprefix("$ ") for line in joined.split("\n")]
    return [line for line in lines if line.startswith("sambot-viz ")]


def marks(part: Part) -> list[pytest.MarkDecorator]:
    missing = part.browser and find_browser() is None
    skip = pytest.mark.skipif(missing, reason="needs a Chromium or Chrome")
    return [pytest.mark.browser, skip] if part.browser and part.files else []


@pytest.mark.parametrize(
    ("part", "file"),
    [
        pytest.param(part, file, id=f"{name}-{file}", marks=marks(part))
        for name, part in docs.PARTS.items()
        for file in (*part.files, *part.pictures)
    ],
)
def test_what_the_documents_show_is_what_the_program_makes(
    part: Part, file: str
) -> None:
    fault = "\n".join(part.faults(file))
    assert not fault, f"{fault}\nrun: python tests/support/docs.py --write"


def test_every_picture_and_quotation_has_a_part_that_makes_it() -> None:
    made = {name for part in docs.PARTS.values() for name in part.pictures}
    made |= {name for part in docs.PARTS.values() for name in part.files}
    quoting = {"docs/first-robot.md", "docs/problems.md"}
    for document in docs.documents():
        name, text = document.relative_to(ROOT).as_posix(), document.read_text("utf-8")
        for picture in re.findall(r"\]\(([^)]+\.(?:png|svg|webp|gif|jpe?g))\)", text):
            path = (document.parent / picture).resolve()
            assert path.relative_to(ROOT).as_posix() in made, f"{name}: {picture}"
        assert name in quoting or not re.search("^> ", text, re.MULTILINE), name


@pytest.mark.parametrize("document", docs.documents(), ids=lambda path: path.name)
def test_what_announces_a_quotation_has_one(document: Path) -> None:
    assert NOTHING_SAID.findall(document.read_text("utf-8")) == []


def test_an_announcement_without_a_quotation_is_found() -> None:
    for quoted in ("> `a`\n", "```text\na\n```\n", "- a\n", "| a |\n"):
        assert not NOTHING_SAID.search(f"`check` says:\n\n{quoted}")
    for empty in ("", "## 9.\n", "**A name.** It\n", "> \n", "```text\n```\n"):
        assert NOTHING_SAID.search(f"`check` says:\n\n{empty}")


@pytest.mark.parametrize("before", ["", "a\n", None])
def test_a_stale_an_empty_and_a_missing_file_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: str | None
) -> None:
    monkeypatch.setattr(docs, "ROOT", tmp_path)
    part = Part({"page.md": lambda _: "b\n"})
    if before is not None:
        (tmp_path / "page.md").write_text(before)
    assert len(list(part.faults("page.md"))) == 1
    part.write()
    assert list(part.faults("page.md")) == []


def test_an_answer_that_nothing_runs_is_refused_and_a_lost_one_comes_back() -> None:
    echo = 'echo a b --static-transform "0 0 0 0 0 0 a b"'
    shown = f"```console\n$ sambot-viz {echo}\nAt time 0.0\n```\n"
    with pytest.raises(ValueError, match="nothing runs 'sambot-viz echo a b"):
        quotes.refreshed("docs/other.md", shown)
    readme = (ROOT / "README.md").read_text("utf-8")
    start = readme.index("$ sambot-viz check")
    command, end = readme.index("\n", start) + 1, readme.index("```", start)
    assert quotes.refreshed("README.md", readme[:command] + readme[end:]) == readme
    with pytest.raises(ValueError, match="has no block with"):
        quotes.refreshed("README.md", readme[:start] + readme[end:])


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
