"""Makes what the documents show of the program: answers, options, figures, pictures.

    python tests/support/docs.py                  list what is stale, empty or missing
    python tests/support/docs.py --write          write it again, all but pictures
    python tests/support/docs.py --write PART…    these parts alone

`PARTS` has all of them. The parts "snapshots" and "pictures" need a Chromium or Chrome.
"""

from __future__ import annotations

import argparse
import difflib
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from docs_parts import (
    command_line_page,
    display_table,
    figures,
    first_robot,
    lesson_page,
    limits_page,
    make_pictures,
    manual_page,
    problem_page,
    quotes,
)

ROOT = Path(__file__).resolve().parents[2]
Make = Callable[[str], str]
"""Returns a file as it has to be, given its text of now; "" for a file not there."""


@dataclass(frozen=True, slots=True)
class Part:
    """Something that documents show, and how it is made.

    Attributes:
        files: file, from the root of the repository → its function, which raises
            ValueError where the file has no place for the part.
        pictures: files of which only the presence is looked at.
        script: makes the pictures.
        browser: whether it needs one to be made.
    """

    files: Mapping[str, Make] = field(default_factory=dict[str, Make])
    pictures: Sequence[str] = ()
    script: Callable[[], None] | None = None
    browser: bool = False

    def write(self) -> None:
        """Bring all of it up to date."""
        for name, make in self.files.items():
            path = ROOT / name
            path.write_text(make(_text(path)), "utf-8")
        if self.script is not None:
            self.script()

    def faults(self, name: str) -> Iterable[str]:
        """Yield what is wrong with one of its files."""
        path = ROOT / name
        if not path.is_file() or not path.stat().st_size:
            yield f"{name} is {'empty' if path.is_file() else 'missing'}"
        elif name in self.files:
            text = _text(path)
            try:
                now = self.files[name](text)
            except ValueError as error:
                yield f"{name}: {error}"
                return
            if text != now:
                lines = difflib.unified_diff(
                    text.splitlines(), now.splitlines(), name, "now", n=1, lineterm=""
                )
                yield "\n".join(lines)
        elif not any(path.name in _text(document) for document in documents()):
            yield f"{name} is in no document"


def documents() -> list[Path]:
    """Return the pages that people read."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def _text(path: Path) -> str:
    return path.read_text("utf-8") if path.is_file() else ""


def _whole(page: Callable[[], str]) -> Make:
    return lambda _: page()


def _measured(name: str, text: str) -> str:
    from tests.benchmarks.peers import report, results

    kept = results.read(ROOT / "docs" / "benchmarks" / "benchmarks.json")
    return report.with_figures(text, report.DOCUMENTS[name](kept))


def _graphs() -> dict[str, Make]:
    def draw(trial: first_robot.Trial, _: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            first_robot.write_files(trial.files, Path(folder))
            return first_robot.graph_in(Path(folder), trial)

    trials = first_robot.Walk(_text(first_robot.PAGE)).trials
    return {
        f".github/first_robot_{trial.picture}": partial(draw, trial)
        for trial in trials
        if trial.command == "graph"
    }


def _each(
    refreshed: Callable[[str, str], str], names: Iterable[str]
) -> dict[str, Make]:
    return {name: partial(refreshed, name) for name in dict.fromkeys(names)}


def _names(paths: Iterable[Path]) -> list[str]:
    return [path.relative_to(ROOT).as_posix() for path in paths]


_TUTORIAL = "docs/first-robot.md"
_OTHERS = [name for name in _names(documents()) if name != _TUTORIAL]
PARTS: Mapping[str, Part] = {
    "options": Part({"docs/command-line.md": _whole(command_line_page.page)}),
    "manual": Part({"docs/sambot-viz.1": _whole(manual_page.page)}),
    "displays": Part({"docs/displays.md": _whole(display_table.display_table)}),
    "limits": Part({"docs/limits.md": _whole(limits_page.page)}),
    "problems": Part({"docs/problems.md": _whole(problem_page.problem_page)}),
    "conditions": Part({"docs/lessons.md": lesson_page.page}),
    "tutorial": Part({_TUTORIAL: first_robot.refreshed}),
    "snapshots": Part(
        {_TUTORIAL: partial(first_robot.refreshed, drawn=True)}, browser=True
    ),
    "answers": Part(_each(quotes.refreshed, _OTHERS)),
    "figures": Part(
        _each(figures.refreshed, (one.document for one in figures.FIGURES))
    ),
    "measured": Part(_each(_measured, ("README.md", "docs/benchmarks.md"))),
    "graphs": Part(_graphs()),
    "pictures": Part(
        pictures=[f".github/{name}" for name in make_pictures.names()],
        script=make_pictures.main,
        browser=True,
    ),
    # `python -m tests.benchmarks --docs` makes these, in half an hour.
    "plots": Part(pictures=_names((ROOT / "docs" / "benchmarks").glob("*.svg"))),
}
"""What is made, by name; where two write one file, each has a place of it."""


def main(words: Sequence[str]) -> int:
    """Check or write parts; returns 1 when one is not as it has to be."""
    parser = argparse.ArgumentParser(
        description=(__doc__ or "").partition("\n\n")[0],
        epilog=f"The parts are {', '.join(PARTS)}.",
    )
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--check", action="store_true", help="list what is stale; default")
    how.add_argument("--write", action="store_true", help="write it again")
    parser.add_argument("parts", nargs="*", metavar="PART", help="all but pictures")
    given = parser.parse_args(words)
    if unknown := set(given.parts) - PARTS.keys():
        parser.error(f"no part {', '.join(sorted(unknown))}; there are {list(PARTS)}")
    chosen = given.parts or [name for name, part in PARTS.items() if not part.browser]
    faults = []
    for name in chosen:
        part = PARTS[name]
        if given.write:
            part.write()
        else:
            for file in (*part.files, *part.pictures):
                faults += [f"{name}: {fault}" for fault in part.faults(file)]
    print("\n".join(faults), end="\n" if faults else "")
    return bool(faults)


if __name__ == "__main__":
    sys.path.append(str(ROOT))  # tests.benchmarks
    sys.exit(main(sys.argv[1:]))
