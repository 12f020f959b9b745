"""Read attributes with urdfdom's rules and report what is wrong with them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.geometry import Vector3
from sambot_viz.robot.parts import Origin
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.urdf.numbers import (
    BadNumber,
    has_blank_behind,
    read_number,
    read_numbers,
)
from sambot_viz.robot.xml.element import Element

Report = Callable[[str, str, str, Element, "str | None"], None]
"""`UrdfFindings.reject`, `.error` or `.warn`: code, text, hint, element, attribute."""

LARGEST = 1e18
"""Numbers beyond this leave the range in which pictures and poses can be computed:
browsers have 32 bits, and poses multiply. Real files have limits of 1e16."""

_NOT_DRAWN = frozenset(
    "effort velocity damping friction k_position k_velocity rising falling".split()
)


class Unreadable(Exception):
    """An element that urdfdom cannot read; the problem has been reported."""


@dataclass(frozen=True, slots=True)
class AttributeReader:
    """Reads the attributes of one joint or shape.

    Attributes:
        findings: where problems go.
        report: how grave a wrong number is here: `findings.reject` in a joint,
            `findings.error` in a link.
        owner: whose element it is, for messages ("joint wheel_joint").
        loss: what ROS does about it, for messages.
    """

    findings: UrdfFindings
    report: Report
    owner: str
    loss: str

    def fail(
        self, code: str, message: str, hint: str, at: Element, name: str | None = None
    ) -> Unreadable:
        """Report and give the exception to raise."""
        self.report(code, f"{message}; {self.loss}", hint, at, name)
        return Unreadable(message)

    def required(self, element: Element, name: str, example: str) -> str:
        """Return the attribute's text.

        Raises:
            Unreadable: it is absent.
        """
        text = element.get(name)
        if text is None:
            raise self.fail(
                "attribute-missing",
                f"<{element.tag}> of {self.owner} has no {name}",
                f'write {name}="{example}"',
                element,
            )
        return text

    def number(self, element: Element, name: str, example: str = "1.0") -> float:
        """Read a required number.

        Raises:
            Unreadable: it is absent or no number.
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
                f'write {name}="{text.strip()}"',
                element,
                name,
            )
        return self._bounded(element, name, (value,))[0]

    def optional(self, element: Element, name: str, default: float) -> float:
        """Read a number, or return the default when the attribute is absent.

        Raises:
            Unreadable: it is not a number.
        """
        return default if element.get(name) is None else self.number(element, name)

    def vector(self, element: Element, name: str, default: Vector3) -> Vector3:
        """Three numbers, or the default when the attribute is absent.

        Raises:
            Unreadable: they are not three numbers.
        """
        text = element.get(name)
        if text is None:
            return default
        try:
            x, y, z = read_numbers(text, 3)
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
        """The numbers, each brought into the range that can be shown."""
        if name in _NOT_DRAWN or all(-LARGEST <= v <= LARGEST for v in values):
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
        return self.fail(
            "number-malformed",
            f'{name}="{text}" in <{element.tag}> of {self.owner} {bad.reason}',
            bad.hint,
            element,
            name,
        )
