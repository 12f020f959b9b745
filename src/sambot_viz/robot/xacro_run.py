"""Inside the child: run the real xacro and remember where everything came from.

xacro works on a minidom tree and forgets all positions. Here every node carries the
place it was parsed at; the mark survives cloning, so an expanded element still knows
the file and line that the user wrote, and the macro call it came through.
"""

from __future__ import annotations

import functools
import glob
import importlib
import os
import re
import sys
import types
import xml.dom.minidom
import xml.parsers.expat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.dom import expatbuilder

from sambot_viz.robot.packages import PackageIndex
from sambot_viz.robot.resolve import inside_package, other_letter_case
from sambot_viz.robot.xacro_guard import Guard
from sambot_viz.robot.xml_text import XmlFault, decode, mended_prolog

_minidom: Any = xml.dom.minidom
_ELEMENT = _minidom.Node.ELEMENT_NODE
_XACRO_WORDS = frozenset(
    {"property", "macro", "arg", "if", "unless", "insert_block", "include"}
)

Place = tuple[str, int, int]
"""File, line and column, both from 1."""
Call = tuple[str, str, int]
"""Macro, and the file and line of the call."""


class PackageNotFoundError(KeyError):
    """What ament_index_python raises; its look-up stands in `lookup`."""

    def __init__(self, name: str, searched: tuple[str, ...]) -> None:
        super().__init__(f"package '{name}' not found")
        self.missing_package = (name, searched)


class OutputLimit(Exception):
    """The expanded text is longer than allowed."""


class PlacedBuilder(expatbuilder.ExpatBuilderNS):
    """minidom's own builder, with the place on every element."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self._file = file

    def start_element_handler(self, name: Any, attributes: Any) -> None:
        """Build the element as minidom does, then mark it."""
        super().start_element_handler(name, attributes)
        this: Any = self
        parser = this.getParser()
        this.curNode.sambot_place = (
            self._file,
            parser.CurrentLineNumber,
            parser.CurrentColumnNumber + 1,
        )


def run(job: dict[str, Any]) -> dict[str, Any]:
    """Expand as the job says; never raises for what the model does."""
    sys.setrecursionlimit(2500)
    expansion = Expansion(job)
    try:
        return expansion.result()
    except XmlFault as fault:
        return {
            "xml_fault": [fault.message, fault.line, fault.column, fault.code],
            "file": expansion.reading,
            "text": fault.text,
        }
    except Exception as error:
        return {"failure": expansion.failure(error)}


class Expansion:
    """One run of xacro, patched to report."""

    def __init__(self, job: dict[str, Any]) -> None:
        self._job = job
        self._xacro: Any = importlib.import_module("xacro")
        base = job["folder"]
        self._index = PackageIndex(
            Path(base) if base else None, job["package_path"], job["environment"]
        )
        self._roots: list[Path] = []
        self._calls: list[Call] = []
        self._cloned_calls: tuple[Call, ...] | None = None
        self._node: Any = None
        self._failed_at: tuple[Any, list[Call], list[str]] | None = None
        self._lazy: list[str] = []
        self._definitions: dict[tuple[str, str], list[Any]] = {}
        self._warnings: list[list[Any]] = []
        self._files: list[str] = []
        self.reading = ""
        self._guard = Guard(base, self._allowed_roots) if job["untrusted"] else None
        self._patch()

    # -- running ---------------------------------------------------------------

    def result(self) -> dict[str, Any]:
        """Expand and describe the outcome.

        Raises:
            XmlFault: a file is no XML.
            Exception: whatever xacro or the model's expressions raise.
        """
        x, job = self._xacro, self._job
        if job["text"] is None:
            document = x.process_file(job["file"], mappings=dict(job["arguments"]))
        else:
            x.init_stacks(job["file"])
            document = self._parse(job["text"])
            x.process_doc(document, mappings=dict(job["arguments"]))
        text: str = document.toprettyxml(indent="  ")
        if len(text) > job["output_limit"]:
            raise OutputLimit(f"{len(text)} characters")
        names: dict[str, int] = {}
        places = [_packed(node, names) for node in _elements(document.documentElement)]
        return {
            "xml": text,
            "names": list(names),
            "places": places,
            "files": list(dict.fromkeys(self._files)),
            "warnings": self._warnings,
            "unprefixed": self._unprefixed(document.documentElement),
        }

    def _unprefixed(self, root: Any) -> list[list[Any]]:
        """Elements that look like a macro call or a directive without its prefix."""
        macros = {name for kind, name in self._definitions if kind == "macro"}
        words = macros | _XACRO_WORDS
        found: list[list[Any]] = []
        for node in _elements(root):
            if node.tagName in words and node.parentNode is root:
                found.append([node.tagName, node.tagName in macros, *node.sambot_place])
        return found

    def failure(self, error: BaseException) -> dict[str, Any]:
        """Describe an exception for `XacroFailure`."""
        node, calls, files = self._failed_at or (self._node, self._calls, [])
        cause, expressions = _unwrapped(error)
        place = getattr(node, "sambot_place", None)
        stack = [f for f in reversed(files or self._xacro.filestack or []) if f]
        macros = [
            [m.body.getAttribute("name"), (m.history[-1][-1] or "")]
            for m in reversed(self._xacro.macrostack or [])
        ]
        return {
            "kind": type(cause).__name__,
            "text": str(cause).strip() or repr(cause),
            "file": place[0] if place else (stack[0] if stack else self._job["file"]),
            "line": place[1] if place else None,
            "column": place[2] if place else None,
            "expressions": expressions,
            "element": getattr(node, "tagName", None),
            "macros": macros,
            "calls": [list(call) for call in reversed(calls)],
            "includes": stack,
            "lazy": self._lazy,
            "missing_package": getattr(cause, "missing_package", None),
            "definitions": list(self._definitions.values()),
        }

    # -- patches ---------------------------------------------------------------

    def _patch(self) -> None:
        x = self._xacro
        _minidom._clone_node = self._keeping_places(_minidom._clone_node)
        x.parse = self._parse
        x.eval_all = self._following(x.eval_all)
        x.handle_macro_call = self._macro_call(x.handle_macro_call)
        x.grab_property = self._defining("property", x.grab_property)
        x.grab_macro = self._defining("macro", x.grab_macro)
        x.process_include = self._touching(x.process_include)
        x.check_attrs = self._touching(x.check_attrs)
        x.reqd_attrs = self._touching(x.reqd_attrs)
        x.abs_filename_spec = self._file_name(x.abs_filename_spec)
        x.Table._resolve_ = self._resolving(x.Table._resolve_)
        x.warning = x.error = self._warn
        x.message = x.print_location = _say_nothing
        for name, function in (
            ("warning", self._warn),
            ("error", self._warn),
            ("message", _say_nothing),
            ("print_location", _say_nothing),
        ):
            x._global_symbols["xacro"][name] = function
        sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
        packages: Any = types.ModuleType("ament_index_python.packages")
        packages.get_package_share_directory = self._share_directory
        packages.PackageNotFoundError = PackageNotFoundError
        sys.modules["ament_index_python.packages"] = packages
        if self._guard is not None:
            self._guard.install(x)

    def _parse(self, source: Any, filename: str | None = None) -> Any:
        if source is None:
            source = self._read(filename or "")
        elif not isinstance(source, str):
            return source
        file = os.path.normpath(filename) if filename else self._job["file"]
        self.reading = file
        builder = PlacedBuilder(file)
        try:
            return builder.parseString(source)
        except xml.parsers.expat.ExpatError as error:
            message = xml.parsers.expat.ErrorString(error.code) or str(error)
            column = error.offset + 1
            raise XmlFault(message, error.lineno, column, source, error.code) from None

    def _read(self, filename: str) -> str:
        try:
            if self._guard is not None:
                self._guard.check_path(filename)
            data = Path(filename).read_bytes()
        except OSError as error:
            self._xacro.filestack.pop()
            raise self._xacro.XacroException(
                f"{error.strerror}: {filename}", exc=error
            ) from error
        self._files.append(os.path.abspath(filename))
        self.reading = os.path.normpath(filename)
        return mended_prolog(decode(data))

    def _keeping_places(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def clone(node: Any, deep: Any, document: Any) -> Any:
            outermost = (
                self._cloned_calls is None
                and getattr(node, "tagName", "") == "xacro:macro"
            )
            if outermost:
                self._cloned_calls = tuple(self._calls)
            try:
                copy = original(node, deep, document)
            finally:
                calls = self._cloned_calls
                if outermost:
                    self._cloned_calls = None
            if node.nodeType == _ELEMENT:
                copy.sambot_place = node.sambot_place
                copy.sambot_calls = calls or getattr(node, "sambot_calls", ())
            return copy

        return clone

    def _following(self, original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def wrapper(node: Any, macros: Any, symbols: Any) -> Any:
            self._node = node
            try:
                outcome = original(node, macros, symbols)
            except Exception:
                self._note_failure()
                raise
            self._node = node
            return outcome

        return wrapper

    def _note_failure(self) -> None:
        if self._failed_at is None:
            files: list[Any] = list(filter(None, self._xacro.filestack or []))
            self._failed_at = (self._node, list(self._calls), files)

    def _touching(self, original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def wrapper(node: Any, *rest: Any, **named: Any) -> Any:
            self._node = node
            outcome = original(node, *rest, **named)
            if getattr(node, "tagName", "") == "xacro:arg":
                self._define("arg", node)
            return outcome

        return wrapper

    def _defining(self, kind: str, original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def wrapper(node: Any, table: Any) -> Any:
            self._node = node
            self._define(kind, node)
            return original(node, table)

        return wrapper

    def _define(self, kind: str, node: Any) -> None:
        name = node.getAttribute("name")
        file, line, _ = node.sambot_place
        params = node.getAttribute("params")
        self._definitions[kind, name] = [kind, name, file, line, params]

    def _macro_call(self, original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def wrapper(node: Any, macros: Any, symbols: Any) -> Any:
            tag: str = node.tagName
            if not tag.startswith("xacro:") or tag == "xacro:call":
                return original(node, macros, symbols)
            self._node = node
            file, line, _ = node.sambot_place
            self._calls.append((tag[6:], file, line))
            try:
                outcome = original(node, macros, symbols)
            except Exception:
                self._note_failure()
                raise
            self._calls.pop()
            return outcome

        return wrapper

    def _resolving(self, original: Callable[..., Any]) -> Callable[..., Any]:
        expansion = self

        @functools.wraps(original)
        def wrapper(table: Any, key: str) -> Any:
            try:
                return original(table, key)
            except Exception:
                expansion._lazy.append(key)
                raise

        return wrapper

    def _warn(self, *words: Any, **_options: Any) -> str:
        place = getattr(self._node, "sambot_place", (self._job["file"], None, None))
        self._warnings.append([" ".join(map(str, words)), *place])
        return ""

    # -- files and packages ----------------------------------------------------

    def _share_directory(self, name: str) -> str:
        lookup = self._index.find(name)
        if lookup.path is None:
            raise PackageNotFoundError(name, lookup.searched)
        if lookup.path not in self._roots:
            self._roots.append(lookup.path)
        return str(lookup.path)

    def _allowed_roots(self) -> list[Path]:
        return list(self._roots)

    def _file_name(self, original: Callable[[str], str]) -> Callable[[str], str]:
        def wrapper(spec: str) -> str:
            if self._guard is not None:
                self._guard.check_spec(spec)
            match = re.match(r"package://([^/]+)/(.*)", spec)
            if match:
                spec = os.path.join(self._share_directory(match[1]), match[2])
            path = original(spec)
            if self._guard is not None:
                self._guard.check_path(path)
            if glob.has_magic(path) or os.path.exists(path):
                return path
            return self._elsewhere(Path(path)) or path

        return wrapper

    def _elsewhere(self, path: Path) -> str | None:
        """The file in a source tree that is laid out unlike its installed package."""
        cased = other_letter_case(path)
        if cased is not None:
            self._warn(f"{path.name} was found as {cased.name}: letter case differs")
            return str(cased)
        stack = {os.path.realpath(f) for f in self._xacro.filestack if f}
        for root in self._roots:
            if path.is_relative_to(root):
                found = inside_package(root, path.relative_to(root), stack)
                return str(found) if found else None
        return None


def _say_nothing(*_words: Any, **_options: Any) -> str:
    return ""


def _elements(root: Any) -> Iterator[Any]:
    stack = [root]
    while stack:
        node = stack.pop()
        yield node
        children = [child for child in node.childNodes if child.nodeType == _ELEMENT]
        stack.extend(reversed(children))


def _packed(node: Any, names: dict[str, int]) -> list[int]:
    file, line, column = node.sambot_place
    packed = [names.setdefault(file, len(names)), line, column]
    calls: tuple[Call, ...] = getattr(node, "sambot_calls", ())
    if calls:
        _, call_file, call_line = calls[0]
        packed += [names.setdefault(call_file, len(names)), call_line]
    return packed


def _unwrapped(error: BaseException) -> tuple[BaseException, list[str]]:
    """The exception below xacro's wrappers, and the expressions it came through."""
    expressions: list[str] = []
    while True:
        suffix = getattr(error, "suffix", None) or ""
        match = re.search(r"when evaluating expression '(.*)'", suffix, re.DOTALL)
        if match:
            expressions.insert(0, match[1])
        inner = getattr(error, "exc", None)
        if not isinstance(inner, BaseException):
            return error, expressions
        error = inner
