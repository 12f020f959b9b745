"""The elements that SDF knows, from the table ``elements.txt``."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

from sambot_viz.errors import nearest

_TABLE = Path(__file__).with_name("elements.txt")
_WORDS = re.compile(r"(\w+)(?:([=~?])(.+))?")


class Values(NamedTuple):
    """The valid values of an element's text or of an attribute.

    Attributes:
        kind: "string", "number", "int", "uint", "boolean", "vector2", "vector3",
            "color" or "pose"; "" for an element without text.
        required: whether the value must not be empty.
        low: minimum of numbers.
        high: maximum of numbers.
        words: valid words; empty for any.
        any_case: whether capitals of these words do not count.
        lenient: whether the first word replaces an unknown one.
    """

    kind: str = ""
    required: bool = False
    low: float = -math.inf
    high: float = math.inf
    words: tuple[str, ...] = ()
    any_case: bool = False
    lenient: bool = False


@dataclass(frozen=True, slots=True)
class ElementType:
    """One element of the table.

    Attributes:
        name: its tag.
        text: valid values of its text.
        attributes: name → valid values.
        children: tag → element that it may contain.
        open: whether it may contain anything.
    """

    name: str
    text: Values
    attributes: Mapping[str, Values]
    children: dict[str, ElementType] = field(default_factory=dict["str", "ElementType"])
    open: bool = False


@cache
def model_type() -> ElementType:
    """Return the type of a <model>, with its valid content."""
    blocks: dict[str, ElementType] = {}
    users: list[tuple[ElementType, str, str]] = []
    stack: list[ElementType] = []
    for line in _TABLE.read_text("utf-8").splitlines():
        if not line or line.startswith("#"):
            continue
        words = line.split()
        depth = (len(line) - len(line.lstrip())) // 2
        if depth == 0:
            block, *words = words
            blocks[block] = element = _element(words)
        else:
            *words, last = words
            if not last.startswith("&"):
                words.append(last)
            element = _element(words)
            stack[depth - 1].children[element.name] = element
            if last.startswith("&"):
                users.append((stack[depth - 1], element.name, last))
        stack[depth:] = [element]
    for parent, name, block in users:
        own = parent.children[name]
        shared = blocks[block]
        required = shared.text._replace(required=own.text.required)
        parent.children[name] = replace(shared, name=name, text=required)
    return blocks["&model"]


def _element(words: list[str]) -> ElementType:
    """Read ``name! kind 0..1 @attribute:kind``."""
    mark, *rest = words
    name = mark.rstrip("!*")
    attributes = [word[1:].split(":", 1) for word in rest if word.startswith("@")]
    plain = [word for word in rest if not word.startswith("@")]
    text = _values(plain[0] if plain else "", "!" in mark)
    if len(plain) > 1:
        low, high = plain[1].split("..")
        text = text._replace(
            low=float(low) if low else -math.inf,
            high=float(high) if high else math.inf,
        )
    return ElementType(
        name,
        text,
        {
            attribute.removesuffix("!"): _values(kind, attribute.endswith("!"))
            for attribute, kind in attributes
        },
        open="*" in mark,
    )


@cache
def _values(text: str, required: bool) -> Values:
    match = _WORDS.fullmatch(text)
    if match is None:
        return Values("", required)
    words = tuple(match[3].split("|")) if match[3] else ()
    mark = match[2] or ""
    any_case, lenient = mark in ("~", "?"), mark == "?"
    return Values(match[1], required, words=words, any_case=any_case, lenient=lenient)


def meant_word(text: str, wanted: Values) -> str | None:
    """Return the known word that another one stands for, or None."""
    plain = {_plain(word): word for word in wanted.words}
    for word in (text, text.strip().removesuffix("_sensor")):
        if _plain(word) in plain:
            return plain[_plain(word)]
    return nearest(text.strip(), wanted.words)


def _plain(word: str) -> str:
    return re.sub("[_ -]", "", word.strip()).lower()
