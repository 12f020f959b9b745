"""docs/problems.md, from the smallest wrong model of each code."""

from __future__ import annotations

import re
from pathlib import Path

from problem_samples import Sample, all_samples
from quick_yaml import quick_yaml

REFUSALS = Path(__file__).parents[2] / "data" / "refusals.yaml"

_HEAD = """\
# What can be wrong with a model

Each code is a heading here, so `problems.md#CODE` leads to it. This page is made by
`python tests/support/docs.py` from the smallest wrong model of each code; what
it quotes is what `sambot-viz check` says about these files.
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
## Names that must match

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


def problem_page() -> str:
    """The page as text."""
    samples = all_samples()
    lines = [_HEAD, _ACCEPTED]
    lines += [_shown(sample) for sample in samples if sample.why]
    lines.append(_AROUND)
    lines += [_told(sample) for sample in samples if sample.around]
    lines.append(_REST)
    lines += [_told(s) for s in samples if not s.why and not s.around]
    lines += [_REFUSALS, *map(_refusal, refusals())]
    return "\n".join(lines) + "\n"


def refusals() -> list[dict[str, str]]:
    """Which program each error is about: program, does, known, codes."""
    return quick_yaml(REFUSALS)


def _refusal(row: dict[str, str]) -> str:
    codes = ", ".join(f"[{code}](#{code})" for code in row["codes"].split())
    return f"| {row['program']} | {row['does']} | {row['known']} | {codes} |"


def _shown(sample: Sample) -> str:
    """A code with its files and what is said of them."""
    files = {sample.name: sample.files[sample.name], **sample.files}
    blocks = [_file(name, content) for name, content in files.items()]
    problem = sample.problem
    title = f"{sample.title} ({problem.severity}). {sample.why}\n"
    return "\n".join([_heading(sample), title, *blocks, f"> {_cell(str(problem))}\n"])


def _told(sample: Sample) -> str:
    """A code with what is said of its files, without these."""
    problem = sample.problem
    said = "" if sample.stated else f": “{_cell(problem.message)}”"
    title = f"{_cell(sample.title)} ({problem.severity}){said}"
    fix = f"\n\nWhat to do: {_cell(problem.hint)}." if problem.hint else "."
    return f"{_heading(sample)}\n{title}{fix}\n"


def _heading(sample: Sample) -> str:
    return f"### {sample.code}\n"


def _file(name: str, content: str | bytes) -> str:
    text = content if isinstance(content, str) else content.decode()
    kind = "xml" if text.lstrip().startswith("<") else "text"
    return f"`{name}`:\n\n```{kind}\n{text.rstrip()}\n```\n"


def _cell(text: str) -> str:
    """Text that keeps its meaning in Markdown."""
    parts = re.split(r"(`[^`]*`)", text)
    # Code is shown as it is.
    parts[::2] = [_escaped(part) for part in parts[::2]]
    return " ".join("".join(parts).split())


def _escaped(text: str) -> str:
    safe = text.replace("&", "&amp;").replace("<", "&lt;").replace("|", "\\|")
    # Two brackets in a row are a link of Markdown.
    return safe.replace("*", "\\*").replace("][", "]\\[")
