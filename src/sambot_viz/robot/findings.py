"""Problems of a model, collected up to the end of the file."""

from __future__ import annotations

from sambot_viz.errors import Findings, Fix, Place, Severity
from sambot_viz.robot.xml.element import Element


# The type checker infers the return type: `Callable` cannot express keywords.
def _reporter(severity: Severity, rejects: bool = False):
    """Return a method of `ModelFindings` that reports a problem at an element."""

    def report(
        self: ModelFindings,
        code: str,
        message: str,
        hint: str | Fix,
        at: Element,
        attribute: str | None = None,
        *,
        cause: str | None = None,
    ) -> None:
        self.rejected |= rejects
        line = at.line_of(attribute)
        column = at.place.column if line == at.place.line else None
        place = Place(at.place.file, line, column)
        said = hint.hint if isinstance(hint, Fix) else hint
        if self.is_said(code, said, place, at.call):
            return
        if at.call is not None:
            here = at.call.file == at.place.file
            where = f"line {at.call.line}" if here else f"{at.call.file}:{at.call.line}"
            message = f"{message}, from the macro call on {where}"
        self.add(severity, code, message, hint, place, cause=cause)

    return report


class ModelFindings(Findings):
    """Problems at elements, and whether ROS would refuse the model.

    Attributes:
        rejected: whether ROS refuses the whole model.
        calculates: whether the model comes from xacro, which calculates.
        reject: reports an error for which ROS refuses the whole model.
        error: reports an error that ROS accepts, or that affects only a part.
        warn: reports a doubtful part of the model, which is still drawn.
        remark: reports a useful fact.
    """

    def __init__(self, calculates: bool = False) -> None:
        super().__init__()
        self.rejected = False
        self.calculates = calculates
        self._calls: dict[tuple[str, str, Place], Place | None] = {}

    def is_said(self, code: str, hint: str, place: Place, call: Place | None) -> bool:
        """Return whether an earlier call of a macro had the same problem and advice."""
        return self._calls.setdefault((code, hint, place), call) != call

    reject = _reporter("error", rejects=True)
    error = _reporter("error")
    warn = _reporter("warning")
    remark = _reporter("info")


def tag_text(element: Element) -> str:
    """Name an element for a message: ``<link name="arm">`` or ``<axis>``."""
    name = element.get("name")
    return f'<{element.tag} name="{name}">' if name else f"<{element.tag}>"
