"""The page of all codes, docs/problems.md.

Run ``python tests/support/problem_page.py`` after a change of messages.
"""

from __future__ import annotations

from pathlib import Path

from problem_samples import Sample, all_samples
from quick_yaml import quick_yaml

PAGE = Path(__file__).parents[2] / "docs" / "problems.md"
"""Where the page is in the source tree."""

_HEAD = """\
# What can be wrong with a model

This page is made by `python tests/support/problem_page.py` from the smallest wrong
model of each code; what it quotes is what the program says about that model.
An *error* is something that ROS refuses or loses, a *warning* will cause trouble later,
an *info* is worth knowing. A unit, a wheel or another guess from numbers is a *warning*
where two clues that are independent speak for it, and an *info* where only one does.
What to do is also an edit where it is a certain replacement of text:
`sambot-viz check --fix` applies those, after it has shown them.
"""

_ACCEPTED = """\
## What ROS accepts and what causes trouble later
"""

_AROUND = """\
## Names that must meet

These are about two places that contradict each other: the model and another file of its
package, or two of these files.
"""

_REST = """\
## What ROS or its tools refuse, lose or misread
"""

_REFUSALS = """\
## Which program an error is about

A finding that no program confirms is a warning or an info, never an error.

| program | what it does | known from | codes |
|---|---|---|---|"""

_HEADER = ("| code | severity | what | what to do |", "|---|---|---|---|")


def problem_page() -> str:
    """The page as text."""
    samples = all_samples()
    lines = [_HEAD, _ACCEPTED]
    lines += [_section(sample) for sample in samples if sample.why]
    lines += [_AROUND, *_HEADER]
    lines += [_row(sample) for sample in samples if sample.around]
    lines += ["", _REST, *_HEADER]
    lines += [_row(s) for s in samples if not s.why and not s.around]
    lines += ["", _REFUSALS, *map(_refusal, refusals())]
    return "\n".join(lines) + "\n"


def refusals() -> list[dict[str, str]]:
    """Which program each error is about: program, does, known, codes."""
    return quick_yaml(PAGE.parents[1] / "tests" / "data" / "refusals.yaml")


def _refusal(row: dict[str, str]) -> str:
    codes = ", ".join(f"`{code}`" for code in row["codes"].split())
    return f"| {row['program']} | {row['does']} | {row['known']} | {codes} |"


def _section(sample: Sample) -> str:
    problem = sample.problem
    place = f"line {problem.line}: " if problem.line else ""
    quoted = _cell(f"{place}{problem.message}; {problem.hint}")
    return (
        f"### {sample.code} ({problem.severity})\n\n{sample.title}. {sample.why}\n\n"
        f"```xml\n{_model(sample)}```\n\n> {quoted}\n"
    )


def _model(sample: Sample) -> str:
    content = sample.files[sample.name]
    return content if isinstance(content, str) else content.decode()


def _row(sample: Sample) -> str:
    problem = sample.problem
    title = _cell(sample.title)
    what = title if sample.stated else f"{title}: “{_cell(problem.message)}”"
    hint = _cell(problem.hint)
    return f"| `{sample.code}` | {problem.severity} | {what} | {hint} |"


def _cell(text: str) -> str:
    """Text that keeps its meaning in a table of Markdown."""
    safe = text.replace("&", "&amp;").replace("<", "&lt;").replace("|", "\\|")
    return " ".join(safe.replace("*", "\\*").split())


if __name__ == "__main__":
    PAGE.write_text(problem_page(), encoding="utf-8")
