"""Parameters of robot_localization and Nav2 whose values have another type."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, flag, place_of
from sambot_viz.checks.around.navigation import filters
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem

Type = Literal["double", "integer", "bool", "string", "list", "none"]

_INPUT = r"(?:odom|imu|pose|twist)\d+"
_FILTER: dict[Type, re.Pattern[str]] = {
    "double": re.compile(
        "frequency|sensor_timeout|transform_time_offset|transform_timeout|"
        rf"control_timeout|history_length|{_INPUT}_\w*rejection_threshold"
    ),
    "bool": re.compile(
        "two_d_mode|publish_tf|publish_acceleration|print_diagnostics|debug|"
        "smooth_lagged_data|permit_corrected_publication|use_control|"
        rf"{_INPUT}_(?:differential|relative|remove_gravitational_acceleration)"
    ),
    "string": re.compile(rf"(?:map|odom|base_link|world)_frame|{_INPUT}"),
}
_COSTMAP: dict[Type, re.Pattern[str]] = {
    "double": re.compile(
        "robot_radius|resolution|update_frequency|publish_frequency|"
        r"\w+\.(?:inflation_radius|cost_scaling_factor)"
    ),
    "bool": re.compile("rolling_window|track_unknown_space|always_send_full_costmap"),
    "string": re.compile(
        r"robot_base_frame|global_frame|\w+\.observation_sources|.*\.(?:topic|data_type)"
    ),
}
_OTHER: dict[Type, re.Pattern[str]] = {
    "double": re.compile("controller_frequency|smoothing_frequency"),
    "bool": re.compile("use_sim_time"),
    "string": re.compile(
        "(?:base|odom|global)_frame_id|robot_base_frame|odom_topic|scan_topic"
    ),
}
_OTHER_NODES = frozenset(
    {"amcl", "bt_navigator", "controller_server", "velocity_smoother"}
)
_CONFIG = re.compile(rf"{_INPUT}_config")
_STATES = 15
"""The filter estimates so many values: pose, velocities and acceleration."""

_TRUTH = re.compile("true|false|yes|no|on|off|y|n", re.IGNORECASE)
_INTEGER = re.compile(r"[-+]?(?:\d+|0x[0-9a-fA-F]+)")
_OPEN = re.compile(r"[$<{}~]|null", re.IGNORECASE)
_WANTED: dict[Type, str] = {
    "double": "a number with a decimal point",
    "bool": "true or false without quotation marks",
    "string": "one text",
}


class _Repair(NamedTuple):
    """What a value is, and what to write for it."""

    place: Place
    written: str
    hint: str | Fix


def parameter_types(around: Surroundings) -> Iterator[Problem]:
    """Report values that stop a node, because they have another type than it reads."""
    names = {one.node for one in filters(around)}
    for parameter in around.parameters:
        if parameter.node in names and _CONFIG.fullmatch(parameter.name):
            yield from _config(parameter)
            continue
        wanted = _wanted(parameter, parameter.node in names)
        repair = _repair(parameter, wanted, around) if wanted else None
        if repair is not None and wanted is not None:
            yield _finding(parameter, repair, _WANTED[wanted])


def _finding(parameter: Parameter, repair: _Repair, wanted: str) -> Problem:
    node = parameter.node.rpartition("/")[2]
    return Problem.at(
        repair.place,
        "error",
        "parameter-type",
        f"{parameter.name} is {repair.written}, but {node} needs {wanted}: it stops "
        "with an error",
        repair.hint,
    )


def _wanted(parameter: Parameter, of_filter: bool) -> Type | None:
    """The type that the node of a parameter declares it with, if that is known."""
    parts = parameter.node.split("/")
    tables: list[dict[Type, re.Pattern[str]]] = [{"bool": _OTHER["bool"]}]
    if of_filter:
        tables.append(_FILTER)
    elif parts[-1].endswith("costmap"):
        tables.append(_COSTMAP)
    elif not _OTHER_NODES.isdisjoint(parts):
        tables.append(_OTHER)
    for table in tables:
        for kind, pattern in table.items():
            if pattern.fullmatch(parameter.name):
                return kind
    return None


def _repair(parameter: Parameter, wanted: Type, around: Surroundings) -> _Repair | None:
    """What to write for a value of another type; None for one of the right type."""
    kind = type_of(parameter.written)
    text, place = parameter.fact.value.strip(), parameter.value_place
    if kind == wanted or _OPEN.search(text):
        return None
    if kind == "none":
        known = around.known
        base = "base_link"
        if known is not None and base not in known.links:
            base = known.root
        hint = "write a value, or delete this line"
        if parameter.name == "robot_base_frame":
            hint = f"write robot_base_frame: {base}"
        return _Repair(parameter.place, "empty", hint)
    if kind == "list" and len(parameter.values) != 1:
        return _Repair(place, "a list", f"write {_WANTED[wanted]}")
    better = _converted(text, wanted)
    if better is None:
        hint = Fix(f"write {_WANTED[wanted]}")
    else:
        marks = " without quotation marks"
        more = marks if kind == "string" and text == better else ""
        hint = _instead(parameter.written, place.file, better, f"write {better}{more}")
    return _Repair(place, _as_written(parameter.written, kind), hint)


def _converted(text: str, wanted: Type) -> str | None:
    """The same value as another type, without a comma after it."""
    bare = text.rstrip(",; ")
    if wanted == "string":
        return f'"{text}"' if _TRUTH.fullmatch(text) or _is_number(text) else text
    if wanted == "bool":
        truth = {"1": True, "0": False}.get(bare, flag(bare))
        return None if truth is None else str(truth).lower()
    if _INTEGER.fullmatch(bare) and "x" not in bare:
        return f"{bare}.0"
    return bare if _is_number(bare) else None


def _as_written(node: yaml.Node, kind: Type) -> str:
    names: dict[Type, str] = {
        "integer": "the whole number",
        "double": "the number",
        "bool": "the truth value",
    }
    if kind == "list":
        return "a list with one item"
    text = str(node.value).strip()
    return f"{names[kind]} {text}" if kind in names else f'the text "{text}"'


def _config(parameter: Parameter) -> Iterator[Problem]:
    """Report a list of what is used from an input that is not 15 truth values."""
    node = parameter.written
    items: list[yaml.Node] = node.value if isinstance(node, yaml.SequenceNode) else []
    for item in items:
        if type_of(item) != "bool" and isinstance(item, yaml.ScalarNode):
            if not _OPEN.search(item.value):
                yield _finding(
                    parameter,
                    _truth(item, parameter.place.file),
                    "a list of true and false",
                )
            return
    count = len(items)
    if not items or count == _STATES:
        return
    missing = _STATES - count
    surplus = f"{-missing} values" if missing < -1 else "value"
    yield Problem.at(
        parameter.value_place,
        "error",
        "parameter-type",
        f"{parameter.name} has {count} values, but {parameter.node} needs {_STATES}: "
        "position, rotation, both velocities and acceleration, three each",
        f"add {', '.join(['false'] * missing)} at the end of the list"
        if missing > 0
        else f"delete the last {surplus}",
    )


def _truth(item: yaml.ScalarNode, file: str) -> _Repair:
    """What to write for an item that is neither true nor false."""
    place, words = place_of(item, file), item.value.split()
    written = f'a list with "{item.value}"'
    if len(words) > 1 and all(_TRUTH.fullmatch(word) for word in words):
        return _Repair(place, written, f"write {', '.join(words)}: a comma is missing")
    better = _converted(item.value, "bool")
    if better is None:
        return _Repair(place, written, "write true or false")
    marks = " without quotation marks" if better == item.value else ""
    hint = _instead(item, file, better, f"write {better}{marks}")
    return _Repair(place, written, hint)


def _instead(node: yaml.Node, file: str, right: str, hint: str) -> Fix:
    """Return the fix that writes another value; a list is left to the user."""
    if not isinstance(node, yaml.ScalarNode):
        return Fix(hint)
    end: Any = node.end_mark
    behind = Place(file, end.line + 1, end.column + 1)
    return write_between(place_of(node, file), behind, right, hint)


def type_of(node: yaml.Node) -> Type:
    """Return the type that ROS takes a value for."""
    if not isinstance(node, yaml.ScalarNode):
        return "list"
    text: str = node.value
    if node.style or text == "":
        return "string" if node.style else "none"
    if _TRUTH.fullmatch(text):
        return "bool"
    if _INTEGER.fullmatch(text):
        return "integer"
    return "double" if _is_number(text) else "string"


def _is_number(text: str) -> bool:
    if "_" in text:
        return False
    try:
        float(text.replace(".inf", "inf").replace(".nan", "nan"))
    except ValueError:
        return False
    return True
