"""Find the call of a macro that gives a wheel the side of its twin, or half of it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from sambot_viz.edits import source_of
from sambot_viz.errors import Fix, Place
from sambot_viz.robot.parts import Joint
from sambot_viz.robot.slips.twin_names import RIGHT
from sambot_viz.robot.xacro.macro_texts import (
    CallText,
    Written,
    calls_of,
    macro_around,
    sources,
)

_NAME = re.compile(r"[A-Za-z_]\w*")
_PART = re.compile(r"(?:\$\{[^}]*\}|[^\s$])+")
_SUM = re.compile(r"[^-+*/(e]\s*[-+]")
_ZERO = re.compile(r"[+-]?0*(?:\.0*)?")
_SIGN = re.compile(r"[+-]?1(?:\.0*)?")


def other_side(
    one: Joint, other: Joint, files: Sequence[str]
) -> tuple[Place, Fix] | None:
    """Return the call of one of two joints in the same place, and its fix, or None.

    Args:
        one: a joint.
        other: one from another call of the same macro.
        files: those of the model, as the user would write them.
    """
    place = one.origin.place
    source = source_of(place.file) if place is not None else None
    if place is None or source is None or place != other.origin.place:
        return None
    macro = macro_around(place.file, source, source.offset(place))
    tag = source.tag(source.offset(place))
    if macro is None or tag is None or "xyz" not in tag.values:
        return None
    used = set(_NAME.findall(source.text[slice(*tag.values["xyz"])]))
    calls = calls_of(macro.name, sources(files))
    both = [_call_of(joint, calls) for joint in (one, other)]
    if None in both or both[0] is both[1]:
        return None
    wrong = one if (one.origin.xyz[1] > 0) == _is_right(one) else other
    call = both[wrong is other]
    if call is None:
        return None
    given = _sides(call, used) or _same_across(call, both, place)
    # Where x has a sign too, the name says which of the two is across.
    given = [g for g in given if "y" in g[0].lower()] or given
    if len(given) != 1:
        return None
    name, value = given[0]
    new = _negated(value.text)
    hint = f'write {name}="{new}" in the call for {wrong.child}'
    return call.tag.place, Fix(hint, (value.edit(new),))


def _same_across(
    call: CallText, both: Sequence[CallText | None], place: Place
) -> list[tuple[str, Written]]:
    """Return what both calls give for the second number of a place."""
    source = source_of(place.file)
    tag = None if source is None else source.tag(source.offset(place))
    if source is None or tag is None:
        return []
    parts = _PART.findall(source.text[slice(*tag.values["xyz"])])
    across = _NAME.findall(parts[1]) if len(parts) == 3 else []
    found = [(name, call.values[name]) for name in across if name in call.values]
    texts = {each.values[n].text for each in both if each for n, _ in found}
    return found if len(texts) == 1 and not any(map(_ZERO.fullmatch, texts)) else []


def _negated(text: str) -> str:
    """Return the text of a number, or of one expression, with the other sign."""
    one = re.fullmatch(r"\$\{(.*)\}", text)
    inner = text if one is None else one[1].strip()
    if inner.startswith("-") and not _SUM.search(inner[1:]):
        new = inner[1:]
    elif _SUM.search(inner):
        new = f"-({inner})"
    else:
        new = "-" + inner.lstrip("+")
    return new if one is None else f"${{{new}}}"


def lost_bracket(
    one: Joint, other: Joint, files: Sequence[str]
) -> tuple[Place, Fix] | None:
    """Return the call that negates only the first part of what its twin's call has.

    -a + b is not the other side of a + b.

    Args:
        one: a joint.
        other: one from another call of the same macro.
        files: those of the model, as the user would write them.
    """
    place = one.place
    source = source_of(place.file) if place is not None else None
    macro = (
        None
        if place is None or source is None
        else macro_around(place.file, source, source.offset(place))
    )
    if macro is None:
        return None
    calls = calls_of(macro.name, sources(files))
    first, second = (_call_of(joint, calls) for joint in (one, other))
    if first is None or second is None or first is second:
        return None
    for name in first.values.keys() & second.values.keys():
        for right, wrong in (
            (first.values[name], second.values[name]),
            (second.values[name], first.values[name]),
        ):
            inner = re.fullmatch(r"\$\{\s*([^}]*?)\s*\}", right.text)
            bare = "".join(right.text.split())
            slip = f"${{-{bare[2:]}"
            if inner and _SUM.search(inner[1]) and "".join(wrong.text.split()) == slip:
                if inner[1].startswith("("):
                    continue
                new = f"${{-({inner[1]})}}"
                hint = f'write {name}="{new}"'
                return wrong.place, Fix(hint, (wrong.edit(new),))
    return None


def _is_right(joint: Joint) -> bool:
    return RIGHT.search(f"{joint.name} {joint.child}") is not None


def _call_of(joint: Joint, calls: Sequence[CallText]) -> CallText | None:
    """Return the only call with a value that is a part of the joint's name."""
    found = [
        call
        for call in calls
        if any(len(v.text) > 1 and v.text in joint.name for v in call.values.values())
    ]
    return found[0] if len(found) == 1 else None


def _sides(call: CallText, used: set[str]) -> list[tuple[str, Written]]:
    """Return the parameters of a call for the place of a part that are 1 or -1."""
    return [
        (name, value)
        for name, value in call.values.items()
        if name in used and _SIGN.fullmatch(value.text)
    ]
