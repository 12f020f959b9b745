"""A failed expansion: the files it came from, and the facts for sentences about it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

from sambot_viz.cached import cached_property
from sambot_viz.edits import Extent, source_of, write_path
from sambot_viz.errors import Fix, Place, Problem, did_you_mean, nearest
from sambot_viz.robot.packages.near_file import near_file
from sambot_viz.robot.packages.package_index import places_of
from sambot_viz.robot.slips.vocabulary import is_one_slip, meant
from sambot_viz.robot.xacro.child_result import XacroFailure
from sambot_viz.robot.xacro.diagnose.include_order import IncludeOrder
from sambot_viz.robot.xacro.diagnose.source_files import (
    NamedElement,
    SourceSet,
    read_source,
)

CORRECT_PATH = "correct the path, or put the file there"
"""What to do about a file that is not there and resembles none."""

_IN_EXPRESSION = r"\$(?:\{[^}\"]*(?:\}|(?=\"))|\([^)\"]*(?:\)|(?=\")))"
_INSERTED = r"<xacro:insert_block\s+name\s*=\s*[\"']{}[\"']"
_REPAIRS = {
    "write ** for ^": (r"\^", "**"),
    "add }; an expression cannot contain } before its end": (
        r"\$\{\s*[\w.]+(?:\s*[-+*/]+\s*[\w.]+)*",
        r"\g<0>}",
    ),
    "add ) at the end": (r"(?=\}$)", ")"),
    "delete the ) that is too many": (r"\)(?=[^)]*\}$)", ""),
    "write * between the number and the name": (
        r"(?<![\w.])(\d+\.?\d*)(?=[A-Za-z_])",
        r"\1*",
    ),
}
"""Hint → what is wrong in the expression, and what is written for it."""

_WORDS = (
    (re.compile(r"write (\$\(optenv [^)]+\))$"), "$({})"),
    (re.compile(r"write (\$\(find [^)]+\)\S*)$"), "$({})"),
    (re.compile(r"did you mean '([\w.-]+)'\? If not"), "{}"),
    (re.compile(r"write ([\w-]+), or add "), "{}"),
    (re.compile(r"write (\$[{(][^)}]*[)}])(?=;|$)"), "$({})"),
)
"""Hint that says a word → the word that it is written for."""

_OF_SIDES = re.compile("y|side|mirror|sign|name|prefix|parent|flect")
"""In the names of parameters that differ between the sides of a robot."""
_SUBSTITUTIONS = ("find", "arg", "env", "optenv", "cwd", "dirname", "eval")

_EXAMPLES = {
    "origin": '<origin xyz="0 0 0" rpy="0 0 0"/>',
    "pose": "<pose>0 0 0 0 0 0</pose>",
}
"""Block → what can be written for it in any call."""


@dataclass(frozen=True)
class FailedExpansion:
    """A failure, and parts of sentences about it, "" where there is nothing to say.

    Attributes:
        failure: what xacro and the child process reported.
        main_file: the model as the user wrote it.
        sources: the files in which names and expressions are looked for.
        at: the place that the problem points at.
        found: the groups that a row of `explain_xacro` found in the report.
    """

    failure: XacroFailure
    main_file: str
    sources: SourceSet
    at: Place
    found: tuple[str, ...] = ()

    @classmethod
    def of(cls, failure: XacroFailure, main_file: str) -> FailedExpansion:
        """Prepare the search; the file being processed is searched first.

        It points at the element that xacro was working on, as far as the child
        process knows it.
        """
        files = [
            failure.file,
            *(file for _, file in failure.macros),
            *failure.includes,
            main_file,
            *(definition.file for definition in failure.definitions),
        ]
        at = Place(failure.file or main_file, failure.line or 1, failure.column)
        return cls(failure, main_file, SourceSet.of(files), at)

    def pointing_at(self, at: Place, found: tuple[str, ...] = ()) -> FailedExpansion:
        """Return the same failure with another place and other groups."""
        return replace(self, at=at, found=found)

    @property
    def report(self) -> str:
        """Xacro's report in one line for matching: "kind in macro: text"."""
        failure = self.failure
        if failure.missing_package is not None:
            return f"missing package {failure.missing_package.name}"
        inside = f" in {failure.macros[0][0]}" if failure.macros else ""
        return f"{failure.kind}{inside}: {failure.text}"

    @cached_property
    def order(self) -> IncludeOrder:
        """The includes of the model."""
        return IncludeOrder.of(self.sources)

    @property
    def expression(self) -> str:
        """The innermost expression without ${ and }, or ""."""
        text = (*self.failure.expressions, "")[0].strip()
        inner = re.fullmatch(r"\$\{(.*)\}", text, re.DOTALL)
        return (inner[1] if inner else text).strip()

    def expression_place(self) -> Place:
        """Find the place of the failed expression, else that of the element."""
        if not self.expression:
            return self.at
        pattern = r"\$[({]\s*(?:eval\s+)?" + re.escape(self.expression) + r"\s*[)}]"
        return self.sources.find(pattern, self.at) or self.at

    def rewrite(self, wrong: str, right: str, hint: str) -> Fix:
        """Return the fix that writes something else in the failed expression.

        Args:
            wrong: a pattern for what is wrong, wherever it is in the expression.
            right: what to write.
            hint: what the fix says.
        """
        place, source = self.expression_place(), source_of(self.expression_place().file)
        start = 0 if source is None else source.offset(place)
        found = source and re.compile(_IN_EXPRESSION).match(source.text, start)
        if source is None or not found:
            return Fix(hint)
        matches = re.finditer(wrong, source.text[start : found.end()])
        return Fix(
            hint,
            tuple(
                source.edit(
                    place, Extent(start + m.start(), start + m.end()), m.expand(right)
                )
                for m in matches
            ),
        )

    def repair(self, hint: str) -> str | Fix:
        """Return a hint with what it changes in the failed expression."""
        if hint == CORRECT_PATH:
            return self._file_fix
        if not self.found and hint.startswith("write $("):
            return self.rewrite(r"\$\{[^{}]*\}", hint.removeprefix("write "), hint)
        for said, wrong in _WORDS:
            right = said.match(hint)
            if right is not None:
                return self._replace(wrong.format(self.found[0]), right[1], hint)
        known = _REPAIRS.get(hint)
        return hint if known is None else self.rewrite(*known, hint)

    def _replace(self, wrong: str, right: str, hint: str) -> Fix:
        """Return the fix that writes a word for the next that is there."""
        source = source_of(self.at.file)
        start = 0 if source is None else source.offset(self.at)
        at = -1 if source is None else source.text.find(wrong, start)
        if source is None or at < 0 or "\n" in source.text[start:at]:
            return Fix(hint)
        return Fix(hint, (source.edit(self.at, Extent(at, at + len(wrong)), right),))

    @property
    def trail(self) -> str:
        """The macro calls on the way: " (in macro wheel, called on line 31)"."""
        calls, at = self.failure.calls, self.at
        if not calls or (calls[0].line == at.line and calls[0].file == at.file):
            return ""
        steps = [
            f"in macro {call.macro}, called on line {call.line}"
            + (f" of {call.file}" if call.file != at.file else "")
            for call in calls[:3]
        ]
        return f" ({'; '.join(steps)})"

    @property
    def text(self) -> str:
        """Xacro's message on one line, or the kind of error when it is empty."""
        said = re.sub(r"\s*\(<expression>, line \d+\)", "", self.failure.text)
        return " ".join(said.split()) or self.failure.kind

    @property
    def in_expression(self) -> str:
        """The innermost expression: " in ${a / b}"."""
        return f" in ${{{self.expression}}}" if self.expression else ""

    @property
    def searched(self) -> str:
        """The places where a package was looked for."""
        package = self.failure.missing_package
        return places_of(package.searched) if package else "nowhere"

    @property
    def near_package(self) -> str:
        """A package that was found and has nearly the name: "did you mean …? If …"."""
        package = self.failure.missing_package
        if package is None or not package.known:
            return ""
        near = meant(package.name, package.known)
        if near is None or not is_one_slip(package.name, near):
            return ""
        return f"did you mean '{near}'? If not, "

    @property
    def near_block(self) -> str:
        """A block of the macro with nearly the name, or without a use, as advice."""
        running = self.failure.macros[0][0] if self.failure.macros else ""
        macro = next((m for m in self.named("macro") if m.name == running), None)
        blocks = re.findall(r"\*+([^\s:]+)", macro.params) if macro else []
        unused = [b for b in blocks if not self.sources.find(_INSERTED.format(b))]
        only = unused[0] if len(unused) == 1 else None
        near = nearest(self.found[0], blocks) or only
        return f'write name="{near}"; or ' if near else ""

    @property
    def folder_missing(self) -> str:
        """A remark when even the folder of the file does not exist."""
        folder = Path(self.found[0].strip()).parent
        return "" if folder.is_dir() else f"; the folder {folder} does not exist either"

    @property
    def names_in_expressions(self) -> set[str]:
        """The properties, and the parameters of the macros that are expanded."""
        running = [macro for macro, _ in self.failure.macros]
        known = {p.name for p in self.named("property")}
        for macro in self.named("macro"):
            if macro.name in running:
                known.update(parameters(macro.params))
        return known

    @property
    def as_expression(self) -> str:
        """How a name is written that stands in $(…) alone: "write ${width}; "."""
        name = self.found[0].strip()
        if name in self.names_in_expressions:
            return f"write ${{{name}}}; "
        if any(arg.name == name for arg in self.named("arg")):
            return f"write $(arg {name}); "
        command, _, rest = name.partition(" ")
        near = meant(command, _SUBSTITUTIONS) if rest else None
        return f"write $({near} {rest}); " if near else ""

    @property
    def as_substitution(self) -> str:
        """How a command is written that stands in ${…}: "write $(arg width)"."""
        command, _, rest = self.expression.strip().partition(" ")
        if command in _SUBSTITUTIONS and rest.strip():
            return f"write $({command} {rest.strip()})"
        return "write one Python expression inside ${…}, such as ${2*radius}"

    @property
    def _file_fix(self) -> Fix:
        """The fix that names the file of the package that was meant, if one was."""
        missing = Path(self.found[0].strip())
        near = near_file(missing)
        # A file that is being read cannot be meant: it would include itself.
        if near is None or near in [Path(f).absolute() for f in self.failure.includes]:
            return Fix(CORRECT_PATH)
        fix = write_path(self.at, str(missing), str(near))
        if not fix.edits and near.parent == missing.parent:
            return self._replace(missing.name, near.name, f"write {near.name}")
        return fix if fix.edits else Fix(f"write the path of {near}")

    @property
    def near_key(self) -> str:
        """Advise which key of the yaml files was meant."""
        keys: dict[str, None] = {}
        for file in self.failure.files:
            source = read_source(file) if file.endswith((".yaml", ".yml")) else None
            if source is not None:
                names = re.findall(r"(?m)^\s*(?:- )?([\w-]+)\s*:", source.text)
                keys.update(dict.fromkeys(names))
        wrong, near = self.found[0], nearest(self.found[0], keys)
        if near is None or not is_one_slip(wrong, near):
            return f"{did_you_mean(wrong, keys)}; or add {wrong} to the file"
        return f"write {near}, or add {wrong} to the file"

    @property
    def ring(self) -> str:
        """The files that include each other, or the one that includes itself."""
        files = list(dict.fromkeys(self.failure.includes))
        if len(files) < 2:
            return "this file includes itself"
        return f"the files include each other: {' and '.join(files[:4])}"

    @property
    def identifier(self) -> str:
        """The name as Python could read it."""
        return re.sub(r"\W", "_", self.found[0]).lstrip("_") or "x"

    @property
    def called(self) -> str:
        """The macro that is called."""
        name = self.failure.macros[0][0] if self.failure.macros else ""
        return (name or (self.failure.element or "")).removeprefix("xacro:")

    @property
    def declared(self) -> str:
        """The place of the called macro: " (declared on line 3)"."""
        macro = self._called_macro
        return f" (declared on {line_in(macro.place, self.at)})" if macro else ""

    @property
    def blocks(self) -> str:
        """The blocks that the called macro takes: " (*origin, *shape)"."""
        macro = self._called_macro
        names = re.findall(r"\*+([^\s:]+)", macro.params) if macro else []
        return f" ({', '.join('*' + name for name in names)})" if names else ""

    @property
    def missing_block(self) -> str:
        """What to write in a call of a macro that takes a block."""
        macro = self._called_macro
        names = re.findall(r"\*+([^\s:]+)", macro.params) if macro else []
        if len(names) == 1 and names[0] in _EXAMPLES:
            return f"add {_EXAMPLES[names[0]]} inside it"
        tag = f"xacro:{self.called}"
        return f"write the elements inside: <{tag} …> <origin …/> </{tag}>"

    @property
    def listed(self) -> list[str]:
        """The names of a comma list."""
        names = [name.strip() for name in self.found[0].split(",")]
        return [name for name in names if name] or ["x"]

    @property
    def lacking(self) -> str:
        """The names of a comma list: "parameters side and y"."""
        plural = "s" if len(self.listed) > 1 else ""
        return f"parameter{plural} {' and '.join(self.listed)}"

    @property
    def values(self) -> str:
        """Attributes for the names of a comma list: side="…" y="0.1".

        A value is that of all other calls of the macro, if these have the same one;
        that of a single one may be the other side's.
        """
        return " ".join(f'{name}="{self._usual(name)}"' for name in self.listed)

    def _usual(self, parameter: str) -> str:
        """Return the only value that calls of the macro have for a parameter, or …."""
        given = [
            value
            for _, source in self.sources.sources()
            for tag in source.tags
            if tag.name == f"xacro:{self.called}"
            and (value := tag.get(parameter)) is not None
        ]
        alike = len(given) > 1 or _OF_SIDES.search(parameter.lower()) is None
        is_usual = len(set(given)) == 1 and alike and "${" in given[0]
        return given[0] if is_usual else "…"

    def error(self, code: str, message: str, hint: str | Fix) -> Problem:
        """Make a problem of severity "error" at the place."""
        return Problem.at(self.at, "error", code, message, hint)

    def is_root(self, place: Place) -> bool:
        """Return whether a place is inside the root tag of its file."""
        source = self.sources.get(place.file)
        root = next((t for t in source.tags if not t.closes), None) if source else None
        if source is None or root is None:
            return False
        return root.start <= source.offset(place.line, place.column or 1) < root.end

    def call_place(self) -> Place:
        """Return the place of the macro call that failed."""
        tag, calls = f"xacro:{self.called}", self.failure.calls
        if self.sources.tag_at(self.at, tag) is not None:
            return self.at
        if calls and calls[0].macro.removeprefix("xacro:") == self.called:
            return Place(calls[0].file, calls[0].line)
        return next((place for place, _ in self.sources.calls(tag)), self.at)

    @property
    def _called_macro(self) -> NamedElement | None:
        macros = self.named("macro")
        return next((macro for macro in macros if macro.name == self.called), None)

    def named(self, kind: str) -> list[NamedElement]:
        """Return the definitions in the files, and those that only xacro has seen."""
        found = self.sources.named(kind)
        names = {one.name for one in found if one.prefixed}
        return found + [
            NamedElement(kind, d.name, Place(d.file, d.line), True, d.params)
            for d in self.failure.definitions
            if d.kind == kind and d.name not in names
        ]


def line_in(place: Place, seen_from: Place) -> str:
    """Name a line in a message: "line 12", with the file when it is another one."""
    if place.file == seen_from.file:
        return f"line {place.line}"
    return f"line {place.line} of {place.file}"


def parameters(params: str) -> list[str]:
    """Return the names in params="a b:=1 *c **d"."""
    return [name.strip("*") for name in without_defaults(params).split() if name != "*"]


def without_defaults(params: str) -> str:
    """Return the parameter text of a macro with the names only: "a b *c"."""
    return re.sub(r":?=\s*(?:'[^']*'|\"[^\"]*\"|\$\{[^}]*\}|\S+)", " ", params)
