"""Validation: what a browser sends is a value that a row can have, or is refused."""

from __future__ import annotations

import itertools
import math
import random
import string
from collections.abc import Callable
from typing import Any, get_args

import pytest

from sambot_viz import SambotVizError, limits
from sambot_viz.panels import sent, validation
from sambot_viz.panels.command import (
    FLAG,
    INTEGER,
    LIST,
    NUMBER,
    TEXT,
    Argument,
    Command,
)
from sambot_viz.panels.rows.row import Data, Kind, Row

SIGNS = string.printable + "äß→\ud800\udfff\u202e\x00\x7f\u2028\ufeff\U0001f600"
NUMBERS = (0, 1, -1, 3, 2**31, 2**53 + 1, -(2**63), 10**400, 1e-300, 0.5, 1e13, -1e300)
LONGEST = limits.PAGE_TEXT.value
ODD: tuple[Any, ...] = (None, True, False, math.nan, math.inf, -math.inf, *NUMBERS)


def settable(kind: Kind, **more: Any) -> Row:
    values: dict[str, Any] = {"vector": (0.0, 0.0, 0.0), "color": (1, 2, 3)}
    value = values.get(kind)
    return Row("row", "", kind, "Name", value=value, set=lambda value: None, **more)


def called(*arguments: Argument) -> Command:
    return Command("x/do", arguments, name="Name")


def checked(item: Row | Command, value: Any) -> Any:
    """What the row is set to, or the arguments of the command."""
    if isinstance(item, Command):
        return validation.arguments_of(item, value)
    return validation.validate(item, value)


ROWS: list[Row | Command] = [
    *(settable(kind) for kind in get_args(Kind)),
    settable("float", least=-1.0, most=1.0, unit="m"),
    settable("int", least=0),
    settable("enum", options=("Lines", "Billboards", "\ud800 \u202e")),
    settable("enum", options=("Lines",), editable=True),
    called(),
    called(TEXT, Argument(str, optional=True), INTEGER),
    called(LIST, FLAG, NUMBER),
    Row("row", "", "float", "Name", value=1.0),
]


def garbage(chance: random.Random, depth: int = 3) -> Any:
    """Anything that a decoded message may hold."""
    make: list[Callable[[], Any]] = [
        lambda: chance.choice(ODD),
        lambda: chance.uniform(-1e15, 1e15),
        lambda: "".join(chance.choices(SIGNS, k=chance.randrange(12))),
        lambda: "x" * chance.choice((LONGEST, LONGEST + 1, 70_000)),
        lambda: bytes(chance.randrange(4)),
        lambda: [garbage(chance, depth - 1) for _ in range(chance.randrange(5))],
        lambda: {"a": garbage(chance, depth - 1)},
    ]
    return chance.choice(make if depth else make[:5])()


def test_whatever_comes_is_refused_with_a_sentence_or_can_be_sent_on() -> None:
    chance = random.Random(1)
    taken = 0
    for row, _ in itertools.product(ROWS, range(400)):
        value = garbage(chance)
        try:
            found = checked(row, value)
        except SambotVizError as error:
            sentence = str(error)
            assert sentence.isprintable(), sentence
            sentence.encode()
            assert len(sentence) < 300
            continue
        taken += 1
        assert_plain(found)
    # Some of it must have been values that rows do have.
    assert taken > 100


def assert_plain(value: object) -> None:
    """Only what can be kept and drawn comes through."""
    if isinstance(value, str):
        value.encode()
        assert len(value) <= limits.PAGE_TEXT.value
    elif isinstance(value, int | float):
        assert math.isfinite(float(value))
    elif isinstance(value, list | tuple):
        for part in value:  # pyright: ignore[reportUnknownVariableType]
            assert_plain(part)  # pyright: ignore[reportUnknownArgumentType]


def test_what_is_no_new_value_is_dropped() -> None:
    chance = random.Random(2)
    for _ in range(5000):
        message = garbage(chance)
        found = sent.read(message)
        if found is not None:
            assert isinstance(found.id, str)
            assert found.gesture is None or type(found.gesture) is int
    for message in ([], ["row"], ["row", 1, 2, 3], [1, 2], ["x" * 401, 1], "row", None):
        assert sent.read(message) is None
    for gesture in (True, 1.5, "1", [1]):
        assert sent.read(["row", 1, gesture]) is None


def test_a_deep_nest_of_lists_is_refused() -> None:
    nest: list[Any] = []
    for _ in range(3000):
        nest = [nest]
    for row in ROWS:
        with pytest.raises(SambotVizError):
            checked(row, nest)
        with pytest.raises(SambotVizError):
            checked(row, [nest])


@pytest.mark.parametrize(
    ("row", "value", "found"),
    [
        (settable("float"), 1, 1.0),
        (settable("int"), 3.0, 3),
        (settable("bool"), False, False),
        (settable("display"), True, True),
        (settable("color"), "white", "white"),
        (settable("color"), "255;0; +7", "255;0; +7"),
        (settable("color"), [1, 2, 3], (1, 2, 3)),
        (settable("vector"), [1, 2, 3], (1, 2, 3)),
        (settable("text"), "two words", "two words"),
        (settable("frame"), "", ""),
        (settable("enum", options=("a", "b")), "b", "b"),
        (settable("enum", options=("a",), editable=True), "other", "other"),
        (called(), [], ()),
        (called(), None, ()),
        (called(TEXT, Argument(int, optional=True)), ["a", None], ("a", None)),
        (called(FLAG), [False], (False,)),
        (called(LIST), [["a", 1]], (["a", 1],)),
        (called(NUMBER), [1], (1,)),
    ],
)
def test_values_of_the_right_type_pass(
    row: Row | Command, value: Any, found: Any
) -> None:
    assert checked(row, value) == found
    assert type(checked(row, value)) is type(found)


def test_an_option_that_cannot_be_shown_as_it_is_can_be_chosen() -> None:
    row = settable("enum", options=("plain", "a\u202eb"))
    shown = row.json()["options"][1]
    assert shown != "a\u202eb"
    assert checked(row, shown) == "a\u202eb"


@pytest.mark.parametrize(
    ("row", "value", "sentence"),
    [
        (settable("float"), "1", "'Name' needs a number, not '1'"),
        (settable("float"), True, "'Name' needs a number, not True"),
        (settable("float", most=-1.0), 2, "'Name' cannot be 2: its limits are −∞ … −1"),
        (settable("int"), 1.5, "'Name' needs a whole number"),
        (
            settable("color"),
            "300;0;0",
            "'Name' cannot be '300;0;0': a colour is three whole numbers from 0 to "
            "255, such as '255; 128; 0'",
        ),
        (settable("float", least=0.0, most=1.0, unit="m"), 2, "its limits are 0 … 1 m"),
        (settable("vector"), [1, 2], "'Name' needs 3 numbers"),
        (settable("text"), "x" * 1001, "'Name' takes at most 1000 characters"),
        (settable("text"), "a\u202e", "contains an invisible character"),
        (settable("enum", options=("a",)), "b", "'Name' does not offer 'b'"),
        (settable("bool"), 1, "'Name' does not take 1"),
        (settable("status"), "Ok", "'Name' does not take 'Ok'"),
        (called(INTEGER), [True], "'Name' does not take True"),
        (called(INTEGER), [1.5], "'Name' does not take 1.5"),
        (called(INTEGER), [10**400], "'Name' needs a number"),
        (
            called(NUMBER),
            [1.7e308],
            "'Name' cannot be 1.7e+308: numbers up to 1,000,000,000,000 are taken",
        ),
        (called(LIST), [[1, -1e13]], "'Name' cannot be -1e+13: numbers up to 1,000"),
        (called(Argument(float, least=0, most=1)), [1.5], "'Name' needs a number"),
        (called(TEXT), [None], "'Name' does not take None"),
        (called(TEXT), ["a", "b"], "'Name' does not take ['a', 'b']"),
        (called(), {"a": 1}, "'Name' does not take {'a': 1}"),
        (Row("row", "", "bool", "Name"), True, "cannot be changed now"),
    ],
)
def test_others_are_refused_with_a_reason(
    row: Row | Command, value: Any, sentence: str
) -> None:
    with pytest.raises(SambotVizError) as refused:
        checked(row, value)
    assert sentence in str(refused.value)


def test_who_may_not_edit_sets_and_calls_only_what_is_local_to_the_client() -> None:
    done: list[Any] = []
    for client_local in (False, True):
        row = Row("a", "", "float", set=done.append, client_local=client_local)
        call = Command("b", (TEXT,), done.append, client_local=client_local)
        for item, value in ((row, 1.0), (call, ["x"])):
            if client_local:
                validation.accept(item, value, may_edit=False)()
            else:
                with pytest.raises(SambotVizError):
                    validation.accept(item, value, may_edit=False)
            validation.accept(item, value, may_edit=True)()
    assert done == [1.0, "x", 1.0, 1.0, "x", "x"]
    with pytest.raises(SambotVizError):
        validation.accept(Data("c", 1), 2, may_edit=True)
