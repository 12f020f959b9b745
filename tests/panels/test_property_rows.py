"""Rows of declared properties: all of a row follows from its declaration."""

from __future__ import annotations

from typing import Any

import pytest

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.panels.rows.property_rows import kind_of, property_rows
from sambot_viz.panels.rows.row import Answer, Row
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    ConfigItem,
    EditableEnumProperty,
    EnumProperty,
    FileProperty,
    FloatProperty,
    GroupProperty,
    IntProperty,
    KeptProperty,
    Property,
    RegexProperty,
    StringProperty,
    TfFrameProperty,
    TopicProperty,
    VectorProperty,
)
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings
from sambot_viz.rviz.yaml.yaml_nodes import Map


class Item:
    """An item with some properties, and what its rows have set."""

    def __init__(self, *declared: Property) -> None:
        self.item = ConfigItem(Map(), declared, ConfigFindings(None))
        self.changes: list[tuple[str, Any]] = []

    def rows(self) -> dict[str, Row]:
        """The rows by the part of their ids behind that of the item."""
        rows = property_rows(self.item, "d1", lambda *args: self.changes.append(args))
        return {row.id.removeprefix("d1/"): row for row in rows}


@pytest.mark.parametrize(
    ("prop", "kind"),
    [
        (BoolProperty("P", default=True), "bool"),
        (IntProperty("P", default=1), "int"),
        (FloatProperty("P", default=1.0), "float"),
        (ColorProperty("P"), "color"),
        (VectorProperty("P"), "vector"),
        (EnumProperty("P", default="a", options=("a",)), "enum"),
        (EditableEnumProperty("P", default="a", options=("a",)), "enum"),
        (TfFrameProperty("P", default="map"), "frame"),
        (FileProperty("P", default=""), "file"),
        (StringProperty("P", default=""), "text"),
        (RegexProperty("P", default=""), "text"),
        (TopicProperty("P", default=""), "text"),
        (GroupProperty("P"), "group"),
    ],
)
def test_each_type_has_its_kind_of_row(prop: Property, kind: str) -> None:
    assert kind_of(prop) == kind


def test_a_number_has_its_limits_unit_and_help() -> None:
    prop = FloatProperty(
        "Alpha", default=0.5, minimum=0.0, maximum=1.0, unit="m", help="How opaque."
    )
    (row,) = Item(prop).rows().values()
    assert (row.name, row.value, row.least, row.most) == ("Alpha", 0.5, 0.0, 1.0)
    assert (row.unit, row.help) == ("m", "How opaque.")


def test_setting_a_row_changes_the_property_at_its_path() -> None:
    style = EnumProperty(
        "Style",
        default="Lines",
        options=("Lines", "Billboards"),
        children=(FloatProperty("Width", default=0.1),),
    )
    item = Item(style)
    rows = item.rows()
    assert rows["Style"].options == ("Lines", "Billboards")
    assert rows["Style/Width"].parent == rows["Style"].id
    for path, value in (("Style", "Billboards"), ("Style/Width", 0.2)):
        set_value = rows[path].set
        assert set_value is not None
        set_value(value)
    assert item.changes == [("Style", "Billboards"), ("Style/Width", 0.2)]


@pytest.mark.parametrize(
    ("prop", "typed", "said"),
    [
        (TfFrameProperty("P", default="map"), "/odom", "'/odom' was taken as 'odom'"),
        (FloatProperty("P", default=1.0, maximum=2.0), 3.0, "'3.0' was taken as '2.0'"),
        (TfFrameProperty("P", default="map"), "odom", None),
        (FloatProperty("P", default=1.0), 1, None),
        (ColorProperty("P"), "red", None),
    ],
)
def test_a_value_that_is_taken_as_another_one_is_said(
    prop: Property, typed: Any, said: str | None
) -> None:
    item = ConfigItem(Map(), (prop,), ConfigFindings(None))
    (row,) = property_rows(
        item, "d1", lambda path, value: item.set(path, value) and None
    )
    assert row.set is not None
    answer = row.set(typed)
    assert (answer.say if isinstance(answer, Answer) else answer) == said


def test_a_property_that_depends_on_another_is_listed_while_it_counts() -> None:
    item = Item(
        EnumProperty("Style", default="Lines", options=("Lines", "Billboards")),
        FloatProperty("Width", default=0.1, hidden_unless=("Style", "Billboards")),
    )
    assert list(item.rows()) == ["Style"]
    item.item.set("Style", "Billboards")
    assert list(item.rows()) == ["Style", "Width"]


def test_what_has_no_effect_is_not_listed() -> None:
    item = Item(
        FloatProperty("Kept", default=1.0, support="kept"),
        KeptProperty("Key", support="approximate"),
        GroupProperty("Empty", children=(FloatProperty("No", support="none"),)),
        FloatProperty("Shown", default=1.0, support="approximate"),
    )
    assert list(item.rows()) == ["Shown"]


def test_a_reference_frame_offers_the_fixed_frame_and_other_frames_do_not() -> None:
    item = Item(
        TfFrameProperty("Reference Frame", default="<Fixed Frame>"),
        TfFrameProperty("Fixed Frame", default="base_link"),
    )
    rows = item.rows()
    assert rows["Reference Frame"].options == ("<Fixed Frame>",)
    assert rows["Fixed Frame"].options == ()


@pytest.mark.parametrize("kind", sorted(DISPLAYS))
def test_every_row_of_every_display_can_be_sent_and_has_a_help(kind: str) -> None:
    for row in Item(*DISPLAYS[kind].properties).rows().values():
        assert row.help, row.id
        assert row.json()["kind"] == row.kind
