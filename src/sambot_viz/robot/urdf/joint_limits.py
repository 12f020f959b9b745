"""The limits of a joint, and its elements that only need to be valid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Dynamics, JointType, Limit, SoftLimit
from sambot_viz.robot.slips.wheel_names import rolls
from sambot_viz.robot.urdf.attributes import AttributeReader, Unreadable
from sambot_viz.robot.xml.element import Element

_REFUSED = "ROS refuses the model"
_RANGES: Mapping[str, tuple[float, float, float]] = {
    "revolute": (-1.57, 1.57, 1.0),
    "prismatic": (0.0, 0.1, 0.1),
}
"""Type of joint → usual ends of a range, and a step beyond an end [rad or m]."""


def _example(kind: str, missing: Sequence[str], limit: Limit) -> str:
    """Write the missing ends of a range, below or above the existing end."""
    least, most, step = _RANGES[kind]
    lower = least if "upper" in missing else min(least, limit.upper - step)
    upper = most if "lower" in missing else max(most, limit.lower + step)
    return " ".join(f'{n}="{lower if n == "lower" else upper:g}"' for n in missing)


class LimitReader:
    """Reads <limit>, <safety_controller>, <dynamics> and <calibration> of one joint.

    It refuses what urdfdom refuses.
    """

    def __init__(
        self,
        element: Element,
        name: str,
        kind: JointType,
        reader: AttributeReader,
        findings: ModelFindings,
    ) -> None:
        self._element = element
        self._name = name
        self._kind = kind
        self._reader = reader
        self._findings = findings

    def limit(self) -> Limit | None:
        """Read the <limit>; None when there is none."""
        element = self._element.find("limit")
        if element is None:
            if self._kind in ("revolute", "prismatic"):
                self._report_no_limit()
            return None
        missing = [n for n in ("effort", "velocity") if element.get(n) is None]
        if missing:
            self._report_incomplete(element, missing)
        try:
            limit = Limit(
                self._reader.optional(element, "lower", 0.0),
                self._reader.optional(element, "upper", 0.0),
                self._reader.optional(element, "effort", 0.0),
                self._reader.optional(element, "velocity", 0.0),
                element.place,
            )
        except Unreadable:
            return Limit()
        if self._kind in ("revolute", "prismatic"):
            self._check_range(element, limit)
        return limit

    def _report_no_limit(self) -> None:
        unit = "radians" if self._kind == "revolute" else "metres"
        ends = _example(self._kind, ("lower", "upper"), Limit())
        child = self._element.find("child")
        link = (child.get("link") if child else None) or ""
        if rolls(self._name, link):
            self._findings.reject(
                "limit-missing",
                f"joint {self._name} is {self._kind} and has no <limit>, as a wheel "
                f"has none that turns without end; {_REFUSED}",
                'write type="continuous"',
                self._element,
            )
            return
        other = ", or make the joint continuous" if self._kind == "revolute" else ""
        self._findings.reject(
            "limit-missing",
            f"joint {self._name} is {self._kind} and has no <limit>; {_REFUSED}",
            f'add <limit {ends} effort="10" velocity="1"/> with lower and upper in '
            f"{unit}{other}",
            self._element,
        )

    def _report_incomplete(self, element: Element, missing: list[str]) -> None:
        names = " and ".join(missing)
        add = " ".join(f'{n}="{10 if n == "effort" else 1}"' for n in missing)
        even = (
            ""
            if self._kind in ("revolute", "prismatic")
            else (f", even on a {self._kind} joint")
        )
        self._findings.reject(
            "limit-incomplete",
            f"<limit> of joint {self._name} has no {names}; {_REFUSED}{even}",
            f"add {add}" + (", or delete <limit>" if even else ""),
            element,
        )

    def _check_range(self, element: Element, limit: Limit) -> None:
        missing = [n for n in ("lower", "upper") if element.get(n) is None]
        if missing:
            names = " and no ".join(missing)
            self._findings.warn(
                "limit-without-range",
                f"<limit> of joint {self._name} has no {names}: urdfdom takes 0, so "
                f"the range is {limit.lower:g} to {limit.upper:g}; "
                "joint_state_publisher leaves the joint out, so RViz has no transform "
                "for its link",
                f"add {_example(self._kind, missing, limit)}",
                element,
            )
        elif limit.lower > limit.upper:
            self._findings.warn(
                "limit-reversed",
                f"joint {self._name} has lower ({limit.lower:g}) greater than upper "
                f"({limit.upper:g})",
                "exchange the two",
                element,
                "lower",
            )

    def soft_limit(self) -> SoftLimit | None:
        """Read the soft limits of <safety_controller>; None when there is none."""
        element = self._element.find("safety_controller")
        if element is None:
            return None
        if element.get("k_velocity") is None:
            self._findings.reject(
                "safety-controller-incomplete",
                f"<safety_controller> of joint {self._name} has no k_velocity; "
                f"{_REFUSED}",
                'add k_velocity="10"',
                element,
            )
        try:
            for name in ("k_position", "k_velocity"):
                self._reader.optional(element, name, 0.0)
            return SoftLimit(
                self._soft(element, "soft_lower_limit"),
                self._soft(element, "soft_upper_limit"),
            )
        except Unreadable:
            return None

    def _soft(self, element: Element, name: str) -> float | None:
        if element.get(name) is None:
            return None
        return self._reader.number(element, name)

    def dynamics(self) -> Dynamics | None:
        """Read the <dynamics>; None when there is none."""
        element = self._element.find("dynamics")
        if element is None:
            return None
        if element.get("damping") is None and element.get("friction") is None:
            self._findings.reject(
                "dynamics-empty",
                f"<dynamics> of joint {self._name} has neither damping nor friction; "
                f"{_REFUSED}",
                "delete it, or give one of the two",
                element,
            )
        damping, friction = self._numbers(element, ("damping", "friction"))
        return Dynamics(damping, friction)

    def check_calibration(self) -> None:
        """Report a <calibration> that ROS refuses; discard its numbers."""
        element = self._element.find("calibration")
        if element is not None:
            self._numbers(element, ("rising", "falling"))

    def _numbers(self, element: Element, names: tuple[str, ...]) -> list[float]:
        """Read numbers; a wrong one is reported and becomes 0."""
        numbers: list[float] = []
        for name in names:
            try:
                numbers.append(self._reader.optional(element, name, 0.0))
            except Unreadable:
                numbers.append(0.0)
        return numbers
