"""Definitions as text: .msg of ROS 1 and 2, .idl, and what rosbag2 makes of .srv.

rosbags parses them. Constants are left out: no message needs them to be read.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import (
    NAME,
    SEQUENCE,
    Lookup,
    TypeDefinition,
    Types,
    closed,
)

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs

LANGUAGES = ("ros2msg", "ros2idl", "omgidl", "ros1msg")
"""The encodings of definitions that can be parsed."""
_IDLS = ("ros2idl", "omgidl")
_LONGEST_WITHOUT_COMMENTS = 1 << 17
_WORD = re.compile(r"[A-Za-z]\w*", re.ASCII)
_DDS = re.compile(r"(\w+)::(\w+)::(?:dds_::)?(\w+?)_?", re.ASCII)
_PARTING = re.compile(r"^---[ \t]*$", re.MULTILINE)
_IDL = re.compile(r"^={80}\nIDL: .*\n", re.MULTILINE)
_COMMENTS = re.compile(r"^[ \t]*(?:#.*)?\n", re.MULTILINE)
_BOUND = re.compile(r"\bwstring<=\d+")
_SECTIONS = re.compile(r"^={80}$", re.MULTILINE)

_Read = Callable[[str, str], Types]


def canonical_name(name: str) -> str:
    """Return the name of a type as ROS 2 says it, others as they are.

    "pkg/Name" of ROS 1 and of old recordings gets its "/msg/"; a name of DDS
    ("pkg::msg::dds_::Name_") gets slashes.
    """
    if match := _DDS.fullmatch(name):
        return "/".join(match.groups())
    parts = name.split("/")
    if len(parts) == 2 and all(map(_WORD.fullmatch, parts)):
        return f"{parts[0]}/msg/{parts[1]}"
    return name


def parse(name: str, language: str, text: str | bytes, find: Lookup) -> TypeDefinition:
    """Return the definition that a text has, with what it names and does not have.

    Args:
        name: of the type, as `canonical_name` gives it.
        language: of `LANGUAGES`.
        text: the definition; an empty one is that of an empty message.
        find: finds other types.

    Raises:
        DecodeError: the text cannot be parsed, or what it defines cannot be read.
    """
    return closed(_inner_name(name), parsed_types(name, language, text), find)


def parsed_types(name: str, language: str, text: str | bytes) -> Types:
    """Return the types of a text alone.

    Raises:
        DecodeError: it cannot be parsed.
    """
    if isinstance(text, bytes):
        text = text.decode("utf-8", "replace")
    if len(text) > limits.DEFINITION.value:
        raise DecodeError(
            f"its definition is longer than {limits.DEFINITION.value:,} characters"
        )
    text = text.replace("\r\n", "\n")
    if language not in _IDLS:
        # Most of a text; rosbags takes 20 µs for each line.
        text = _COMMENTS.sub("", text)
        # rosbags' parser stops at it; the bound changes nothing in a message.
        text = _BOUND.sub("wstring", text)
    if len(text) > _LONGEST_WITHOUT_COMMENTS:
        raise DecodeError(f"its definition has {len(text):,} characters")
    try:
        return _parsed(_inner_name(name), language, text)
    except Exception as error:
        # rosbags' parser raises what it comes upon, of its own and of Python's.
        raise DecodeError("its definition cannot be parsed") from error


def _inner_name(name: str) -> str:
    """Return the name under which rosbags finds the other types of the package."""
    package, *rest = name.split("/")
    return f"{package}/msg/{rest[-1]}" if rest else f"unknown/msg/{package}"


def _parsed(name: str, language: str, text: str) -> Types:
    from rosbags.typesys import get_types_from_idl, get_types_from_msg

    def read(name: str, text: str) -> Types:
        if language in _IDLS:
            parts = [get_types_from_idl(part) for part in _IDL.split(text) if part]
        else:
            parts = [get_types_from_msg(text, name)]
        return {name: types[name][1] for types in parts for name in types}

    if name.endswith("_Event") and (language in _IDLS or _PARTING.search(text)):
        return _service_event(name, language, text, read)
    types = read(name, text)
    if name not in types:
        # An .idl says itself in which module its types are.
        folders = (name.replace("/msg/", f"/{folder}/") for folder in ("srv", "action"))
        types = {**types, name: next(types[one] for one in folders if one in types)}
    return types


def _service_event(name: str, language: str, text: str, read: _Read) -> Types:
    """Return the types of a service's event, which are in no text.

    rosbag2 writes the text of the service, a request and a response.
    """
    service = name.removesuffix("_Event")
    if language in _IDLS:
        types = dict(read(service, text))
        if name in types:
            return types
        folder = service.replace("/msg/", "/srv/")
        request, response = f"{folder}_Request", f"{folder}_Response"
    else:
        head, *sections = _SECTIONS.split(text, 1)
        asked, answer = _PARTING.split(head, 1)
        rest = "".join("=" * 80 + section for section in sections)
        request, response = f"{service}_Request", f"{service}_Response"
        types = {
            **read(request, asked + rest),
            **read(response, answer.lstrip() + rest),
        }
    event = [
        ("info", (NAME, "service_msgs/msg/ServiceEventInfo")),
        ("request", (SEQUENCE, ((NAME, request), 1))),
        ("response", (SEQUENCE, ((NAME, response), 1))),
    ]
    return {**types, name: cast("Fielddefs", event)}
