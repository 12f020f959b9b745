"""Problems of a URDF, collected while it is read to the end."""

from __future__ import annotations

from sambot_viz.errors import Findings, Place, Severity
from sambot_viz.robot.xml.element import Element


class UrdfFindings(Findings):
    """Problems at elements, and whether ROS would refuse the model.

    Attributes:
        rejected: whether urdfdom refuses the whole model.
    """

    def __init__(self) -> None:
        super().__init__()
        self.rejected = False

    def reject(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
        *,
        cause: str | None = None,
    ) -> None:
        """Report an error for which ROS refuses the whole model."""
        self.rejected = True
        self._add("error", code, message, hint, at, attribute, cause)

    def error(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
        *,
        cause: str | None = None,
    ) -> None:
        """Report an error that ROS does not, or that affects only part of the robot."""
        self._add("error", code, message, hint, at, attribute, cause)

    def warn(
        self,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None = None,
        *,
        cause: str | None = None,
    ) -> None:
        """Report a doubtful part of the model, which is drawn anyway."""
        self._add("warning", code, message, hint, at, attribute, cause)

    def _add(
        self,
        severity: Severity,
        code: str,
        message: str,
        hint: str,
        at: Element,
        attribute: str | None,
        cause: str | None,
    ) -> None:
        if at.call is not None:
            here = at.call.file == at.place.file
            where = f"line {at.call.line}" if here else f"{at.call.file}:{at.call.line}"
            message = f"{message}, from the macro call on {where}"
        line = at.line_of(attribute)
        column = at.place.column if line == at.place.line else None
        place = Place(at.place.file, line, column)
        self.add(severity, code, message, hint, place, cause=cause)


def tag_text(element: Element) -> str:
    """Name an element for a message: ``<link name="arm">`` or ``<axis>``."""
    name = element.get("name")
    return f'<{element.tag} name="{name}">' if name else f"<{element.tag}>"
