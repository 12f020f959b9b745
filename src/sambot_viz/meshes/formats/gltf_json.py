"""Looking things up in the JSON of a glTF file, which may say anything."""

from __future__ import annotations

from typing import Any, cast

Json = dict[str, Any]


class Broken(ValueError):
    """A glTF file that contradicts itself; the text says how."""


def listing(source: Json, name: str) -> list[object]:
    """A list; empty when it is missing or something else."""
    value: object = source.get(name)
    return cast("list[object]", value) if isinstance(value, list) else []


def section(source: Json, name: str) -> Json:
    """An object; empty when it is missing or something else."""
    value: object = source.get(name)
    return cast(Json, value) if isinstance(value, dict) else {}


def numbers(source: Json, name: str) -> list[int]:
    """A list of whole numbers; anything else in it is left out."""
    return [item for item in listing(source, name) if isinstance(item, int)]


def entry(document: Json, name: str, index: object) -> Json:
    """One entry of a top-level list.

    Raises:
        Broken: there is none of that number.
    """
    known = listing(document, name)
    if isinstance(index, int) and 0 <= index < len(known):
        item = known[index]
        if isinstance(item, dict):
            return cast(Json, item)
    raise Broken(f"it has no entry {index!r:.40} in its list of {name}")


def whole(source: Json, name: str, default: int | None = None) -> int:
    """A number of an entry that must be whole and not negative.

    Raises:
        Broken: it is missing or something else.
    """
    value: object = source.get(name, default)
    if isinstance(value, int) and value >= 0:
        return value
    raise Broken(f"a {name} is {value!r:.40}")
