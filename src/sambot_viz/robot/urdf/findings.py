"""Collecting what is wrong with a model while it is read to the end."""

from __future__ import annotations

from sambot_viz.errors import Problem, Severity
from sambot_viz.robot.xml.parse import Element

_LONGEST = 2000


class Findings:
    """Problems with places, and whether ROS would refuse the model.

    Attributes:
        problems: in the order found.
        rejected: True when urdfdom refuses the whole model
            (spec/ros-nodes.md §6.1, level 1).
    """

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self.rejected = False

    def reject(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
    ) -> None:
        """An error for which ROS refuses the whole model."""
        self.rejected = True
        self._add("error", code, message, hint, at, attribute)

    def error(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
    ) -> None:
        """An error that ROS does not see, or that costs only a part of the robot."""
        self._add("error", code, message, hint, at, attribute)

    def warn(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
    ) -> None:
        """Something doubtful that is drawn all the same."""
        self._add("warning", code, message, hint, at, attribute)

    def info(self, code: str, message: str, hint: str, at: Element) -> None:
        """Something worth knowing."""
        self._add("info", code, message, hint, at, None)

    def _add(
        self,
        severity: Severity,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None,
    ) -> None:
        if at.call is not None:
            here = at.call_file in (None, at.place.file)
            where = f"line {at.call}" if here else f"{at.call_file}:{at.call}"
            message = f"{message}, from the macro call on {where}"
        line = at.line_of(attribute)
        column = at.place.column if line == at.place.line else None
        file = at.place.file
        message, hint = _cut(message), _cut(hint)
        problem = Problem(severity, code, message, hint, file, line, column)
        if problem not in self.problems:
            self.problems.append(problem)


def _cut(text: str) -> str:
    """A sentence that a terminal can hold, whatever names a file makes up."""
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "…"


def tag_text(element: Element) -> str:
    """The element as a reader recognises it: ``<link name="arm">`` or ``<axis>``."""
    name = element.get("name")
    return f'<{element.tag} name="{name}">' if name else f"<{element.tag}>"
