"""Rows of declared properties: the declaration says all there is to say about a row."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from sambot_viz.panels.rows.row import Answer, Kind, Row
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    ConfigItem,
    Declared,
    EditableEnumProperty,
    EnumProperty,
    FileProperty,
    FloatProperty,
    IntProperty,
    KeptProperty,
    Property,
    TfFrameProperty,
    TopicProperty,
    VectorProperty,
)

Change = Callable[[str, Any], object]
"""Sets the property at a path to a value."""

_KINDS: tuple[tuple[type[Property], Kind], ...] = (
    (BoolProperty, "bool"),
    (IntProperty, "int"),
    (FloatProperty, "float"),
    (ColorProperty, "color"),
    (VectorProperty, "vector"),
    (EnumProperty, "enum"),
    (EditableEnumProperty, "enum"),
    (TfFrameProperty, "frame"),
    (FileProperty, "file"),
)


def kind_of(prop: Property) -> Kind:
    """Return how a property's row is drawn."""
    if not prop.has_value:
        return "group"
    if prop.read_only:
        return "readonly"
    for cls, kind in _KINDS:
        if isinstance(prop, cls):
            return kind
    return "text"


def property_rows(
    item: ConfigItem,
    parent: str,
    change: Change,
    *,
    client_local: bool = False,
) -> Iterator[Row]:
    """Yield the rows of all properties of an item that are shown at present.

    Args:
        item: whose properties.
        parent: the id of the row they are below; the ids begin with it.
        change: called with the path of a property and its new value.
        client_local: whether `change` changes only what one client shows.
    """
    for declared in item.declared.values():
        if is_listed(item, declared):
            yield property_row(
                item, declared, parent, change, client_local=client_local
            )


def is_listed(item: ConfigItem, declared: Declared) -> bool:
    """Return whether a property has a row now: another one's value may hide it."""
    prop = declared.property
    if isinstance(prop, KeptProperty) or prop.support in ("none", "kept"):
        return False
    if not item.is_shown(declared.path):
        return False
    # A group needs children; lists of links or frames add their own rows.
    if prop.has_value or prop.open_keys:
        return True
    return any(
        child.property.support not in ("none", "kept")
        for child in item.declared.values()
        if child.above is declared
    )


def property_row(
    item: ConfigItem,
    declared: Declared,
    parent: str,
    change: Change,
    *,
    client_local: bool = False,
) -> Row:
    """Return the row of one property."""
    prop, path, above = declared.property, declared.path, declared.above
    kind = kind_of(prop)
    value = item.get(path) if prop.has_value else None
    return Row(
        id=f"{parent}/{path}",
        parent=parent if above is None else f"{parent}/{above.path}",
        kind=kind,
        name=prop.name,
        value=prop.show(value) if kind == "readonly" else value,
        unit=prop.unit,
        least=prop.minimum,
        most=prop.maximum,
        step=_step(prop),
        options=_options(prop),
        editable=isinstance(prop, EditableEnumProperty),
        help=prop.help,
        extra=_extra(prop),
        client_local=client_local,
        set=None
        if kind == "group" or prop.read_only
        else partial(_set, item, declared, change),
    )


def _set(item: ConfigItem, declared: Declared, change: Change, value: Any) -> object:
    """Set a property; the answer says if the value was adjusted."""
    answer, now = change(declared.path, value), item.get(declared.path)
    if answer is not None or now == value or isinstance(now, tuple):
        return answer
    return Answer(f"'{value}' was taken as '{now}'", level="info")


def _step(prop: Property) -> float | None:
    """Return what an arrow key adds: one step of the usual unit."""
    if isinstance(prop, IntProperty):
        return 1
    if isinstance(prop, FloatProperty | VectorProperty):
        return 0.01
    return None


def _options(prop: Property) -> tuple[str, ...]:
    if isinstance(prop, TfFrameProperty):
        # The frames themselves are in a list for all rows of this kind.
        return (prop.default,) if prop.offers_fixed_frame else ()
    return prop.options


def _extra(prop: Property) -> dict[str, Any] | None:
    if isinstance(prop, TopicProperty):
        return {"emptiable": True}
    return {"parts": list(prop.keys)} if isinstance(prop, VectorProperty) else None
