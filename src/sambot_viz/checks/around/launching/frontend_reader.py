"""Read launch files in XML and YAML, which share one vocabulary."""

from __future__ import annotations

import re
from collections.abc import Iterator

import yaml

from sambot_viz import limits
from sambot_viz.checks.around.files.parameters import YamlFile, pairs, place_of
from sambot_viz.checks.around.launching.actions import (
    Action,
    ActionGroup,
    Expression,
    ForNodes,
    FromFile,
    Given,
    IncludeFile,
    Joined,
    LaunchArgument,
    Operation,
    RobotText,
    SetArgument,
    ShareFolder,
    StartNode,
    StartProcess,
    UnknownAction,
    WrittenValue,
)
from sambot_viz.robot.xml.element import Element

_SUBSTITUTION = re.compile(r"\$\(\s*([\w-]+)\s*")
_NOTHING = frozenset(
    "append_env description keep log log_debug log_error log_info log_warning reset "
    "set_env shutdown unset_env".split()
)


def text_of(written: str) -> Expression:
    """Read a text with substitutions such as $(var name)."""
    parts: list[Expression] = []
    for part, is_text in written_parts(written):
        found = None if is_text else _SUBSTITUTION.match(part)
        if found is not None:
            parts.append(_substituted(found[1], part[found.end() : -1].strip()))
        elif _SUBSTITUTION.search(part) is not None:
            return None
        else:
            parts.append(part)
    if not parts:
        return written
    return parts[0] if len(parts) == 1 else Joined(tuple(parts))


def written_parts(written: str) -> list[tuple[str, bool]]:
    """Return the texts and the substitutions of a text; True for a text.

    A substitution without its last bracket stays in a text.
    """
    parts: list[tuple[str, bool]] = []
    at = 0
    while (found := _SUBSTITUTION.search(written, at)) is not None:
        end = _end(written, found.start() + 2)
        if end is None:
            break
        if found.start() > at:
            parts.append((written[at : found.start()], True))
        parts.append((written[found.start() : end + 1], False))
        at = end + 1
    if at < len(written):
        parts.append((written[at:], True))
    return parts


def _end(written: str, start: int) -> int | None:
    """Return the end of the bracket that opens before an offset."""
    depth = 1
    for at in range(start, len(written)):
        depth += {"(": 1, ")": -1}.get(written[at], 0)
        if not depth:
            return at
    return None


def _substituted(name: str, inner: str) -> Expression:
    words = inner.split()
    first = words[0] if words else ""
    match name:
        case "var" | "arg":
            default = text_of(" ".join(words[1:])) if len(words) > 1 else None
            return LaunchArgument(text_of(first), default)
        case "find-pkg-share" | "find":
            return ShareFolder(text_of(inner))
        case "dirname":
            return ShareFolder("")
        case "command":
            return RobotText(text_of(inner.strip("'\"")))
        case "eval":
            return Operation("eval", (text_of(_unquoted(inner)),))
        case "not":
            return Operation("not", (text_of(inner),))
        case "and" | "or" | "equals" if len(words) == 2:
            return Operation(name, (text_of(first), text_of(words[1])))
        case _:
            return None


def _unquoted(text: str) -> str:
    """Return a text without the quotation marks around the whole."""
    whole = len(text) > 1 and text[0] == text[-1] and text[0] in "'\""
    return text[1:-1].replace('\\"', '"') if whole else text


def element_of(file: YamlFile) -> Element:
    """Return a YAML launch file as the elements of the same file in XML."""
    root = Element("launch", {}, place_of(file.root, file.shown))
    for key, value in pairs(file.root):
        if key.value == "launch":
            _fill(root, value, file.shown, 0)
    return root


def _fill(element: Element, node: yaml.Node, file: str, depth: int) -> None:
    """Add a YAML value to an element, as attributes and child elements."""
    if depth > limits.YAML_DEPTH.value:
        return
    if isinstance(node, yaml.SequenceNode):
        items: list[yaml.Node] = node.value
        for item in items[: limits.LAUNCH_VALUE.value]:
            for key, value in pairs(item):
                _add(element, key.value, value, file, depth)
        return
    for key, value in pairs(node):
        if isinstance(value, yaml.ScalarNode):
            element.attributes[key.value] = value.value
        elif key.value in ("children", "launch"):
            _fill(element, value, file, depth + 1)
        elif isinstance(value, yaml.SequenceNode):
            for item in value.value[: limits.LAUNCH_VALUE.value]:
                _add(element, key.value, item, file, depth)


def _add(element: Element, tag: str, value: yaml.Node, file: str, depth: int) -> None:
    child = Element(tag, {}, place_of(value, file), parent=element)
    if isinstance(value, yaml.ScalarNode):
        child.attributes["value"] = value.value
    _fill(child, value, file, depth + 1)
    element.children.append(child)


def read_frontend(root: Element) -> tuple[Action, ...]:
    """Return the actions of a launch file.

    Args:
        root: its <launch>.
    """
    return tuple(action for child in root.children for action in _actions(child))


def _actions(element: Element) -> Iterator[Action]:
    place, condition = element.place, _condition(element)
    match element.tag.replace("-", "_"):
        case "arg":
            value = element.get("value")
            default = value if value is not None else element.get("default")
            named, text = _text(element, "name"), default and text_of(default)
            yield SetArgument(place, condition, named, text, declares=value is None)
        case "let":
            named, text = _text(element, "name"), _text(element, "value")
            yield SetArgument(place, condition, named, text, declares=False)
        case "node" | "lifecycle_node":
            yield _node(element, condition)
        case "node_container" | "load_composable_node":
            yield from _container(element, condition)
        case "executable":
            words = (_text(element, "cmd"),)
            yield StartProcess(place, condition, words)
        case "include":
            given = tuple(
                (_text(each, "name"), _text(each, "value"))
                for each in element.find_all("arg")
            )
            space = element.get("ns")
            inner: tuple[Action, ...] = (
                IncludeFile(place, "true", _text(element, "file", None), given),
            )
            if space is not None:
                inner = (ForNodes(place, "true", text_of(space)), *inner)
            yield ActionGroup(place, condition, inner, scoped=space is not None)
        case "group" | "timer":
            scoped = element.get("scoped") not in ("false", "False")
            space = element.get("ns")
            inner = read_frontend(element)
            if space is not None:
                inner = (ForNodes(place, "true", text_of(space)), *inner)
            yield ActionGroup(place, condition, inner, scoped)
        case "push_ros_namespace":
            yield ForNodes(place, condition, _text(element, "namespace", None))
        case "set_parameter" | "param":
            yield ForNodes(place, condition, given=tuple(_given(element, "")))
        case "set_use_sim_time":
            value = WrittenValue("use_sim_time", (_text(element, "value"),), place)
            yield ForNodes(place, condition, given=(value,))
        case "set_remap" | "remap":
            yield ForNodes(place, condition, remappings=(_remapping(element),))
        case tag if tag not in _NOTHING:
            yield UnknownAction(place, condition, f"<{tag}>")
        case _:
            pass


def _text(element: Element, name: str, default: Expression = "") -> Expression:
    written = element.get(name)
    return default if written is None else text_of(written)


def _condition(element: Element) -> Expression:
    unless = element.get("unless")
    if unless is not None:
        return Operation("not", (text_of(unless),))
    return _text(element, "if", "true")


def _node(element: Element, condition: Expression) -> StartNode:
    words = f"{element.get('args') or ''} {element.get('ros_args') or ''}".split()
    program = next(
        (n for n in ("exec", "plugin", "type") if element.get(n) is not None), "exec"
    )
    return StartNode(
        element.place,
        condition,
        _text(element, "pkg"),
        _text(element, program),
        _text(element, "name"),
        _text(element, "namespace", _text(element, "ns")),
        tuple(g for each in element.find_all("param") for g in _given(each, "")),
        tuple(_remapping(each) for each in element.find_all("remap")),
        tuple(text_of(word) for word in _words(words)),
    )


def _words(words: list[str]) -> Iterator[str]:
    """Yield the words of a command; a substitution stays one word."""
    open_ = ""
    for word in words:
        open_ = f"{open_} {word}".strip()
        if open_.count("(") <= open_.count(")"):
            yield open_
            open_ = ""


def _container(element: Element, condition: Expression) -> Iterator[Action]:
    parts = [_node(e, _condition(e)) for e in element.find_all("composable_node")]
    first = [_node(element, "true")] if element.get("exec") is not None else []
    yield ActionGroup(element.place, condition, (*first, *parts), scoped=False)


def _given(element: Element, above: str) -> Iterator[Given]:
    path = element.get("from")
    if path is not None:
        rewritten = element.get("allow_substs") in ("true", "True")
        yield FromFile(text_of(path), element.place, rewritten)
        return
    name = element.get("name") or ""
    inner = element.find_all("param")
    for each in inner:
        yield from _given(each, f"{above}{name}.")
    if not inner:
        value = _text(element, "value", None)
        yield WrittenValue(text_of(f"{above}{name}"), (value,), element.place)


def _remapping(element: Element) -> tuple[Expression, Expression]:
    return _text(element, "from", None), _text(element, "to", None)
