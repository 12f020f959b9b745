"""Check the layers of Nav2's costmaps: their order, and the inflation."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.footprint import (
    counted_footprint,
    inscribed_radius,
)
from sambot_viz.checks.around.parameters.navigation import bare_frame
from sambot_viz.checks.around.parameters.node_parts import (
    Given,
    NodePart,
    names_in,
    parts_by_node,
)
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import number
from sambot_viz.edits import source_of, write, write_between
from sambot_viz.errors import Fix, Place, Problem

_INFLATION = "InflationLayer"
_MARKING = ("StaticLayer", "ObstacleLayer", "VoxelLayer")
_RADIUS = "inflation_radius"
_ROLLING = "rolling_window"
_ORIGINS = ("origin_x", "origin_y")
_UNITS = (100.0, 1000.0)
"""Centimetres and millimetres in a metre."""
_NEAR = 0.01


def inflation_before_layers(around: Surroundings) -> Iterator[Problem]:
    """Report an inflation layer before a layer whose obstacles it would inflate."""
    for part in (part for parts in parts_by_node(around) for part in parts):
        listed = next((one for one, k in part.lists() if k.name == "plugins"), None)
        kinds = [_kind(name, part) for name in names_in(listed)] if listed else []
        if listed is None or kinds.count(_INFLATION) != 1:
            continue
        at, names = kinds.index(_INFLATION), names_in(listed)
        late = [n for n, kind in enumerate(kinds) if n > at and kind in _MARKING]
        if not late:
            continue
        yield Problem.at(
            listed.value_place,
            "warning",
            "costmap-layers",
            f"{names[at]} comes before {names[late[-1]]} in {part.node}, and layers "
            "are applied in this order: what comes after it is not inflated, and the "
            "robot drives along it",
            _in_order(listed, at, late[-1]),
        )


def _kind(name: str, part: NodePart) -> str:
    """Return the class of a layer without its package; empty for an unknown one."""
    plugin = part.sections.get(name, {}).get("plugin")
    return plugin.fact.value.rpartition("::")[2] if plugin is not None else ""


def _in_order(listed: Parameter, at: int, last: int) -> Fix:
    """Return the fix that moves an item of a list behind another one."""
    file, source = listed.place.file, source_of(listed.place.file)
    written = listed.written
    items: list[yaml.Node] = written.value
    names = names_in(listed)
    hint = f"write {names[at]} behind {names[last]}"
    is_one_line = written.start_mark.line == written.end_mark.line
    if source is None or not is_one_line or not getattr(written, "flow_style", False):
        return Fix(hint)
    line = source.text.split("\n")[written.start_mark.line]
    texts = [line[i.start_mark.column : i.end_mark.column] for i in items]
    texts.insert(last, texts.pop(at))
    end = written.end_mark
    behind = Place(file, end.line + 1, end.column + 1)
    return write_between(place_of(written, file), behind, f"[{', '.join(texts)}]", hint)


def inflation_too_large(around: Surroundings) -> Iterator[Problem]:
    """Report an inflation radius that fills the costmap, probably in another unit."""
    parts = [part for parts in parts_by_node(around) for part in parts]
    every = [(p, p.given[_RADIUS]) for p in parts if _RADIUS in p.given and p.section]
    for part, radius in every:
        value = radius.fact.number
        own = next((p for p in parts if p.node == part.node and not p.section), None)
        sides = (own.given.get(name) for name in ("width", "height")) if own else ()
        sizes = [s for p in sides if p is not None and (s := p.fact.number)]
        if value is None or not sizes or value < min(sizes):
            continue
        other = next((o for _, o in every if _is_unit(value, o.fact.number)), None)
        better = "" if other is None else other.fact.value
        yield Problem.at(
            radius.value_place,
            "info" if other is None else "warning",
            "costmap-layers",
            f"{_RADIUS} is {number(value)} m, and {part.node} is only "
            f"{number(min(sizes))} m wide: all of it is near an obstacle"
            + (
                ""
                if other is None
                else f"; that of {other.node.rpartition('/')[2]} is {better} m "
                f"({where(other.place, radius.place)})"
            ),
            write(radius.value_place, radius.fact.value, better)
            if other is not None
            else "write the distance from obstacles in metres, such as 0.55",
        )


def inflation_too_small(around: Surroundings) -> Iterator[Problem]:
    """Report an inflation radius that is smaller than half the width of the robot."""
    every = parts_by_node(around)
    radii = [p.given[_RADIUS] for parts in every for p in parts if _RADIUS in p.given]
    for own, *layers in every:
        half, said = inscribed_radius(own.given), counted_footprint(own.given)
        if half is None or said is None:
            continue
        used = {name for one, _ in own.lists() for name in names_in(one)}
        given = [layer.given for layer in layers if layer.section in used]
        what = "" if said.fact.number else "inscribed radius of the "
        for radius in [g[_RADIUS] for g in given if _is_below(half, g)]:
            others = (r for r in radii if (r.fact.number or 0.0) >= half)
            other, place = next(others, None), radius.value_place
            yield Problem.at(
                place,
                "warning",
                "costmap-layers",
                f"{_RADIUS} of {own.node} is {radius.fact.value} m, but the {what}"
                f"{said.name} ({where(said.place, place)}) is {number(half)} m: paths "
                "come too near to obstacles, and Nav2 logs an error",
                write(place, radius.fact.value, other.fact.value)
                if other is not None
                else f"write at least {number(half)}",
            )


def _is_below(half: float, layer: Given) -> bool:
    """Return whether a layer inflates by less than a length [m]."""
    radius = layer[_RADIUS].fact.number if _RADIUS in layer else None
    is_off = "enabled" in layer and layer["enabled"].flag is False
    return radius is not None and radius < half and not is_off


def still_costmaps(around: Surroundings) -> Iterator[Problem]:
    """Report a local costmap in the odometry frame that does not follow the robot."""
    told = {p.node.rpartition("/")[2] for p in around.parameters if p.name == _ROLLING}
    for part in (parts[0] for parts in parts_by_node(around)):
        frame, rolling = part.given.get("global_frame"), part.given.get(_ROLLING)
        layers = [name for one, _ in part.lists() for name in names_in(one)]
        kinds = {_kind(name, part) for name in layers}
        is_odom = frame is not None and bare_frame(frame.fact.value) == "odom"
        is_moved = any(name in part.given for name in _ORIGINS)
        if part.node != "local_costmap" or not is_odom or is_moved or not kinds:
            continue
        if not kinds.isdisjoint({"StaticLayer", ""}) or frame is None:
            # A map, or a layer of which nothing is known, may stay where it is.
            continue
        is_whole = "width" in part.given and part.node not in told
        if rolling is None and is_whole:
            at = Place(frame.place.file, frame.place.line, 1)
            said, place = "is missing, which means false", frame.place
            fix = _line_before(at, f"{_ROLLING}: true")
        elif rolling is not None and rolling.flag is False:
            said, place = f"is {rolling.fact.value}", rolling.value_place
            fix = write(place, rolling.fact.value, "true")
        else:
            continue
        yield Problem.at(
            place,
            "warning",
            "costmap-layers",
            f"{_ROLLING} of {part.node} {said}, so that its corner stays where the "
            "robot starts: the robot is outside at once, and no obstacle is seen there",
            fix,
        )


def _line_before(at: Place, added: str) -> Fix:
    """Return the fix that adds a line before another one, at its level."""
    source, hint = source_of(at.file), f"add a line {added}"
    line = source.text.split("\n")[at.line - 1] if source is not None else ""
    blanks = line[: len(line) - len(line.lstrip())]
    is_alone = line.lstrip().startswith("global_frame")
    return write_between(at, at, f"{blanks}{added}\n", hint) if is_alone else Fix(hint)


def _is_unit(value: float, other: float | None) -> bool:
    return other is not None and any(
        abs(value - other * unit) <= _NEAR * value for unit in _UNITS
    )
