"""Conditions about files, what is written in them, and what `check` says of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase

from sambot_viz.errors import Place, nearest
from sambot_viz.lessons.conditions.condition import Unmet, of_problem
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import COUNT, TEXT, TEXTS
from sambot_viz.lessons.work import Work


@dataclass(frozen=True, slots=True, kw_only=True)
class FileCondition:
    """The folder has a file, whatever folder in it; * stands for any letters."""

    name: tuple[str, ...] = given(TEXTS)
    has: tuple[str, ...] = given(TEXTS, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for one file, and for words in it."""
        paths = work.files.paths
        found = [p for p in paths if any(_is_called(p, name) for name in self.name)]
        wanted = " or ".join(self.name)
        if not found:
            bare = [path.rpartition("/")[2] for path in paths]
            near = nearest(self.name[0].rpartition("/")[2], bare)
            like = f", but there is {near}" if near else ""
            yield Unmet(f"there is no file {wanted}{like}", "a file of this name")
            return
        texts = [work.files.text(path) or "" for path in found]
        for word in self.has:
            if not any(word in text for text in texts):
                place = Place(work.files.shown(found[0]), 1)
                yield Unmet(f"{found[0]} does not have '{word}'", f"'{word}'", place)


def _is_called(path: str, name: str) -> bool:
    return fnmatchcase(path, name) or fnmatchcase(path, f"*/{name}")


@dataclass(frozen=True, slots=True, kw_only=True)
class PropertyCondition:
    """A property of xacro is defined in the model, and used in ${…}."""

    name: str = given(TEXT)
    uses: int = given(COUNT, 1)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Count the expressions with the name."""
        name = re.escape(self.name)
        defined = rf"<xacro:property\b[^>]*\bname\s*=\s*[\"']{name}[\"']"
        used = rf"\$\{{[^}}]*(?<![\w.]){name}(?!\w)[^}}]*\}}"
        yield from _counted(work, f"the property {self.name}", defined, used, self.uses)


@dataclass(frozen=True, slots=True, kw_only=True)
class MacroCondition:
    """A macro of xacro is defined in the model, and called."""

    name: str = given(TEXT)
    calls: int = given(COUNT, 1)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Count the calls."""
        name = re.escape(self.name)
        defined = rf"<xacro:macro\b[^>]*\bname\s*=\s*[\"']{name}[\"']"
        used = rf"<xacro:{name}[\s/>]"
        yield from _counted(work, f"the macro {self.name}", defined, used, self.calls)


def _counted(
    work: Work, what: str, defined: str, used: str, least: int
) -> Iterator[Unmet]:
    texts = [re.sub(r"<!--.*?-->", "", text, flags=re.S) for _, text in work.sources()]
    if not any(re.search(defined, text) for text in texts):
        yield Unmet(f"{what} is not defined", "a definition of it")
        return
    count = sum(len(re.findall(used, text)) for text in texts)
    if count < least:
        much = (
            f"used {count} times" if count > 1 else "used once" if count else "not used"
        )
        times = "one use" if least == 1 else f"{least} uses"
        yield Unmet(f"{what} is {much}", f"at least {times}")


@dataclass(frozen=True, slots=True, kw_only=True)
class NoProblemCondition:
    """`check` warns of nothing with one of these codes; * stands for any letters."""

    code: tuple[str, ...] = given(TEXTS)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Give each such problem."""
        for problem in work.problems:
            named = any(fnmatchcase(problem.code, code) for code in self.code)
            if named and problem.severity != "info":
                yield of_problem(problem, "no such finding")


@dataclass(frozen=True, slots=True, kw_only=True)
class NoErrorsCondition:
    """`check` reports no error; other codes may be left out."""

    but: tuple[str, ...] = given(TEXTS, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Give each error."""
        for problem in work.problems:
            is_free = any(fnmatchcase(problem.code, code) for code in self.but)
            if problem.severity == "error" and not is_free:
                yield of_problem(problem, "no such finding")
