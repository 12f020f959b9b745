"""Reports repeated names; most often two macro calls are the same."""

from __future__ import annotations

from sambot_viz.errors import Place
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.wording import REFUSED
from sambot_viz.robot.xml.element import Element

_SIDES = (
    ("left", "right"),
    ("front", "rear"),
    ("front", "back"),
    ("upper", "lower"),
    ("l", "r"),
)


def report_repeated(
    name: str,
    element: Element,
    first: Element,
    written: Element,
    findings: ModelFindings,
) -> None:
    """Report a name that another element already has.

    Args:
        name: the name.
        element: element that repeats it.
        first: element that has it rightly.
        written: root of the document before xacro.
        findings: receives the problem.
    """
    what = f"{element.tag} {name}"
    if element.tag != first.tag:
        findings.reject(
            "sdf-name-taken",
            f"the {what} has the name of the {first.tag} on line {first.place.line}: "
            "links, joints, frames and nested models of a model must have different "
            f"names; {REFUSED}",
            f"write {name}_{element.tag}, here and {_use_of(name, first)}",
            element,
            "name",
        )
    elif (
        element.call is not None
        and element.call != first.call
        and not _is_fixed(element, first, written)
    ):
        _report_call(what, element.call, first, written, findings)
    else:
        findings.reject(
            "sdf-name-taken",
            f"the {what} is there on line {first.place.line} and again here; names "
            f"must be unique, and {REFUSED}",
            "give one of the two another name",
            element,
            "name",
        )


def _is_fixed(element: Element, first: Element, written: Element) -> bool:
    """Return whether a macro's body contains the name without a parameter."""
    return element.place == first.place and any(
        other.place == element.place and "${" not in (other.get("name") or "${")
        for other in written.iter()
    )


def _use_of(name: str, link: Element) -> str:
    """Describe the use of the other element's name: most often by the link."""
    pose = link.find("pose")
    if pose is None or pose.get("relative_to") != name:
        return "where it is used"
    return f"in relative_to of {link.tag} {name} (line {pose.line_of('relative_to')})"


def _report_call(
    what: str, call: Place, first: Element, written: Element, findings: ModelFindings
) -> None:
    """Report a macro call that repeats the result of another call."""
    earlier = first.call or first.place
    other = _other_argument(what, _at(call, written), _at(earlier, written))
    findings.add(
        "error",
        "sdf-name-taken",
        f"this call of the macro makes the {what} again, which line {earlier.line} "
        f"makes already; names must be unique, and {REFUSED}",
        other or "give the macro other arguments, so that the name is another",
        call,
    )
    findings.rejected = True


def _at(call: Place, written: Element) -> Element | None:
    """Return the macro call at a place, or None when it is in another file."""
    return next(
        (
            element
            for element in written.iter()
            if (element.place.file, element.place.line) == (call.file, call.line)
            and element.tag.startswith("xacro:")
        ),
        None,
    )


def _other_argument(
    what: str, call: Element | None, earlier: Element | None
) -> str | None:
    """Return the argument to change, with the other side of the robot, or None."""
    if call is None or earlier is None:
        return None
    for name, value in call.attributes.items():
        if not value or value not in what or earlier.get(name) != value:
            continue
        for one, two in (*_SIDES, *(pair[::-1] for pair in _SIDES)):
            if value == one or f"_{one}" in value or f"{one}_" in value:
                return f'write {name}="{value.replace(one, two, 1)}"'
        return f'write another {name} than "{value}"'
    return None
