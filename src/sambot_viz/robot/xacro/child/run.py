"""Inside the child: run the real xacro, and report the outcome with places."""

from __future__ import annotations

import functools
import gc
import importlib
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sambot_viz.robot.packages.package_index import PackageIndex
from sambot_viz.robot.xacro.child.failure import OutputLimit, again, unwrapped
from sambot_viz.robot.xacro.child.package_files import XacroFiles
from sambot_viz.robot.xacro.child.places import (
    PlaceKeeper,
    elements,
    packed,
    parse_placed,
)
from sambot_viz.robot.xacro.child.sandbox import Guard
from sambot_viz.robot.xacro.child.speed import import_lazily, skipping_plain_text
from sambot_viz.robot.xml.decode import XmlFault, decode, repaired_prolog

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.child.exchange import (
        Call,
        ChildAnswer,
        DefinitionRow,
        ExpandedAnswer,
        FailureAnswer,
        Job,
        UnprefixedRow,
        WarningRow,
    )

_XACRO_WORDS = frozenset(
    {"property", "macro", "arg", "if", "unless", "insert_block", "include"}
)


import_lazily("yaml")
# Imported now, while the child may still wait for its job.
_XACRO: Any = importlib.import_module("xacro")


def run(job: Job) -> bytes:
    """Expand a model as the job says, and return the answer as JSON.

    An exception that the model causes becomes a part of the answer.
    """
    sys.setrecursionlimit(2500)
    # The trees are large and end with the process: collecting garbage is useless.
    gc.set_threshold(100_000)
    expansion = Expansion(job)
    answer: ChildAnswer = {"expanded": None, "not_xml": None, "failure": None}
    try:
        answer["expanded"] = expansion.result()
    except XmlFault as fault:
        answer["not_xml"] = {
            "message": fault.message,
            "line": fault.line,
            "column": fault.column,
            "code": fault.code,
            "text": fault.text,
            "file": expansion.reading,
            "files": expansion.wanted,
        }
    except Exception as error:
        answer["failure"] = expansion.failure(error)
    return json.dumps(answer, separators=(",", ":")).encode()


class Expansion:
    """One run of xacro, patched to report."""

    def __init__(self, job: Job) -> None:
        self._job = job
        self._xacro: Any = _XACRO
        self._places = PlaceKeeper()
        self._node: Any = None
        self._failed_at: tuple[Any, list[Call], list[str]] | None = None
        self._entered: list[Any] = []
        self._definitions: dict[tuple[str, str], DefinitionRow] = {}
        self._warnings: list[WarningRow] = []
        self._files: list[str] = []
        self._main_text: str | None = job["text"]
        self.reading = ""
        self._guard = Guard(job["folder"]) if job["untrusted"] else None
        self._named: list[str] = []
        self._patch()

    @property
    def wanted(self) -> list[str]:
        """The files beside the model that xacro has read or looked for so far."""
        return list(dict.fromkeys([*self._files, *self._named]))

    def result(self) -> ExpandedAnswer:
        """Expand and describe the outcome.

        Raises:
            XmlFault: a file is not XML.
            Exception: whatever xacro or the model's expressions raise.
        """
        job = self._job
        arguments = dict(job["arguments"])
        document = self._xacro.process_file(job["file"], mappings=arguments)
        text: str = document.toprettyxml(indent="  ")
        if len(text) > job["output_limit"]:
            raise OutputLimit(f"{len(text)} characters")
        nodes, places, names = packed(document.documentElement)
        return {
            "xml": text,
            "nodes": nodes,
            "places": places,
            "names": names,
            "files": [name for name in self.wanted if os.path.isfile(name)],
            "warnings": self._warnings,
            "unprefixed": self._unprefixed(document.documentElement),
            "macros": [name for kind, name in self._definitions if kind == "macro"],
        }

    def _unprefixed(self, root: Any) -> list[UnprefixedRow]:
        """Return elements that look like a macro call or directive without prefix."""
        macros = {name for kind, name in self._definitions if kind == "macro"}
        words = macros | _XACRO_WORDS
        inside = (node for node in elements(root) if node.parentNode is root)
        found = [node for node in inside if node.tagName in words]
        return [(n.tagName, n.tagName in macros, *n.sambot_place) for n in found]

    def failure(self, error: BaseException) -> FailureAnswer:
        """Describe an exception for `XacroFailure`."""
        node, calls, files = self._failed_at or (self._node, self._places.calls, [])
        cause, expressions = unwrapped(error)
        place = getattr(node, "sambot_place", None)
        open_files = reversed(files or self._xacro.filestack or [])
        stack = [self._shown(file) for file in open_files if file]
        macros = [
            (m.body.getAttribute("name"), self._shown(m.history[-1][-1] or ""))
            for m in reversed(self._xacro.macrostack or [])
        ]
        if isinstance(cause, RecursionError):
            # Only chance decides which other files were open at the depth limit.
            places = again([one.sambot_place for one in self._entered]) or [place]
            place, stack, macros = places[-1], again(stack), again(macros)
        return {
            "kind": type(cause).__name__,
            "text": str(cause).strip() or repr(cause),
            "file": place[0] if place else (stack[0] if stack else self._job["file"]),
            "line": place[1] if place else None,
            "column": place[2] if place else None,
            "expressions": expressions,
            "element": getattr(node, "tagName", None),
            "macros": macros,
            "calls": list(reversed(calls)),
            "includes": stack,
            "missing_package": getattr(cause, "missing_package", None),
            "definitions": list(self._definitions.values()),
            "files": self.wanted,
        }

    def _patch(self) -> None:
        x, job = self._xacro, self._job
        x.parse = self._parse
        x.eval_text = skipping_plain_text(x.eval_text)
        x.eval_all = self._following(x.eval_all)
        x.handle_macro_call = self._macro_call(self._entering(x.handle_macro_call))
        x.grab_property = self._defining("property", x.grab_property)
        x.grab_macro = self._defining("macro", x.grab_macro)
        x.process_include = self._entering(self._touching(x.process_include))
        x.check_attrs = self._touching(x.check_attrs)
        x.reqd_attrs = self._touching(x.reqd_attrs)
        x.warning = x.error = self._warn
        x.message = x.print_location = _say_nothing
        for name in ("warning", "error", "message", "print_location"):
            x._global_symbols["xacro"][name] = getattr(x, name)
        folder = Path(job["folder"]) if job["folder"] else None
        index = PackageIndex(folder, job["package_path"], job["environment"])
        XacroFiles(index, self._guard, self._warn, self._named).install(x)
        if self._guard is not None:
            self._guard.install(x)

    def _parse(self, source: Any, filename: str | None = None) -> Any:
        if source is None:
            source = self._read(filename or "")
        elif not isinstance(source, str):
            return source
        file = self._shown(filename) if filename else self._job["file"]
        self.reading = file
        return parse_placed(source, file)

    def _read(self, filename: str) -> str:
        if self._main_text is not None:
            # The first file is the model, which the parent process has read.
            text, self._main_text = self._main_text, None
            return text
        try:
            if self._guard is not None:
                self._guard.check_path(filename)
            edited = self._job["edited"].get(os.path.abspath(filename))
            data = Path(filename).read_bytes() if edited is None else b""
        except OSError as error:
            self._xacro.filestack.pop()
            text = f"{error.strerror}: {filename}"
            raise self._xacro.XacroException(text, exc=error) from error
        self._files.append(os.path.abspath(filename))
        self.reading = self._shown(filename)
        return repaired_prolog(decode(data) if edited is None else edited)

    def _shown(self, filename: str) -> str:
        """Return a file name as the user would write it: relative to the model."""
        path = os.path.normpath(filename)
        if os.path.isabs(path) and not os.path.isabs(self._job["file"]):
            try:
                relative = os.path.relpath(path)
            except ValueError:
                # On another drive of Windows.
                return path
            return path if relative.startswith(os.pardir) else relative
        return path

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
            files: list[str] = list(filter(None, self._xacro.filestack or []))
            self._failed_at = (self._node, list(self._places.calls), files)

    def _entering(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Note an element as long as what it includes or calls is being expanded."""

        @functools.wraps(original)
        def wrapper(node: Any, *rest: Any, **named: Any) -> Any:
            self._entered.append(node)
            outcome = original(node, *rest, **named)
            self._entered.pop()
            return outcome

        return wrapper

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
        self._definitions[kind, name] = (kind, name, file, line, params)

    def _macro_call(self, original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def wrapper(node: Any, macros: Any, symbols: Any) -> Any:
            tag: str = node.tagName
            if not tag.startswith("xacro:") or tag == "xacro:call":
                return original(node, macros, symbols)
            self._node = node
            file, line, _ = node.sambot_place
            self._places.calls.append((tag[6:], file, line))
            try:
                outcome = original(node, macros, symbols)
            except Exception:
                self._note_failure()
                raise
            self._places.calls.pop()
            return outcome

        return wrapper

    def _warn(self, *words: Any, **_options: Any) -> str:
        file, line, column = getattr(
            self._node, "sambot_place", (self._job["file"], None, None)
        )
        self._warnings.append((" ".join(map(str, words)), file, line, column))
        return ""


def _say_nothing(*_words: Any, **_options: Any) -> str:
    return ""
