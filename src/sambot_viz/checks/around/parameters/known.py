"""Read the parameters that nodes and plugins know from the table parameters.txt."""

from __future__ import annotations

import math
import re
from collections.abc import Container, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

from sambot_viz.cached import cached_property
from sambot_viz.errors import nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_TABLE = Path(__file__).parents[2] / "vocabularies" / "parameters.txt"
_DISTRIBUTIONS: tuple[str, ...] = (
    "foxy",
    "galactic",
    "humble",
    "iron",
    "jazzy",
    "kilted",
    "lyrical",
    "rolling",
)
_LIKENESS = 0.8
_NUMBER = re.compile(r"\d+")
_RANGE = re.compile(r"(>?)([-+.\d]*?)\.\.([-+.\d]*)(!?)")
_SIGNS = {"positive": (0.0, math.inf), "negative": (-math.inf, 0.0)}
LISTS = frozenset({"section", "sections", "sources"})
"""The types of parameters that name parts of the node."""


@dataclass(frozen=True, slots=True)
class Age:
    """The distributions that know a name, by their numbers.

    Attributes:
        first: the first one.
        last: the last one.
        successor: its later name; empty without one.
    """

    first: int = 0
    last: int = len(_DISTRIBUTIONS) - 1
    successor: str = ""

    @classmethod
    def of(cls, text: str) -> Age:
        """Read ``first-last->successor``; each of the three may be missing."""
        ages, _, successor = text.partition("->")
        first, _, last = ages.partition("-")
        begin = _DISTRIBUTIONS.index(first) if first else 0
        end = _DISTRIBUTIONS.index(last or "rolling")
        return cls(begin, end, successor)

    @property
    def ends(self) -> bool:
        """True when newer distributions do not know the name."""
        return self.last < len(_DISTRIBUTIONS) - 1

    @property
    def is_old(self) -> bool:
        """True when only distributions without support know the name."""
        return self.last < _DISTRIBUTIONS.index("humble")

    @property
    def last_name(self) -> str:
        """The name of the last one, such as Humble."""
        return _DISTRIBUTIONS[self.last].title()


@dataclass(frozen=True, slots=True)
class KnownParameter:
    """A parameter.

    Attributes:
        name: its name, with N for a number.
        kind: the type of its value, as the table has it.
        low: the lowest usual number.
        high: the highest usual number.
        above: a number must be above `low`.
        signed: a number out of this range has the wrong sign.
        strict: the node stops with another number or word.
        words: the only allowed words; empty for any. With "..." in them, others are
            allowed too, except misspelt ones.
        base: the base class of the plugins that it names.
        pattern: the class of a name in a list, with * for the name.
        own: lists of names that need no sections, because the node has these built in.
        at_most: the parameter that is the upper limit of this one.
        counts: the allowed numbers of items in a list; empty for any number.
        age: the distributions that have it.
        needed: the node does not start without it; for a name with *, without one for
            each of the names that others have there.
        inside: the parameters of a part that it names.
    """

    name: str
    kind: str
    low: float = -math.inf
    high: float = math.inf
    above: bool = False
    signed: bool = False
    strict: bool = False
    words: tuple[str, ...] = ()
    base: str = ""
    pattern: str = ""
    own: tuple[tuple[str, ...], ...] = ()
    at_most: str = ""
    counts: tuple[int, ...] = ()
    age: Age = Age()
    needed: bool = False
    inside: ParameterBlock | None = None


@dataclass(frozen=True)
class ParameterBlock:
    """The parameters of a node, a plugin or a part of them.

    Attributes:
        parameters: name → parameter.
        is_whole: it has no other parameters.
    """

    parameters: dict[str, KnownParameter] = field(
        default_factory=dict[str, KnownParameter]
    )
    is_whole: bool = True

    def __or__(self, other: ParameterBlock) -> ParameterBlock:
        both = {**other.parameters, **self.parameters}
        for name in self.parameters.keys() & other.parameters.keys():
            if self.parameters[name].words != other.parameters[name].words:
                both[name] = replace(both[name], words=())
        return ParameterBlock(both, self.is_whole and other.is_whole)

    def find(self, name: str) -> KnownParameter | None:
        """Return the parameter with a name; None for an unknown one."""
        found = self.parameters.get(name) or self.parameters.get(_NUMBER.sub("N", name))
        if found is None and "." in name:
            return next((k for p, k in self._patterns if p.fullmatch(name)), None)
        return found

    @cached_property
    def _patterns(self) -> list[tuple[re.Pattern[str], KnownParameter]]:
        """The names with a part that may be anything."""
        return [
            (re.compile(re.escape(name).replace(r"\*", r"[^.]+")), known)
            for name, known in self.parameters.items()
            if "*" in name
        ]

    def _with_star(self, name: str) -> str | None:
        """Return the name that differs in one part from one with a part of any name."""
        parts, starred = name.split("."), (k for k in self.parameters if "*" in k)
        for known in (each.split(".") for each in starred):
            if len(known) == len(parts):
                both = list(zip(known, parts, strict=True))
                slips = [(a, b) for a, b in both if a not in ("*", b)]
                if len(slips) == 1 and is_one_slip(*slips[0]):
                    return ".".join(b if a == "*" else a for a, b in both)
        return None

    @cached_property
    def parts(self) -> ParameterBlock:
        """The parameters that its listed parts may have."""
        whole = ParameterBlock()
        for known in self.parameters.values():
            if known.kind in LISTS:
                whole |= known.inside or of_base(known.base)
        return whole

    @cached_property
    def groups(self) -> frozenset[str]:
        """The first parts of names with dots."""
        return frozenset(
            name.partition(".")[0] for name in self.parameters if "." in name
        )

    def meant(self, name: str, given: Container[str]) -> str | None:
        """Return the parameter that an unknown name misspells.

        Args:
            name: as the file has it.
            given: the names of all parameters here, which are not candidates.
        """
        if self.find(name) is not None:
            return None
        if not self.is_whole:
            slips = [known for known in self.parameters if is_one_slip(name, known)]
            is_certain = len(slips) == 1 and not _NUMBER.search(name)
            return slips[0] if is_certain and slips[0] not in given else None
        if "." in name and (right := self._with_star(name)) is not None:
            return None if right in given else right
        shape, digits = _NUMBER.sub("N", name), _NUMBER.search(name)
        near = nearest(shape, self.parameters, _LIKENESS) or (
            nearest(name, self.parameters, _LIKENESS)
        )
        if near is None or _NUMBER.sub("", near) == _NUMBER.sub("", name):
            return None
        right = near
        if "N" in near and digits is None:
            right = near.replace("N", "0")
        elif digits is not None:
            right = near.replace("N", digits[0])
        parts, others = right.split("."), name.split(".")
        if len(parts) > 1:
            both = list(zip(parts, others, strict=False))
            if len(parts) != len(others) or not all(_is_like(*each) for each in both):
                return None
            right = ".".join(b if a == "*" else a for a, b in both)
        return None if right in given else right


def _is_like(right: str, part: str) -> bool:
    return right == "*" or nearest(part, [right]) is not None


class PluginClass(NamedTuple):
    """A class of plugins.

    Attributes:
        name: as files have it.
        base: its base class.
        age: the distributions that have it under this name.
        block: its parameters.
    """

    name: str
    base: str
    age: Age
    block: ParameterBlock


@dataclass(frozen=True)
class ParameterTable:
    """The known nodes and plugins with their parameters.

    Attributes:
        nodes: usual name of a node → its parameters.
        classes: name of a class → the class.
        common: the parameters of every node.
    """

    nodes: Mapping[str, ParameterBlock]
    classes: Mapping[str, PluginClass]
    common: ParameterBlock


@cache
def of_base(base: str) -> ParameterBlock:
    """Return all parameters of all plugins of a base class."""
    whole = ParameterBlock()
    for each in known_parameters().classes.values():
        whole |= each.block if each.base == base else ParameterBlock()
    return whole


@cache
def known_parameters() -> ParameterTable:
    """Return the table."""
    nodes: dict[str, ParameterBlock] = {}
    classes: dict[str, PluginClass] = {}
    stack = [ParameterBlock()]
    for line in _TABLE.read_text("utf-8").splitlines():
        depth = (len(line) - len(line.lstrip())) // 2
        words = [] if line.startswith("#") else line.split()
        del stack[depth + 1 :]
        match words:
            case ["node", *names] if not depth:
                stack = [ParameterBlock()]
                nodes.update(dict.fromkeys(names, stack[0]))
            case ["class", base, *names] if not depth:
                stack = [ParameterBlock()]
                for written in names:
                    name, _, age = written.partition("@")
                    classes[name] = PluginClass(name, base, Age.of(age), stack[0])
            case [name, kind, *rest]:
                del stack[depth:]
                known = _known(name, kind, rest)
                if kind in LISTS and known.base == "":
                    known = replace(known, inside=ParameterBlock())
                stack[depth - 1].parameters[name] = known
                stack.append(known.inside or ParameterBlock())
            case _:
                pass
    common = nodes.pop("*")
    return ParameterTable(
        {name: node | common for name, node in nodes.items()}, classes, common
    )


def _known(name: str, kind: str, rest: list[str]) -> KnownParameter:
    """Read ``name kind 0..1 a|b <=other``."""
    known = KnownParameter(name, kind)
    for word in rest:
        interval = _RANGE.fullmatch(word)
        if interval is not None:
            above, low, high, strict = interval.groups()
            known = replace(known, above=bool(above), strict=bool(strict))
            known = replace(known, low=float(low or "-inf"), high=float(high or "inf"))
        elif (sign := word.rstrip("!")) in _SIGNS:
            low, high = _SIGNS[sign]
            known = replace(known, low=low, high=high, signed=True)
            known = replace(known, strict=word.endswith("!"))
        elif word.startswith("<="):
            known = replace(known, at_most=word[2:])
        elif word.startswith(("@", "->")):
            known = replace(known, age=Age.of(word.removeprefix("@")))
        elif word == "needed":
            known = replace(known, needed=True)
        elif word.startswith(":"):
            known = replace(known, base=word[1:])
        elif word.startswith("="):
            known = replace(known, own=(*known.own, tuple(word[1:].split(","))))
        elif word[1:].replace(",", "").isdigit():
            known = replace(known, counts=tuple(map(int, word[1:].split(","))))
        elif "*" in word:
            known = replace(known, pattern=word)
        else:
            words = tuple(word.rstrip("!").split("|"))
            known = replace(known, words=words, strict=word.endswith("!"))
    return known
