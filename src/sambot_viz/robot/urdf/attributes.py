"""Attributes, and the numbers in them, as urdfdom reads them: C locale, blanks only."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix
from sambot_viz.geometry import Vector3
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Origin
from sambot_viz.robot.slips.units import is_with_unit, meant_number, without_units
from sambot_viz.robot.xml.element import Element

NOT_REPLACED = "which xacro has not replaced"
"""Words for an expression in place of a number."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_EXPRESSION = re.compile(r"pi|[*/()]|\d[+-]\d")
_SEPARATORS = re.compile(r"[\s,;]+")
_WORDS = {2: "two", 3: "three", 4: "four"}


class BadNumber(ValueError):
    """Text that urdfdom does not accept as a number.

    Attributes:
        reason: the fault, worded to follow the attribute's text.
        hint: remedy.
        right: right value, where it is certain.
        in_xacro: remedy in a file of xacro, which calculates.
    """

    def __init__(
        self, reason: str, hint: str, right: str = "", in_xacro: str = ""
    ) -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = hint
        self.right = right
        self.in_xacro = in_xacro


class _Bad(NamedTuple):
    """The arguments of `BadNumber`."""

    reason: str
    hint: str
    right: str = ""
    in_xacro: str = ""


def _rather(reason: str, right: str) -> _Bad:
    return _Bad(reason, f'write "{right}"', right)


def read_number(text: str) -> float:
    """Return one finite number.

    Blanks around it are accepted, though urdfdom refuses them after a number: the
    caller warns (`has_blank_behind`).

    Raises:
        BadNumber: the text is not a number.
    """
    return _component(text.strip(" "), text)


def has_blank_behind(text: str) -> bool:
    """Return whether a single number ends with a blank, which urdfdom refuses."""
    return text != text.rstrip()


def read_numbers(text: str, count: int, name: str = "") -> tuple[float, ...]:
    """Return exactly `count` finite numbers, separated by blanks.

    Args:
        text: the numbers.
        count: required count.
        name: attribute that contains them, for the advice.

    Raises:
        BadNumber: the count differs, or a part is not a number.
    """
    parts = text.split()
    if "," in text or ";" in text:
        raise BadNumber(*_without_commas(text, count))
    numbers = tuple([_component(part, text) for part in parts])
    if len(numbers) != count:
        needed = _WORDS.get(count, str(count))
        have = f"has {len(parts)} number{'' if len(parts) == 1 else 's'}"
        hint = _filled_up(parts, count, name)
        is_one = name == "scale" and len(parts) == 1
        is_zero = parts and not any(part.strip("-0.") for part in parts)
        better = " ".join(parts[:1] * count) if is_one or is_zero else ""
        raise BadNumber(f"{have}, {needed} are needed", hint, better)
    return numbers


def _without_commas(text: str, count: int) -> _Bad:
    """Return the fault of commas, and the text without them.

    A comma between two digits is a decimal comma if only that gives the required count
    of numbers.
    """
    marks = "commas" if "," in text else "semicolons"
    cause = f"has {marks}; numbers are separated by blanks only"
    apart = _SEPARATORS.split(without_units(text).strip(" ,;"))
    if len(apart) == count:
        return _rather(cause, " ".join(apart))
    pointed = without_units(re.sub(r"(?<=\d),(?=\d)", ".", text))
    with_points = _SEPARATORS.split(pointed.strip(" ;,"))
    if len(with_points) == count:
        better = " ".join(with_points)
        return _rather("has a decimal comma; numbers have a point", better)
    return _Bad(cause, _filled_up(apart, count))


def _filled_up(parts: list[str], count: int, name: str = "") -> str:
    if not parts:
        return f"give {_WORDS.get(count, count)} numbers, or delete the attribute"
    if len(parts) == 1 and name == "rpy":
        return f'write rpy="{parts[0]} 0 0" to turn about x'
    if len(parts) == 1 and count == 3 and name != "xyz":
        return f'for the same value in all directions write "{" ".join(parts * 3)}"'
    return f"give {_WORDS.get(count, count)} numbers with blanks between them"


def _component(part: str, whole: str) -> float:
    if _NUMBER.fullmatch(part):
        value = float(part)
        if math.isfinite(value):
            return value
    raise BadNumber(*_complaint(part, whole))


def _complaint(part: str, whole: str) -> _Bad:
    if not part:
        return _Bad("is empty", "write a number")
    if "$" in part:
        return _Bad(
            f"still contains the expression {part}, {NOT_REPLACED}",
            "declare xmlns:xacro on <robot>, or write the number",
        )
    if part.lower().lstrip("+-") in ("nan", "inf", "infinity"):
        return _Bad(
            f"contains {part}, which is not a finite number", "write a finite number"
        )
    if is_with_unit(part):
        shown = whole.strip() if part.isalpha() or part == "°" else part
        return _rather(
            f"has a unit in {shown}; URDF knows only metres, radians and kilograms",
            without_units(whole.strip()),
        )
    if re.fullmatch(r"[+-]?[\d.]+(?:[eE][+-]?\d+)?[A-Za-z°]+", part):
        return _Bad(
            f"has a unit in {part}; URDF knows only metres and radians",
            "write the bare number",
        )
    if _EXPRESSION.search(part):
        calculated = re.sub(
            r"\S+",
            lambda one: f"${{{one[0]}}}" if _EXPRESSION.search(one[0]) else one[0],
            whole.strip(),
        )
        return _Bad(
            f"contains {part}, which is not a number: plain URDF cannot calculate",
            f'write the number{_value_of(part)}, or use xacro: "{calculated}"',
            in_xacro=calculated,
        )
    if re.fullmatch(r"[+-]?\d+,\d+", part) or is_with_unit(part.replace(",", ".", 1)):
        better = without_units(whole.strip().replace(",", "."))
        return _rather("has a decimal comma; numbers have a point", better)
    if re.fullmatch(r"\{[^{}]+\}", part):
        return _rather(
            f"contains {part}, which is not a number: a $ is missing before it",
            whole.replace(part, f"${part}"),
        )
    better = meant_number(part)
    if better is not None:
        reason = f"contains {part}, which is not a number"
        return _rather(reason, whole.strip().replace(part, better))
    return _Bad(f"contains {part}, which is not a number", "write a number such as 0.1")


def _value_of(part: str) -> str:
    match = re.fullmatch(r"([+-]?)(?:math\.|M_)?pi(?:/(\d+(?:\.\d+)?))?", part.lower())
    if match is None or (match[2] and float(match[2]) == 0):
        return ""
    value = math.pi / float(match[2] or 1)
    return f" {'-' if match[1] == '-' else ''}{value:.4f}"


def _text_inside(element: Element, name: str) -> str:
    """Return a value written as text, or in an element with the attribute's name."""
    child = element.find(name)
    text = element.text if child is None else child.text
    return " ".join(text.split())


Report = Callable[[str, str, "str | Fix", Element, "str | None"], None]
"""`ModelFindings.reject`, `.error` or `.warn`: code, text, hint, element, attribute."""

LARGEST = float(limits.NUMBER.value)
"""Pictures and poses cannot be computed with numbers beyond this: browsers have 32
bits, and poses multiply. Real files have limits of 1e16."""

_NOT_DRAWN = frozenset(
    "effort velocity damping friction k_position k_velocity rising falling".split()
)


class Unreadable(Exception):
    """An element that urdfdom cannot read; the problem has been reported."""


class AttributeReader(NamedTuple):
    """Reads the attributes of one joint or shape.

    Attributes:
        findings: receives problems.
        report: severity of a wrong number: `findings.reject` in a joint,
            `findings.error` in a link.
        owner: owner of the element, for messages ("joint wheel_joint").
        loss: consequence in ROS, for messages.
    """

    findings: ModelFindings
    report: Report
    owner: str
    loss: str

    def fail(
        self,
        code: str,
        message: str,
        hint: str | Fix,
        at: Element,
        name: str | None = None,
    ) -> Unreadable:
        """Report a problem, and return the exception to raise."""
        self.report(code, f"{message}; {self.loss}", hint, at, name)
        return Unreadable(message)

    def required(self, element: Element, name: str, example: str) -> str:
        """Return the attribute's text.

        Raises:
            Unreadable: the attribute is missing.
        """
        text = element.get(name)
        if text is None:
            inside = _text_inside(element, name)
            as_text = " but has its value as text, as in SDF" if inside else ""
            raise self.fail(
                "attribute-missing",
                f"<{element.tag}> of {self.owner} has no {name}{as_text}",
                f'write <{element.tag} {name}="{inside}"/>'
                if inside
                else f'write {name}="{example}"',
                element,
            )
        return text

    def number(self, element: Element, name: str, example: str = "1.0") -> float:
        """Read a required number.

        Raises:
            Unreadable: the attribute is missing or not a number.
        """
        text = self.required(element, name, example)
        try:
            value = read_number(text)
        except BadNumber as bad:
            raise self._bad(element, name, text, bad) from None
        if has_blank_behind(text):
            self.findings.warn(
                "number-with-blank",
                f'{name}="{text}" of {self.owner} ends with a blank, which ROS '
                "refuses in a single number",
                write_attribute(element.place, name, text, text.strip()),
                element,
                name,
            )
        return self._bounded(element, name, (value,))[0]

    def optional(self, element: Element, name: str, default: float) -> float:
        """Read a number, or return the default when the attribute is missing.

        Raises:
            Unreadable: the attribute is not a number.
        """
        return default if element.get(name) is None else self.number(element, name)

    def vector(self, element: Element, name: str, default: Vector3) -> Vector3:
        """Read three numbers, or return the default when the attribute is missing.

        Raises:
            Unreadable: the attribute does not contain three numbers.
        """
        text = element.get(name)
        if text is None:
            return default
        try:
            x, y, z = read_numbers(text, 3, name)
        except BadNumber as bad:
            raise self._bad(element, name, text, bad) from None
        if name in element.odd_blanks:
            self.findings.warn(
                "numbers-with-tab",
                f"{name} of {self.owner} has a tab or a line break between its "
                "numbers, which ROS refuses in a plain URDF",
                "separate the numbers with blanks",
                element,
                name,
            )
        x, y, z = self._bounded(element, name, (x, y, z))
        return (x, y, z)

    def origin(self, parent: Element) -> Origin:
        """Read the first <origin> below an element; the identity when there is none.

        Raises:
            Unreadable: its numbers are wrong.
        """
        found = parent.find_all("origin")
        if not found:
            return Origin()
        if len(found) > 1:
            self.findings.warn(
                "origin-twice",
                f"{self.owner} has more than one <origin>; only the first counts",
                "delete the others",
                found[1],
            )
        element = found[0]
        xyz = self.vector(element, "xyz", (0.0, 0.0, 0.0))
        rpy = self.vector(element, "rpy", (0.0, 0.0, 0.0))
        return Origin(xyz, rpy, element.place)

    def _bounded(
        self, element: Element, name: str, values: tuple[float, ...]
    ) -> tuple[float, ...]:
        """Return the numbers, each limited to the range that can be shown."""
        if name in _NOT_DRAWN or max(map(abs, values)) <= LARGEST:
            return values
        self.findings.warn(
            "number-too-large",
            f'{name}="{element.get(name)}" in <{element.tag}> of {self.owner} is '
            f"larger than anything that can be shown; {LARGEST:g} is taken instead",
            "write the number in metres or radians",
            element,
            name,
        )
        return tuple(min(max(v, -LARGEST), LARGEST) for v in values)

    def _bad(
        self, element: Element, name: str, text: str, bad: BadNumber
    ) -> Unreadable:
        if bad.in_xacro and self.findings.calculates:
            bad = BadNumber(
                f"{bad.reason.partition(':')[0]}: xacro calculates only in ${{…}}",
                f'write {name}="{bad.in_xacro}"',
                bad.in_xacro,
            )
        return self.fail(
            "number-malformed",
            f'{name}="{text}" in <{element.tag}> of {self.owner} {bad.reason}',
            write_attribute(element.place, name, text, bad.right, hint=bad.hint)
            if bad.right
            else bad.hint,
            element,
            name,
        )
