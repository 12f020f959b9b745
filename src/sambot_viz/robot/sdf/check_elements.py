"""Check every element that libsdformat knows: attributes, values, unknown names.

libsdformat reads the whole file by a table before it interprets it. So a wrong number
in a sensor makes it refuse the robot, while it only drops an unknown element.
"""

from __future__ import annotations

import re

from sambot_viz.edits import write_behind
from sambot_viz.errors import Fix, did_you_mean
from sambot_viz.robot.findings import ModelFindings, tag_text
from sambot_viz.robot.sdf import values
from sambot_viz.robot.sdf.elements import (
    ElementType,
    Values,
    meant_word,
    model_type,
)
from sambot_viz.robot.sdf.gazebo_only import is_for_gazebo
from sambot_viz.robot.sdf.habits import (
    attributes_of_urdf,
    element_of_urdf,
    says_more_inside,
)
from sambot_viz.robot.sdf.loose_text import text_not_read
from sambot_viz.robot.sdf.misplaced import advised_place
from sambot_viz.robot.sdf.missing_values import check_left_out, is_needed
from sambot_viz.robot.sdf.old_versions import Version
from sambot_viz.robot.sdf.values import BadValue, trimmed
from sambot_viz.robot.sdf.wording import REFUSED, described
from sambot_viz.robot.slips.exchanged_words import exchanged
from sambot_viz.robot.slips.units import without_units
from sambot_viz.robot.xml.element import Element

_PLAIN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?", re.IGNORECASE)


_OF_WORLD = ("sun", "ground_plane")
"""Models that Gazebo's worlds include, and robots do not."""


def check_elements(model: Element, version: Version, findings: ModelFindings) -> None:
    """Report what libsdformat refuses or loses in a <model>, in document order.

    Args:
        model: the <model>.
        version: version of the file; older ones have a few other names.
        findings: receives the problems.
    """
    _ElementChecker(version, findings).check(model)


class _ElementChecker:
    def __init__(self, version: Version, findings: ModelFindings) -> None:
        self._version = version
        self._findings = findings

    def check(self, model: Element) -> None:
        stack = [(model, model_type(), False)]
        while stack:
            element, known, quiet = stack.pop()
            quiet = quiet or is_for_gazebo(element)
            read_as_urdf = self._check_attributes(element, known, quiet)
            if known.text.kind and not read_as_urdf:
                self._check_text(element, known.text)
            elif not known.text.kind and not known.open and not quiet:
                self._check_loose_text(element)
                check_left_out(element, known, self._findings)
            if known.open:
                continue
            inside: list[tuple[Element, ElementType, bool]] = []
            for child in element.children:
                if child.tag == "include":
                    self._refuse_include(child)
                elif (child_type := known.children.get(child.tag)) is not None:
                    inside.append((child, child_type, quiet))
                elif not quiet:
                    self._report_unknown(child, known)
            stack.extend(reversed(inside))

    def _check_attributes(
        self, element: Element, known: ElementType, quiet: bool
    ) -> bool:
        """Check the attributes; return whether they hold the values of the text."""
        unknown: list[str] = []
        for name, text in element.attributes.items():
            wanted = known.attributes.get(name)
            if wanted is not None:
                self._check_attribute(element, name, text, wanted)
            elif ":" not in name and not self._version.knows(element, name):
                unknown.append(name)
        for name, wanted in known.attributes.items():
            if wanted.required and element.get(name) is None:
                self._report_missing(element, name)
        if not unknown or quiet or says_more_inside(element):
            return False
        return self._report_attributes(element, known, unknown)

    def _check_attribute(
        self, element: Element, name: str, text: str, wanted: Values
    ) -> None:
        shown = f'{name}="{text}" of {tag_text(element)}'
        if wanted.required and not trimmed(text):
            self._findings.reject(
                "sdf-attribute-empty",
                f"{shown} in {described(element)} is empty; {REFUSED}",
                f'write {name}="…"',
                element,
                name,
            )
            return
        try:
            _check_value(text, wanted)
        except BadValue as bad:
            better = f'write {name}="{bad.right}"' if bad.right else bad.hint
            self._findings.reject(
                "sdf-value",
                f"{shown} in {described(element)} {bad.reason}; {REFUSED}",
                exchanged(element, name, wanted.words) or better,
                element,
                name,
            )
        self._note_default(element, f"{shown} in {described(element)}", text, wanted)

    def _note_default(
        self, element: Element, shown: str, text: str, wanted: Values
    ) -> None:
        """Note a word that libsdformat replaces by the first known one."""
        near = _unlike(trimmed(text), wanted)
        if wanted.lenient and trimmed(text) and near:
            self._findings.remark(
                "sdf-value-default",
                f"{shown} is not known ({near}); it is taken for {wanted.words[0]}",
                f"write one of {', '.join(wanted.words)}",
                element,
            )

    def _report_missing(self, element: Element, name: str) -> None:
        message, hint = f"this <{element.tag}> has no {name}", f'write {name}="…"'
        if name == "name":
            message += f"; in SDF every <{element.tag}> needs one"
            hint = f'write <{element.tag} name="…">'
            parent = element.parent.get("name") if element.parent else None
            if parent and element.tag in ("visual", "collision"):
                hint = f'write <{element.tag} name="{parent}_{element.tag}">'
                message += ", unique in its link"
        elif name == "type" and element.tag == "joint":
            message = f"joint {element.get('name')} has no type"
            hint = 'write type="fixed", "revolute" or "continuous"'
        self._findings.reject(
            "attribute-missing", f"{message}; {REFUSED}", hint, element
        )

    def _report_attributes(
        self, element: Element, known: ElementType, unknown: list[str]
    ) -> bool:
        habit = attributes_of_urdf(element, unknown)
        if habit is not None:
            report = self._findings.reject if habit.refused else self._findings.warn
            report("sdf-urdf-habit", habit.message, habit.hint, element, unknown[0])
            return habit.refused
        for name in unknown:
            near = did_you_mean(name, known.attributes)
            self._findings.warn(
                "sdf-attribute-unknown",
                f"SDF knows no attribute {name} of <{element.tag}> ({near}); ROS "
                "ignores it",
                f"delete {name}",
                element,
                name,
            )
        return False

    def _check_text(self, element: Element, wanted: Values) -> None:
        text = trimmed(element.text)
        shown = f"<{element.tag}>{_short(text)}</{element.tag}> of {described(element)}"
        if not text and wanted.required:
            self._findings.reject(
                "sdf-value",
                f"<{element.tag}> of {described(element)} is empty; {REFUSED}",
                "write a value into it"
                + ("" if is_needed(element) else f", or delete <{element.tag}>"),
                element,
            )
            return
        try:
            ignored = text and _check_content(element, text, wanted)
        except BadValue as bad:
            bad = _without_units(element, text, wanted) or bad
            added = write_behind(element.place, bad.added) if bad.added else ()
            hint = Fix(f"write {text}{bad.added}", added) if added else bad.hint
            self._findings.reject(
                "sdf-value", f"{shown} {bad.reason}; {REFUSED}", hint, element
            )
            return
        if ignored:
            self._report_ignored(element, shown, text, wanted)
        self._note_default(element, shown, text, wanted)

    def _check_loose_text(self, element: Element) -> None:
        """Warn of a text that belongs in an element of that name."""
        if element.tag == "script" or (
            element.tag == "geometry" and not element.children
        ):
            # It is refused, with the same advice.
            return
        habit = text_not_read(element)
        if habit is not None:
            self._findings.warn("sdf-text-not-read", habit.message, habit.hint, element)

    def _report_ignored(
        self, element: Element, shown: str, text: str, wanted: Values
    ) -> None:
        better = _with_numbers(element, text, wanted)
        hint = f"write {better}" if better != text else "write nothing but numbers"
        start = values.read_number(text.split()[0])
        self._findings.warn(
            "sdf-number-cut-off",
            f"{shown}: ROS reads the start of a number and ignores the rest, so this "
            f"is {start.value:g}"
            if len(text.split()) == 1
            else f"{shown}: ROS reads the start of each number and ignores the rest",
            hint,
            element,
        )

    def _report_unknown(self, element: Element, parent: ElementType) -> None:
        if element.tag == "sensor" and parent.name == "model":
            self._findings.warn(
                "sdf-element-unknown",
                f"{tag_text(element)} is directly in <model>, where Gazebo ignores it: "
                "a sensor belongs to the link that carries it",
                "move it into a <link>",
                element,
            )
            return
        if ":" in element.tag or is_for_gazebo(element):
            return
        if self._version.knows_element(element):
            return
        habit = element_of_urdf(element)
        if habit is not None:
            report = self._findings.reject if habit.refused else self._findings.warn
            report("sdf-urdf-habit", habit.message, habit.hint, element)
            return
        near, tag = did_you_mean(element.tag, parent.children), f"<{element.tag}>"
        self._findings.warn(
            "sdf-element-unknown",
            f"SDF knows no {tag} in <{parent.name}> ({near}); ROS ignores it and all "
            "that is in it",
            advised_place(element)
            or f"delete {tag}, or write what it is meant to say as SDF has it",
            element,
        )

    def _refuse_include(self, element: Element) -> None:
        uri = element.find("uri")
        name = trimmed(uri.text) if uri is not None else ""
        self._findings.reject(
            "sdf-include",
            f"robot_state_publisher does not find the model {name or 'of <include>'}: "
            "it knows no place where models of Gazebo are, and does not take "
            f"package:// here; {REFUSED}",
            "delete it: it belongs to the world"
            if name.rpartition("/")[2].lower().replace(" ", "_") in _OF_WORLD
            else "copy the links and joints of that model into this file, or write "
            "them in a xacro file and use <xacro:include filename=…/>",
            element,
        )


def _check_value(text: str, wanted: Values) -> bool:
    """Check a text that is not empty; return whether ROS ignores a part of it.

    Raises:
        BadValue: libsdformat refuses the text.
    """
    text = trimmed(text)
    if not text:
        return False
    match wanted.kind:
        case "number":
            number = values.read_number(text)
            _check_range(number.value, wanted)
            return number.ignored != ""
        case "int" | "uint":
            number = values.read_integer(text, wanted.kind == "int")
            _check_range(number.value, wanted)
            return re.fullmatch(r"(\.0*)?", number.ignored) is None
        case "boolean":
            values.read_boolean(text)
        case "color":
            values.read_colour(text)
        case "vector2" | "vector3":
            count = int(wanted.kind[-1])
            values.read_vector(text, count)
            words = values.words_of(text)
            return len(words) != count or _PLAIN.fullmatch(words[-1]) is None
        case _:
            _check_word(text, wanted)
    return False


def _check_content(element: Element, text: str, wanted: Values) -> bool:
    """Check the text of an element as `_check_value` does."""
    if wanted.kind == "pose":
        return _check_pose(element, text)
    return _check_value(text, wanted)


def _without_units(element: Element, text: str, wanted: Values) -> BadValue | None:
    """Explain numbers with units; None when there are none."""
    plain = without_units(text, degrees=_in_degrees(element))
    if wanted.kind in ("string", "") or plain == text:
        return None
    try:
        _check_content(element, plain, wanted)
    except BadValue as bad:
        return bad
    reason = "has a unit; SDF knows only metres, radians and kilograms"
    return BadValue(reason, f"write {plain}")


def _with_numbers(element: Element, text: str, wanted: Values) -> str:
    """Return a text whose numbers read as a whole."""
    better = re.sub(r"(?<=\d),(?=\d)", ".", text)
    better = without_units(better, degrees=_in_degrees(element))
    better = re.sub(r"(?<=[\d.])(?![eE][-+]?\d)[^\d\s.,+-]+", "", better)
    better = " ".join(w for w in better.split() if re.search(r"\d", w))
    if wanted.kind in ("vector2", "vector3"):
        better = " ".join(better.split()[: int(wanted.kind[-1])])
    return better


def value_fault(element: Element, wanted: Values) -> BadValue | None:
    """Return why libsdformat refuses the text of an element, or ignores a part.

    Args:
        element: the element, also in the <gazebo> of a URDF.
        wanted: valid values of its text.
    """
    text = trimmed(element.text)
    try:
        if text and _check_content(element, text, wanted):
            better = _with_numbers(element, text, wanted)
            return BadValue("is read up to the first letter or comma", "", better)
    except BadValue as bad:
        return _without_units(element, text, wanted) or bad
    return None


def _in_degrees(element: Element) -> bool:
    return trimmed(element.get("degrees") or "").lower() in ("true", "1")


def _check_pose(element: Element, text: str) -> bool:
    degrees = _in_degrees(element)
    rotation_format = trimmed(element.get("rotation_format") or "") or "euler_rpy"
    return values.read_pose(text, degrees, rotation_format).ignored


def _check_range(number: float, wanted: Values) -> None:
    if number < wanted.low:
        raise BadValue(f"is less than {wanted.low:g}", f"write {wanted.low:g} or more")
    if number > wanted.high:
        raise BadValue(
            f"is more than {wanted.high:g}", f"write {wanted.high:g} or less"
        )


def _check_word(text: str, wanted: Values) -> None:
    near = "" if wanted.lenient else _unlike(text, wanted)
    if near:
        words = ", ".join(wanted.words)
        right = meant_word(text, wanted) or ""
        hint = f"write {right}" if right else f"write one of {words}"
        raise BadValue(f"is not known ({near})", hint, right)


def _unlike(text: str, wanted: Values) -> str:
    """Return the known or similar words for an unknown text; otherwise ""."""
    word = text.lower() if wanted.any_case else text
    if not wanted.words or word in wanted.words:
        return ""
    return did_you_mean(word, wanted.words)


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:60]}…"
