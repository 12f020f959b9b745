"""Find what stops a YAML file, by the small change that makes it readable."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import yaml
from yaml.parser import ParserError
from yaml.scanner import ScannerError

from sambot_viz import limits
from sambot_viz.checks.around.files.fault import Fault

_YAML: Any = yaml
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_NO_COLON = re.compile(r"(\s*(?:- +)?)([A-Za-z_][\w.]*) +([^\s:#][^:#]*)")
_NO_BLANK = re.compile(r"(\s*(?:- +)?)([A-Za-z_][\w.]*):([^\s/].*)")
_VALUES = re.compile(r"""("[^"]*"|'[^']*')\s+(?=["'])""")
_KEY = re.compile(r"\s*[\w.]+:(\s|$)")
_ITEM = re.compile(r"(\s*)- +([A-Za-z_]\w*): +([\w./-]+)")
_LIST = re.compile(r"(\s*)\w+:\s*\[")
_WORD = re.compile(r"[A-Za-z_]\w*")
_BEFORE = 3
_TWICE = ("local_costmap:", "global_costmap:")
"""The node of a costmap has the name of its namespace."""


def fault_in(text: str) -> Fault | None:
    """Return what stops a YAML file; None for readable YAML."""
    error = _error(text)
    if error is None:
        return None
    lines = text.splitlines()
    at = min(_line(error), len(lines) - 1)
    changes = (
        _candidates(lines, at, error) if len(text) <= limits.YAML_REPAIRED.value else ()
    )
    nearly = None
    for line, better, cause, hint in changes:
        again = _error(
            "\n".join([*lines[:line], *better, *lines[line + len(better) :]])
        )
        if again is None:
            only = better[0] if len(better) == 1 else None
            return Fault(line + 1, cause, hint, only)
        if nearly is None and _line(again) > max(at, line):
            # Another fault follows, or this change is not the intended one.
            nearly = Fault(line + 1, cause, hint)
    return nearly or Fault(
        at + 1, f"{error.problem}", "correct this line or the one above it"
    )


def _error(text: str) -> yaml.MarkedYAMLError | None:
    """Return the first place where the text is not YAML; without following aliases."""
    try:
        for _ in _YAML.parse(text, _LOADER):
            pass
    except (ScannerError, ParserError) as error:
        return error
    except (yaml.YAMLError, RecursionError):
        return None
    return None


def _line(error: yaml.MarkedYAMLError) -> int:
    return error.problem_mark.line if error.problem_mark else 0


class _Candidate(NamedTuple):
    """Lines to write from a line on, counted from 0, and the reason."""

    line: int
    better: list[str]
    cause: str
    hint: str


def _candidates(
    lines: list[str], at: int, error: yaml.MarkedYAMLError
) -> Iterator[_Candidate]:
    tabs = [n for n, line in enumerate(lines) if "\t" in _indent(line)]
    for width in (2, 4, 8) if tabs else ():
        better = [_indent(x).replace("\t", " " * width) + x.lstrip() for x in lines]
        yield _Candidate(
            tabs[0],
            better[tabs[0] :],
            "a tab is in the indentation of this line",
            "write blanks for the tab",
        )
    yield from _levels(lines, at)
    near = [n for n in range(at, -1, -1) if _says(lines[n])][: _BEFORE + 1]
    start = error.context_mark
    if start is not None and start.line < len(lines) and start.line not in near:
        near.append(start.line)
    for change in (_colon, _quote, _comma, _bracket):
        for n in near:
            yield from change(lines, n)
    for n in near:
        yield from _dash(lines, n)
    for n in near:
        yield from _name_in_list(lines, n)
    yield from _without_key(lines, at)
    yield from _indentation(lines, near)


def _levels(lines: list[str], at: int) -> Iterator[_Candidate]:
    """Repeat the name of a costmap, where ros__parameters is two levels below."""
    for n in range(min(at, len(lines) - 2), -1, -1):
        name, below = lines[n].strip(), lines[n + 1]
        deeper = len(_indent(below)) - len(_indent(lines[n]))
        if name not in _TWICE or not below.strip().startswith("ros__") or deeper < 4:
            continue
        inner = _indent(lines[n]) + "  " + name
        yield _Candidate(
            n,
            [f"{lines[n]}\n{inner}"],
            f"{name} has to be there twice, and the second, two blanks further in, is "
            "missing",
            f"add a line {name} below this one, with {len(_indent(inner))} blanks "
            "before it",
        )


def _says(line: str) -> bool:
    """Whether there is more in a line than blanks and a comment."""
    return line.lstrip()[:1] not in ("", "#")


def _indent(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def _colon(lines: list[str], n: int) -> Iterator[_Candidate]:
    for pattern, cause in (
        (_NO_COLON, "there is no colon after {}"),
        (_NO_BLANK, "there is no blank after the colon of {}"),
    ):
        match = pattern.fullmatch(lines[n].partition(" #")[0].rstrip())
        if match is not None:
            better = f"{match[2]}: {match[3]}"
            yield _Candidate(
                n, [match[1] + better], cause.format(match[2]), f"write {better}"
            )


def _quote(lines: list[str], n: int) -> Iterator[_Candidate]:
    code = lines[n].partition(" #")[0].rstrip()
    for mark in "\"'":
        if code.count(mark) % 2:
            value = code[code.index(mark) :] + mark
            yield _Candidate(
                n,
                [code + mark],
                f"a quotation mark {mark} is opened and not closed",
                f"write {value}",
            )


def _comma(lines: list[str], n: int) -> Iterator[_Candidate]:
    """Write a comma after a value of a list in brackets."""
    code = lines[n].partition(" #")[0].rstrip()
    is_inside = _open(lines, n, "[]") > 0
    between = _VALUES.sub(r"\1, ", code)
    better = f"{code}," if is_inside and code[-1:] not in ("[", ",", "") else between
    if better != code:
        cause = "a comma is missing in this line"
        hint = "write a comma behind each value of the list"
        yield _Candidate(n, [better], cause, hint)


def _open(lines: list[str], n: int, marks: str) -> int:
    """Return how many brackets are open at the end of a line."""
    text = "\n".join(line.partition(" #")[0] for line in lines[: n + 1])
    return text.count(marks[0]) - text.count(marks[1])


def _bracket(lines: list[str], n: int) -> Iterator[_Candidate]:
    code = lines[n].partition(" #")[0].rstrip()
    for marks in ("[]", "{}"):
        if _open(lines, n, marks) < 1:
            continue
        mark = marks[1]
        yield _Candidate(
            n,
            [code.removesuffix(",") + mark],
            f"the bracket {mark} is missing at the end of this line",
            f"add {mark}",
        )


def _dash(lines: list[str], n: int) -> Iterator[_Candidate]:
    """Begin an entry of a list with the first key of the other entries."""
    code = lines[n].strip()
    key = code.partition(":")[0]
    first = next((x for x in lines if x.lstrip().startswith(f"- {key}:")), None)
    if first is not None and _indent(first) == _indent(lines[n]):
        yield _Candidate(
            n,
            [f"{_indent(first)}- {code}"],
            f'there is no "- " before {key}, which begins an entry',
            f"write - {code}",
        )


def _name_in_list(lines: list[str], n: int) -> Iterator[_Candidate]:
    """Write a key for an item of a list, where the lines beside it are keys."""
    match = _ITEM.fullmatch(lines[n].partition(" #")[0].rstrip())
    if match is None:
        return
    blanks, key, value = match.groups()
    around = (lines[n + 1 :], lines[n - 1 :: -1] if n else [])
    for after in (_first_beside(each, len(blanks)) for each in around):
        if _indent(after) != blanks or not _KEY.match(after):
            continue
        better = f"{value}:" if key == "name" else f"{key}: {value}"
        yield _Candidate(
            n,
            [blanks + better],
            f"- begins a list, but {_key_in(after)} beside it is a name",
            f"write {better}",
        )


def _first_beside(lines: Iterable[str], depth: int) -> str:
    """Return the first line that is no further in; empty without one."""
    return next((x for x in lines if _says(x) and len(_indent(x)) <= depth), "")


def _key_in(line: str) -> str:
    return line.strip().partition(":")[0]


def _without_key(lines: list[str], n: int) -> Iterator[_Candidate]:
    """Write the name of a group that a list names, above lines that are further in."""
    above = next((x for x in lines[n - 1 :: -1] if _says(x)), "") if n else ""
    blanks = _indent(above)
    is_deeper = len(_indent(lines[n])) > len(blanks) + 1 and bool(_KEY.match(above))
    if not is_deeper or above.rstrip().endswith(":"):
        return
    keys = {_key_in(line) for line in lines}
    lists = (line for line in lines if (m := _LIST.match(line)) and m[1] <= blanks)
    names = dict.fromkeys(
        w for line in lists for w in _WORD.findall(line.partition(":")[2])
    )
    for name in (name for name in names if name not in {*keys, "true", "false"}):
        yield _Candidate(
            n,
            [f"{blanks}{name}:\n{lines[n]}"],
            f"this line is further in than the one above: the line {name}: is missing",
            f"add a line {name}: above this one, with {len(blanks)} blanks before it",
        )


def _indentation(lines: list[str], near: list[int]) -> Iterator[_Candidate]:
    """Indent a line like a neighbour; the commonest form first."""
    keys = Counter(_indent(line) for line in lines if _KEY.match(line))
    found: list[tuple[int, _Candidate]] = []
    for n in near:
        before = [_indent(lines[k]) for k in range(n) if _says(lines[k])]
        after = [_indent(x) for x in lines[n + 1 :] if _says(x)]
        for indent in dict.fromkeys((*before[-1:], *after[:1])):
            if indent == _indent(lines[n]):
                continue
            candidate = _Candidate(
                n,
                [indent + lines[n].lstrip()],
                "the indentation of this line is that of no other line here",
                f"write {len(indent)} blanks before it",
            )
            found.append((keys[indent], candidate))
    yield from (one for _, one in sorted(found, key=lambda pair: -pair[0]))
