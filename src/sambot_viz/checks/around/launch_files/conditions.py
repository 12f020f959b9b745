"""Report conditions of launch files that are neither true nor false."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.launch_files.names import bound_names, with_import
from sambot_viz.checks.around.launch_files.substitutions import substitution_in
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.place import key_place, rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_TRUTH = frozenset({"true", "false", "1", "0"})
_OPPOSITE = {"IfCondition": "UnlessCondition", "UnlessCondition": "IfCondition"}
_ATTRIBUTES = {"if": "unless", "unless": "if"}
_COMPARED = re.compile(r"(==|!=|is|is not)\s*(['\"]?)(\w+)\2")
_NEGATED = frozenset({"not", "!"})


class _Condition(NamedTuple):
    """A condition that puts texts and substitutions together.

    Attributes:
        name: IfCondition or if, or the opposite.
        parts: its texts, and its substitutions as they are written; True for a text.
        place: of the condition.
        fix: returns the fix that writes another substitution, negated or not.
        compared: writes a comparison of a substitution with a text.
    """

    name: str
    parts: list[tuple[str, bool]]
    place: Place
    fix: Callable[[str, bool], Fix]
    compared: Callable[[str, str], str]


def joined_conditions(around: Surroundings) -> Iterator[Problem]:
    """Report conditions with an operator, which launch does not compute."""
    for launch in around.launches:
        for call in launch.called(*_OPPOSITE):
            found = _in_call(call, launch)
            if found is not None:
                yield from _not_computed(found)
    for root in (root for package in around.packages for root in package.frontends):
        for element in root.iter():
            for name in _ATTRIBUTES:
                if element.get(name) is not None:
                    yield from _not_computed(_in_element(element, name))


def _in_call(call: Call, launch: LaunchFile) -> _Condition | None:
    given = call.given("predicate_expression", 0)
    # A single text has another rule.
    if not isinstance(given, ast.List):
        return None
    parts: list[tuple[str, bool]] = []
    for node in given.elts:
        is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
        text = str(node.value) if isinstance(node, ast.Constant) else ast.unparse(node)
        parts.append((text, is_text))

    def fix(right: str, is_negated: bool) -> Fix:
        if not is_negated:
            return rewritten(given, launch.shown, right)
        name = _OPPOSITE[call.name]
        whole, hint = f"{name}({right})", f"write {name}({right})"
        if name in bound_names(launch.tree):
            return rewritten(call.node, launch.shown, whole)
        return Fix(with_import(hint, name, launch))

    def compared(source: str, test: str) -> str:
        return f'PythonExpression(["\'", {source}, "\' {test}"])'

    return _Condition(call.name, parts, launch.place(given), fix, compared)


def _in_element(element: Element, name: str) -> _Condition:
    # Import late: many packages have Python launch files only.
    from sambot_viz.checks.around.launching.frontend_reader import written_parts

    written, place = element.get(name) or "", element.place
    is_xml = not place.file.endswith((".yaml", ".yml"))
    there = place if is_xml else key_place(place, name)

    def fix(right: str, is_negated: bool) -> Fix:
        other = _ATTRIBUTES[name] if is_negated else name
        hint = f'write {other}{"=" if is_xml else ": "}"{right}"'
        if is_negated:
            return Fix(hint)
        if is_xml:
            return write_attribute(place, name, written, right, hint=hint)
        return write(there, written, right, hint=hint)

    def compared(source: str, test: str) -> str:
        quoted = test.replace("'", "\\'")
        return f"$(eval '\\'{source}\\' {quoted}')"

    return _Condition(name, written_parts(written), there, fix, compared)


def _not_computed(one: _Condition) -> Iterator[Problem]:
    texts = [text for text, is_text in one.parts if is_text]
    others = [text for text, is_text in one.parts if not is_text]
    plain = "".join(texts).strip()
    if not plain or any(plain.lower() in word for word in _TRUTH):
        return
    shown = "".join(text for text, _ in one.parts).strip()
    cause = f"the condition {shown} puts texts together, and launch computes nothing"
    if not others:
        cause = f"the condition {plain} is the text itself"
    yield Problem.at(
        one.place,
        "error",
        _CODE,
        f"{cause}: it is neither true nor false, and {_STOPS}",
        _right(one, plain, others),
    )


def _right(one: _Condition, plain: str, others: list[str]) -> Fix:
    """Return the fix that tests the only substitution."""
    found = _COMPARED.fullmatch(plain)
    if not others and plain.isidentifier():
        right = f"$(var {plain})"
        meant = flag(plain)
        near = nearest(plain.lower(), ("true", "false"), 0.5)
        return one.fix(near or right if meant is None else str(meant).lower(), False)
    if len(others) != 1 or (found is None and plain not in _NEGATED):
        name = "PythonExpression" if one.name in _OPPOSITE else "$(eval …)"
        return Fix(f"write it in {name}, which computes expressions of Python")
    if found is None:
        return one.fix(others[0], True)
    is_differing = found[1] in ("!=", "is not")
    word = found[3].lower()
    if word in _TRUTH:
        return one.fix(others[0], (word in ("false", "0")) != is_differing)
    sign = "!=" if is_differing else "=="
    return one.fix(one.compared(others[0], f"{sign} '{found[3]}'"), False)


def plain_conditions(around: Surroundings) -> Iterator[Problem]:
    """Report conditions with the name of a launch argument in place of its value."""
    for launch in around.launches:
        declared = {launch.text(c, "name", 0) for c in launch.called(_DECLARES)}
        names = [name for name in declared if name]
        for call in launch.called(*_OPPOSITE):
            given = call.given("predicate_expression", 0)
            text = given.value if isinstance(given, ast.Constant) else None
            if given is None or not isinstance(text, str):
                continue
            if text.strip().lower() in _TRUTH or "$(" in text:
                continue
            name = text if text in names else nearest(text, names, 0.8) or text
            yield Problem.at(
                launch.place(given),
                "error",
                _CODE,
                f"{call.name}('{text}') takes the text {text} itself, which is neither "
                f"true nor false: {_STOPS}",
                rewritten(given, launch.shown, f"LaunchConfiguration('{name}')"),
            )


_DECLARES = "DeclareLaunchArgument"


def bare_conditions(around: Surroundings) -> Iterator[Problem]:
    """Report texts and substitutions in place of a condition."""
    for launch in around.launches:
        for call in launch.calls:
            given = call.given("condition")
            made = launch.assigned(given) if given is not None else None
            is_text = isinstance(made, (ast.Constant, ast.Compare))
            if given is None or call.name == "IfElseSubstitution":
                continue
            if not is_text and substitution_in(given, launch) is None:
                continue
            right = f"IfCondition({ast.unparse(given)})"
            hint = with_import(f"write {right}", "IfCondition", launch)
            yield Problem.at(
                launch.place(given),
                "error",
                _CODE,
                f"condition takes an IfCondition or an UnlessCondition: {_STOPS}",
                rewritten(given, launch.shown, right, hint),
            )
