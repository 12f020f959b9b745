from __future__ import annotations

from typing import Any

import pytest

from sambot_viz.errors import SambotVizError
from sambot_viz.rviz import (
    QOS_PROPERTIES,
    BoolProperty,
    ColorProperty,
    EditableEnumProperty,
    EnumProperty,
    FloatProperty,
    GroupProperty,
    IntProperty,
    Property,
    PropertyError,
    RegexProperty,
    StringProperty,
    TfFrameProperty,
    TopicProperty,
    VectorProperty,
)
from sambot_viz.rviz.yaml.parser import parse
from sambot_viz.rviz.yaml.yaml_nodes import Node

ALPHA = FloatProperty("Alpha", default=0.5, minimum=0.0, maximum=1.0)
COUNT = IntProperty("Count", default=10, minimum=1)
STYLE = EnumProperty("Style", default="Lines", options=("Lines", "Billboards"))


def read(prop: Property, text: str) -> tuple[Any, list[str]]:
    """The value, and the messages, of a property that stands as `text` in a file."""
    said: list[str] = []

    def report(node: Node, message: str, hint: str, right: str = "") -> None:
        del node, hint, right
        said.append(message)

    return prop.read(parse(text), report), said


def test_one_text_reads_as_int_float_and_string():
    assert read(IntProperty("n"), "1") == (1, [])
    assert read(FloatProperty("n"), "1") == (1.0, [])
    assert read(StringProperty("n"), "1") == ("1", [])
    assert read(StringProperty("n"), "1.50") == ("1.50", [])


def test_an_empty_string_is_a_value_and_null_is_none():
    assert read(StringProperty("s", default="x"), '""') == ("", [])
    assert read(StringProperty("s", default="x"), "~") == (None, [])


@pytest.mark.parametrize("text", ["false", "False", "0", '""', '"false"'])
def test_rviz_s_three_texts_are_false(text: str):
    assert read(BoolProperty("b", default=True), text) == (False, [])


@pytest.mark.parametrize("text", ["true", "TRUE", "1", "yes", "on"])
def test_true_texts_are_true(text: str):
    assert read(BoolProperty("b"), text) == (True, [])


def test_no_and_off_are_false_with_a_warning_that_rviz_reads_true():
    value, said = read(BoolProperty("Show Names"), "off")
    assert value is False
    assert said == ["'Show Names' is 'off', which RViz reads as true; here it is false"]


def test_any_other_text_is_true_with_a_warning():
    value, said = read(BoolProperty("Show Names"), "abc")
    assert value is True
    assert said == ["'Show Names' is 'abc', which RViz reads as true"]


def test_a_whole_number_written_as_a_float_is_accepted_with_a_warning():
    value, said = read(COUNT, "10.0")
    assert value == 10
    assert said == ["'Count' is 10.0, which RViz reads as 1; here it is 10"]


def test_a_text_that_is_no_integer_keeps_the_default():
    value, said = read(COUNT, "abc")
    assert value is None
    assert said == [
        "'Count' is 'abc', which is not a whole number of at least 1; "
        "the default 10 is used"
    ]


def test_values_out_of_range_are_clamped_with_a_warning():
    assert read(ALPHA, "7")[0] == 1.0
    assert read(ALPHA, "-1")[0] == 0.0
    assert read(COUNT, "0")[0] == 1
    assert read(ALPHA, "7")[1] == [
        "'Alpha' is 7, but must be a number from 0 to 1; 1 is used, as in RViz"
    ]


@pytest.mark.parametrize("text", ["nan", "abc", "1.2.3"])
def test_a_float_that_is_no_finite_number_keeps_the_default(text: str):
    value, said = read(ALPHA, text)
    assert value is None
    assert "the default 0.5 is used" in said[0]


def test_infinity_is_clamped_where_there_is_a_limit():
    assert read(ALPHA, "inf")[0] == 1.0
    assert read(FloatProperty("Scale", default=1.0), "inf")[0] is None


def test_a_decimal_comma_in_a_float_is_accepted_with_a_warning():
    value, said = read(ALPHA, "0,25")
    assert value == 0.25
    assert "RViz reads as 0" in said[0]


def test_a_vector_needs_all_its_components():
    offset = VectorProperty("Offset")
    assert read(offset, "{X: -1, Y: 1.1, Z: 1.1e3}") == ((-1.0, 1.1, 1100.0), [])
    assert read(offset, "{X: 1, Y: 2}")[0] is None
    assert read(offset, "{X: 1, Y: 2, Z: abc}")[0] is None
    assert read(offset, "{X: 1, Y: 2, Z: nan}")[0] is None


def test_a_vector_s_components_may_have_decimal_commas():
    found = read(VectorProperty("Offset"), "{X: '1,2', Y: '1.234,5', Z: 0}")
    assert found == ((1.2, 1234.5, 0.0), [])


def test_a_vector_written_as_one_text_is_ignored_with_a_warning():
    value, said = read(VectorProperty("Offset"), "1; 2; 3")
    assert value is None
    assert said == [
        "'Offset' is not a map of 3 numbers (X, Y, Z); RViz ignores it, and so do we"
    ]


def test_a_vector_set_to_text_follows_and_refuses_nonsense():
    offset = VectorProperty("Offset")
    assert offset.coerce("1;2;3") == (1.0, 2.0, 3.0)
    with pytest.raises(PropertyError, match="'Offset' must be a map of 3 numbers"):
        offset.coerce("chubby!")


def test_a_vector_is_shown_with_semicolons():
    assert VectorProperty("v").write((0.1, 0.0001, 1000.0)) == "0.1; 0.0001; 1000"


def test_a_colour_that_cannot_be_read_keeps_the_default():
    color = ColorProperty("Color", default=(1, 2, 3))
    assert read(color, "white") == ((255, 255, 255), [])
    value, said = read(color, "1,2,3")
    assert value is None
    assert said == [
        "'Color' is '1,2,3', which is not a colour such as '160; 160; 164'; "
        "the default 1; 2; 3 is used"
    ]


def test_a_colour_takes_numbers_and_texts_and_clamps():
    color = ColorProperty("Color")
    assert color.coerce("-1;2000;3") == (0, 255, 3)
    assert color.coerce([-1, 2000, 3]) == (0, 255, 3)
    with pytest.raises(PropertyError):
        color.coerce("chubby!")


def test_an_unknown_option_is_kept_and_acts_as_the_first():
    value, said = read(STYLE, "Dots")
    assert value == "Dots"
    assert STYLE.acting(value) == "Lines"
    assert said == [
        "'Style' is 'Dots', which is not one of 'Lines', 'Billboards'; "
        "it acts as 'Lines', as in RViz"
    ]


def test_an_enum_without_options_acts_as_it_is_written():
    assert EnumProperty("Style").acting("x") == "x"


def test_the_empty_text_that_rviz_writes_for_an_option_is_not_reported():
    assert read(STYLE, "''") == ("", [])
    assert STYLE.acting("") == "Lines"


def test_an_editable_enum_takes_any_text():
    policy = EditableEnumProperty("History Policy", options=("Keep Last", "Keep All"))
    assert read(policy, "Odd") == ("Odd", [])
    assert policy.coerce("Odder") == "Odder"


def test_one_leading_slash_of_a_frame_is_dropped():
    frame = TfFrameProperty("Fixed Frame", default="map")
    assert read(frame, "/map") == ("map", [])
    assert frame.coerce("//map") == "/map"
    assert read(frame, "<Fixed Frame>")[0] == "<Fixed Frame>"
    assert not frame.offers_fixed_frame
    assert TfFrameProperty("Reference Frame").offers_fixed_frame


def test_a_list_where_a_frame_belongs_keeps_the_default():
    value, said = read(TfFrameProperty("Fixed Frame"), "[PLANNING_FRAME]")
    assert value is None
    assert said == [
        "'Fixed Frame' has a list where the name of a frame belongs; "
        "the default <Fixed Frame> is used"
    ]


def test_a_broken_regular_expression_filters_nothing_and_is_kept():
    value, said = read(RegexProperty("Filter (whitelist)"), "'*wheel'")
    assert value == "*wheel"
    assert "is not a regular expression" in said[0]
    assert RegexProperty.compiled(value) is None
    assert RegexProperty.compiled("") is None
    pattern = RegexProperty.compiled("wheel$")
    assert pattern is not None
    assert pattern.matches("left_wheel")
    assert not pattern.matches("wheel_left")


@pytest.mark.parametrize("expression", [r"((((\w+)+)+)+)+!", "(a+)+$", "(a|aa)+$"])
def test_an_expression_that_would_backtrack_for_ever_is_searched_at_once(expression):
    pattern = RegexProperty.compiled(expression)
    assert pattern is not None
    assert not pattern.matches("a" * 5000 + "\n")


@pytest.mark.parametrize(
    "expression", ["(?!left)wheel", r"(a)\1", "a" * 1001, "\ud800"]
)
def test_an_expression_that_cannot_be_searched_in_linear_time_filters_nothing(
    expression,
):
    assert RegexProperty.compiled(expression) is None


def test_a_name_with_half_a_character_can_be_searched():
    pattern = RegexProperty.compiled("wheel")
    assert pattern is not None
    assert pattern.matches("\ud800wheel")


@pytest.mark.parametrize(
    "prop", [RegexProperty("Filter"), StringProperty("TF Prefix"), TfFrameProperty("F")]
)
def test_a_text_that_is_set_has_at_most_1000_characters(prop):
    assert prop.coerce("x" * 1000) == "x" * 1000
    with pytest.raises(PropertyError, match="at most 1000 characters"):
        prop.coerce("x" * 1001)


def test_a_frame_rate_above_60_is_kept_and_acts_as_60():
    prop = IntProperty("Frame Rate", default=30, minimum=1, acts_up_to=60)
    value, said = read(prop, "2000")
    assert (value, prop.acting(value), prop.acting(25)) == (2000, 60, 25)
    assert said == ["'Frame Rate' is 2000, which acts as 60 here"]


def test_a_map_gives_its_value_and_a_flat_text_gives_the_same():
    assert read(STYLE, "{Value: Billboards, Line Width: 1}") == ("Billboards", [])
    assert read(STYLE, "Billboards") == ("Billboards", [])
    assert read(STYLE, "{Line Width: 1}") == (None, [])


def test_a_topic_has_its_quality_of_service_below_it_in_rviz_s_order():
    names = [child.name for child in TopicProperty("Topic").children]
    assert names == [
        "Depth",
        "History Policy",
        "Reliability Policy",
        "Durability Policy",
    ]
    assert [p.default for p in QOS_PROPERTIES] == [
        5,
        "Keep Last",
        "Reliable",
        "Volatile",
    ]


def test_a_group_has_no_value():
    assert not GroupProperty("Links").has_value
    with pytest.raises(PropertyError):
        GroupProperty("Links").coerce(1)


@pytest.mark.parametrize(
    ("prop", "given", "taken"),
    [
        (BoolProperty("b"), True, True),
        (COUNT, 3, 3),
        (COUNT, 3.0, 3),
        (COUNT, -5, 1),
        (ALPHA, 1, 1.0),
        (ALPHA, 9.0, 1.0),
        (STYLE, "Billboards", "Billboards"),
        (StringProperty("s"), "x", "x"),
        (VectorProperty("v"), [1, 2, 3], (1.0, 2.0, 3.0)),
    ],
)
def test_values_of_a_program_are_taken_and_clamped(
    prop: Property, given: object, taken: object
):
    value = prop.coerce(given)
    assert value == taken
    assert type(value) is type(taken)


@pytest.mark.parametrize(
    ("prop", "given"),
    [
        (BoolProperty("b"), 1),
        (BoolProperty("b"), "true"),
        (COUNT, 2.5),
        (COUNT, True),
        (COUNT, "3"),
        (COUNT, 2**40),
        (ALPHA, float("nan")),
        (ALPHA, float("inf")),
        (ALPHA, 1e300),
        (ALPHA, None),
        (ALPHA, "0.5"),
        (STYLE, "Dots"),
        (STYLE, 1),
        (StringProperty("s"), 5),
        (StringProperty("s"), "half \ud83d"),
        (TfFrameProperty("f"), None),
        (ColorProperty("c"), (1, 2)),
        (ColorProperty("c"), (1, 2, float("nan"))),
        (VectorProperty("v"), (1, 2, float("inf"))),
        (VectorProperty("v"), "12"),
        (VectorProperty("v"), {"X": 1, "Y": 2, "Z": 3}),
        (VectorProperty("v"), 1.0),
    ],
)
def test_values_that_cannot_be_meant_are_refused(prop: Property, given: object):
    with pytest.raises(PropertyError) as caught:
        prop.coerce(given)
    assert isinstance(caught.value, SambotVizError)
    assert caught.value.property == prop.name


def test_a_refusal_names_the_property_and_its_range():
    with pytest.raises(PropertyError) as caught:
        ALPHA.coerce("x")
    assert str(caught.value) == "'Alpha' must be a number from 0 to 1, not 'x'"
    with pytest.raises(PropertyError) as caught:
        STYLE.coerce("y" * 99)
    assert str(caught.value).startswith(
        "'Style' must be one of 'Lines', 'Billboards', not 'yyyy"
    )
    assert str(caught.value).endswith("…")


def test_an_empty_option_as_rviz_writes_it_is_kept_and_not_reported():
    assert read(STYLE, '""') == ("", [])
    assert STYLE.acting("") == "Lines"
