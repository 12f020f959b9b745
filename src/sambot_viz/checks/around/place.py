"""Name places in files for messages, and make fixes at them."""

from __future__ import annotations

import ast
import re
from pathlib import PurePath
from typing import TYPE_CHECKING

from sambot_viz.edits import source_of, together, write_between
from sambot_viz.errors import Fix, Place

# A model without a package needs no YAML.
if TYPE_CHECKING:
    from sambot_viz.checks.around.files.fault import Fault


def where(other: Place | None, here: Place | str | None) -> str:
    """Name a place for a sentence, such as "line 12" or "ekf.yaml line 12".

    Args:
        other: the place to name; None names nothing.
        here: the place of the finding; the name leaves out the same file.
    """
    if other is None:
        return "in the model"
    file = here.file if isinstance(here, Place) else here
    name = "" if other.file == file else f"{PurePath(other.file).name} "
    return f"{name}line {other.line}"


def line_fix(fault: Fault, place: Place, text: str) -> Fix:
    """Return the fix that writes the corrected line of a fault; its comment stays.

    Args:
        fault: the fault in the file.
        place: its line.
        text: of the file.
    """
    if fault.better is None:
        return Fix(fault.hint)
    place = Place(place.file, fault.at or place.line)
    line = text.splitlines()[place.line - 1]
    comment = line[len(line.partition("#")[0].rstrip()) :]
    kept = "" if fault.better.endswith(comment) else comment
    end = Place(place.file, place.line, len(line) + 1)
    return write_between(place, end, fault.better + kept, fault.hint)


def bracketed(node: ast.expr, file: str, hint: str) -> Fix:
    """Return the fix that writes an expression of Python in square brackets."""
    begin = Place(file, node.lineno, node.col_offset + 1)
    end = Place(file, node.end_lineno or 1, (node.end_col_offset or 0) + 1)
    signs = ((begin, "["), (end, "]"))
    return together(hint, *(write_between(at, at, sign, hint) for at, sign in signs))


def rewritten(node: ast.expr | ast.stmt, file: str, right: str, hint: str = "") -> Fix:
    """Return the fix that writes a text for an expression of Python.

    Args:
        node: the expression.
        file: the file of the expression.
        right: what to write.
        hint: the hint; by default "write" and that text.
    """
    begin = Place(file, node.lineno, node.col_offset + 1)
    line, column = node.end_lineno or node.lineno, node.end_col_offset or 0
    end = Place(file, line, column + 1)
    return write_between(begin, end, right, hint or f"write {right}")


def moved(place: Place, blanks: int, items: int = 1) -> Fix:
    """Return the fix that moves lines of YAML to the right, or to the left.

    Args:
        place: the beginning of the first of them, with its column.
        blanks: the number of columns, less than 0 to the left.
        items: the number of entries at the same level, each with the lines below it.
    """
    word = f"write {blanks} blanks more" if blanks > 0 else f"delete {-blanks} blanks"
    hint = f"{word} before this line and those that belong to it"
    source, column = source_of(place.file), (place.column or 1) - 1
    if source is None:
        return Fix(hint)
    lines, met = source.text.split("\n")[place.line - 1 :], 0
    fixes: list[Fix] = []
    for number, line in enumerate(lines, place.line):
        depth, text = len(line) - len(line.lstrip()), line.strip()
        met += bool(text) and text[0] != "#" and depth == column and text[:2] != "- "
        if text and text[0] != "#" and (depth < column or met > items):
            break
        if text and depth >= max(column, -blanks):
            at, end = (
                Place(place.file, number, 1),
                Place(place.file, number, 1 - blanks),
            )
            both = (at, at, " " * blanks) if blanks > 0 else (at, end, "")
            fixes.append(write_between(*both, hint))
    return together(hint, *fixes)


def without_item(place: Place, hint: str) -> Fix:
    """Return the fix that deletes an entry of a list of YAML, with its lines.

    Args:
        place: a line of the entry.
        hint: the hint.
    """
    source = source_of(place.file)
    if source is None or not place.file.endswith((".yaml", ".yml")):
        return Fix(hint)
    lines = source.text.split("\n")
    above = range(place.line, 0, -1)
    first = next((n for n in above if lines[n - 1].lstrip()[:2] == "- "), 0)
    depth = len(lines[first - 1]) - len(lines[first - 1].lstrip())
    inner = [place.line, first]
    for number, line in enumerate(lines[first:], first + 1):
        text = line.strip()
        if text and text[0] != "#" and len(line) - len(line.lstrip()) <= depth:
            break
        inner += [number] if text and text[0] != "#" else []
    last = max(inner)
    while last < len(lines) - 1 and not lines[last].strip():
        last += 1
    begin, end = Place(place.file, first, 1), Place(place.file, last + 1, 1)
    is_certain = 0 < first and last < len(lines)
    return write_between(begin, end, "", hint) if is_certain else Fix(hint)


def key_place(place: Place, name: str) -> Place:
    """Return the place of a key of YAML; that of its mapping where it is not found."""
    source, column = source_of(place.file), (place.column or 1) - 1
    lines = source.text.split("\n") if source is not None else []
    for number, line in enumerate(lines[place.line - 1 :], place.line):
        text = line.strip()
        if text and text[0] != "#" and len(line) - len(line.lstrip()) < column:
            is_first = number == place.line
            if not is_first:
                break
        found = re.match(rf"\s*(?:- +)*({re.escape(name)})\s*:", line)
        if found is not None and found.start(1) == column:
            return Place(place.file, number, column + 1)
    return place
