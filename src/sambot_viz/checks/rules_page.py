"""The page of all codes, RULES.md: ``python -m sambot_viz.checks.rules_page``."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.checks.registry import RULES
from sambot_viz.checks.samples import Sample, all_samples, problems_of
from sambot_viz.errors import Problem

PAGE = Path(__file__).with_name("RULES.md")
"""Where the page lies in the source tree."""

_HEAD = """\
# What can be wrong with a model

This page is made by `python -m sambot_viz.checks.rules_page` from the rules and from
the smallest wrong model of each code; what it quotes is what the program says of it.
An *error* is something that ROS refuses or loses, a *warning* will bite later, an
*info* is worth knowing.
"""

_RULES = """\
## What ROS accepts and what bites later
"""

_REST = """\
## What ROS or its tools refuse, lose or misread
"""


def rules_page() -> str:
    """The page as text."""
    ours = {rule.code for rule in RULES}
    lines = [_HEAD, _RULES]
    lines += [_rule(sample) for sample in all_samples() if sample.code in ours]
    lines += [_REST, "| code | severity | what | what to do |", "|---|---|---|---|"]
    lines += [_row(sample) for sample in all_samples() if sample.code not in ours]
    return "\n".join(lines) + "\n"


def _rule(sample: Sample) -> str:
    problem = _own(sample)
    place = f"line {problem.line}: " if problem.line else ""
    said = f"{place}{problem.message}; {problem.hint}"
    return (
        f"### {sample.code} ({problem.severity})\n\n{sample.title}. {sample.why}\n\n"
        f"```xml\n{_model(sample)}```\n\n> {_cell(said)}\n"
    )


def _model(sample: Sample) -> str:
    content = sample.files[sample.name]
    return content if isinstance(content, str) else content.decode()


def _own(sample: Sample) -> Problem:
    return next(p for p in problems_of(sample.code) if p.code == sample.code)


def _row(sample: Sample) -> str:
    problem = _own(sample)
    title = _cell(sample.title)
    what = title if sample.said else f"{title}: “{_cell(problem.message)}”"
    hint = _cell(problem.hint)
    return f"| `{sample.code}` | {problem.severity} | {what} | {hint} |"


def _cell(text: str) -> str:
    """Text that stays what it is in a table of Markdown."""
    safe = text.replace("&", "&amp;").replace("<", "&lt;").replace("|", "\\|")
    return " ".join(safe.replace("*", "\\*").split())


if __name__ == "__main__":
    PAGE.write_text(rules_page(), encoding="utf-8")
