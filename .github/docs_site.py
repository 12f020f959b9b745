"""Hooks of mkdocs: the site has the files outside of docs/ that its pages lead to."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[1]
_LINK = re.compile(r"\]\((?!\w+:|#)([^)#\s]+)(#[^)\s]*)?\)")
_PAGES = ("README.md", "CHANGELOG.md", ".github/CONTRIBUTING.md", ".github/SECURITY.md")


def on_files(files: Files, config: Any) -> Files:
    """Add the reference of Python, and what pages link to."""
    files.append(File.generated(config, "reference.md", content=_reference()))
    wanted = {ROOT / name for name in _PAGES}
    for page in (*wanted, *(ROOT / "docs").glob("*.md")):
        links = _LINK.findall(page.read_text("utf-8"))
        wanted |= {Path(os.path.normpath(page.parent / link)) for link, _ in links}
    for path in sorted(wanted):
        if path.is_file() and not path.is_relative_to(ROOT / "docs"):
            files.append(File.generated(config, _in_site(path), abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Let links lead to where their files are in the site."""
    source = Path(page.file.abs_src_path or ROOT / "docs" / page.file.src_uri)
    here = Path(page.file.src_uri).parent

    def moved(found: re.Match[str]) -> str:
        target = Path(os.path.normpath(source.parent / found[1]))
        if not target.is_file():
            return found[0]
        link = Path(os.path.relpath(_in_site(target), here)).as_posix()
        return f"]({link}{found[2] or ''})"

    return _LINK.sub(moved, markdown)


def _in_site(path: Path) -> str:
    """Return the place of a file of the repository in the site."""
    below = path.relative_to(ROOT).as_posix()
    if below == "README.md":
        return "index.md"
    return below.removeprefix("docs/").removeprefix(".")


def _reference() -> str:
    """Return the page of the public names, from their docstrings."""
    text = (ROOT / "src" / "sambot_viz" / "__init__.py").read_text("utf-8")
    names = re.findall(r"^    from (\S+) import (\w+) as \w+$", text, re.MULTILINE)
    parts = "\n".join(f"::: {home}.{name}\n" for home, name in sorted(names))
    return f"# Python reference\n\nThe names of `sambot_viz`.\n\n{parts}"
