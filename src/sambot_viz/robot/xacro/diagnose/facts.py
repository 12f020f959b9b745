"""Facts about a failed expansion, for the messages in the table."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import Place, did_you_mean
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion, line_in


@dataclass(frozen=True, slots=True)
class Facts:
    """Each property is part of a sentence, or "" when there is nothing to add.

    Attributes:
        failed: the expansion.
        match: what the pattern of the row found in xacro's report.
        at: the place that the problem points at.
    """

    failed: FailedExpansion
    match: re.Match[str]
    at: Place

    @property
    def trail(self) -> str:
        """The macro calls on the way: " (in macro wheel, called on line 31)"."""
        return self.failed.trail(self.at)

    @property
    def text(self) -> str:
        """Xacro's message on one line, or the kind of error when it is empty."""
        said = re.sub(r"\s*\(<expression>, line \d+\)", "", self.failed.failure.text)
        return " ".join(said.split()) or self.failed.failure.kind

    @property
    def expression(self) -> str:
        """The innermost expression, without ${ and }."""
        return self.failed.expression

    @property
    def in_expression(self) -> str:
        """The innermost expression: " in ${a / b}"."""
        return f" in ${{{self.expression}}}" if self.expression else ""

    @property
    def searched(self) -> str:
        """Where a package was looked for."""
        package = self.failed.failure.missing_package
        return ", ".join(package.searched[:6]) if package else "nowhere"

    @property
    def near_package(self) -> str:
        """A package that was found and has nearly the name: "; did you mean …?"."""
        package = self.failed.failure.missing_package
        if package is None or not package.known:
            return ""
        return f"; {did_you_mean(package.name, package.known)}"

    @property
    def folder_missing(self) -> str:
        """Whether even the folder of the file does not exist."""
        folder = Path(self.match[1].strip()).parent
        return "" if folder.is_dir() else f"; the folder {folder} does not exist either"

    @property
    def near_file(self) -> str:
        """A file of the folder that has nearly the name: "; did you mean …?"."""
        try:
            files = sorted(
                path.name
                for path in Path(self.match[1].strip()).parent.iterdir()
                if path.is_file()
            )
        except OSError:
            return ""
        near = did_you_mean(self.match[2], files[:500])
        return f"; {near}" if near.startswith("did") else ""

    @property
    def identifier(self) -> str:
        """The name as Python could read it."""
        return re.sub(r"\W", "_", self.match[1]).lstrip("_") or "x"

    @property
    def called(self) -> str:
        """The macro that is called."""
        return self.failed.called_macro()[0]

    @property
    def declared(self) -> str:
        """Where the called macro is: " (declared on line 3)"."""
        definition = self.failed.called_macro()[2]
        if definition is None:
            return ""
        return f" (declared on {line_in(definition.place, self.at)})"

    @property
    def near_parameter(self) -> str:
        """A parameter of the called macro with nearly the name."""
        definition = self.failed.called_macro()[2]
        names = parameters(definition.params) if definition else []
        return did_you_mean(self.match[1], names)

    @property
    def blocks(self) -> str:
        """The blocks that the called macro takes: " (*origin, *shape)"."""
        definition = self.failed.called_macro()[2]
        names = re.findall(r"\*+([^\s:]+)", definition.params) if definition else []
        return f" ({', '.join('*' + name for name in names)})" if names else ""

    @property
    def _listed_names(self) -> list[str]:
        return [name.strip() for name in self.match[1].split(",") if name.strip()]

    @property
    def listed(self) -> str:
        """The names of a comma list: "side and y"."""
        return " and ".join(self._listed_names)

    @property
    def plural(self) -> str:
        """An "s" when there are several names."""
        return "s" if len(self._listed_names) > 1 else ""

    @property
    def values(self) -> str:
        """Attributes for the names: side="…" y="…"."""
        return " ".join(f'{name}="…"' for name in self._listed_names)

    @property
    def first(self) -> str:
        """The first of the names."""
        return (*self._listed_names, "x")[0]


def parameters(params: str) -> list[str]:
    """The names in params="a b:=1 *c **d"."""
    without_values = re.sub(
        r":?=\s*(?:'[^']*'|\"[^\"]*\"|\$\{[^}]*\}|\S+)", " ", params
    )
    return [name.strip("*") for name in without_values.split() if name.strip("*")]
