from __future__ import annotations

import math

import pytest

from sambot_viz.rviz.properties.number_text import (
    float32,
    float_text,
    parse_float,
    parse_german,
    parse_int,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.03, "0.029999999329447746"),
        (0.1, "0.10000000149011612"),
        (0.785398, "0.785398006439209"),
        (10, "10"),
        (0, "0"),
        (1.5, "1.5"),
        (-0.25, "-0.25"),
        (-999999, "-999999"),
        (100000, "100000"),
        (1e6, "1e+06"),
        (1e10, "1e+10"),
        (0.001, "0.0010000000474974513"),
        (0.0001, "9.999999747378752e-05"),
        (-2e-5, "-1.9999999494757503e-05"),
    ],
)
def test_floats_are_written_as_rviz_writes_them(value: float, text: str):
    assert float_text(value) == text


@pytest.mark.parametrize("value", [1e-40, 3e38, 123456.789, 1 / 3, 2**24 + 1, 7e-5])
def test_a_written_float_reads_back_as_the_same_32_bits(value: float):
    assert parse_float(float_text(value)) == float32(value)


def test_a_float_beyond_32_bits_becomes_infinite():
    assert float32(-1e39) == -math.inf
    assert float_text(1e39) == "inf"


@pytest.mark.parametrize("text", ["1", " -7 ", "+3", "007"])
def test_decimal_integers_are_read(text: str):
    assert parse_int(text) == int(text)


@pytest.mark.parametrize(
    "text", ["", "1.0", "1e1", "0x10", "1_000", "abc", "2147483648", "9" * 5000]
)
def test_what_is_no_decimal_integer_of_32_bits_is_none(text: str):
    assert parse_int(text) is None


@pytest.mark.parametrize(
    ("text", "value"),
    [("1", 1.0), ("1.1e3", 1100.0), (".5", 0.5), ("5.", 5.0), ("-2e-05", -2e-5)],
)
def test_numbers_of_the_c_locale_are_read(text: str, value: float):
    assert parse_float(text) == value


@pytest.mark.parametrize("text", ["inf", "-inf", ".inf", "-.Inf"])
def test_infinite_numbers_are_read_in_both_spellings(text: str):
    assert parse_float(text) == (-math.inf if "-" in text else math.inf)


@pytest.mark.parametrize("text", ["", "1,5", "1_0", "0x1p3", "one", "1 2", "e5"])
def test_other_texts_are_no_numbers(text: str):
    assert parse_float(text) is None


@pytest.mark.parametrize(
    ("text", "value"), [("1,2", 1.2), ("1.234,56", 1234.56), ("5,6e2", 560.0)]
)
def test_a_decimal_comma_is_read_where_rviz_reads_it(text: str, value: float):
    assert parse_german(text) == pytest.approx(value)


@pytest.mark.parametrize("text", ["1.5", "12.34,5", "abc", ""])
def test_a_text_without_a_decimal_comma_is_no_german_number(text: str):
    assert parse_german(text) is None
