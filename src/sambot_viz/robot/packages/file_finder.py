"""Find the mesh and texture files that a model names, and report missing ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from sambot_viz.files import is_below
from sambot_viz.robot.packages.package_index import PackageIndex
from sambot_viz.robot.packages.resolve import FileResolver, Resolution
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.xml.element import Element

_DOUBTS = {
    "letter-case": (
        "file-letter-case",
        "the file here is called {name}, which differs in capital letters; on Linux "
        "ROS does not find it",
        "write the name with the same capital and small letters as the file",
    ),
    "other-machine": (
        "file-other-machine",
        "this is a path of another machine; {path} was used",
        "write package://…, so that it is found on every machine",
    ),
    "other-layout": (
        "file-other-layout",
        "not at that place in the package; {path} was used",
        "correct the path; an installed package may be laid out differently",
    ),
    "path-only": (
        "file-by-path-only",
        "not found by package or folder; {path} was used because its path ends in the "
        "same way",
        "correct the name, or give the package's folder with --package-path",
    ),
    "three-slashes": (
        "package-three-slashes",
        "package:/// has three slashes, so the name of the package is empty and ROS "
        "finds nothing; {path} was used",
        "write package://PACKAGE/…, with two slashes and the name of the package",
    ),
}
_PLURALS = {"mesh": "meshes", "texture": "textures"}
_MOST_NAMES = 6
_OUTSIDE = "it is outside the model's folder and packages, and the model is not trusted"


@dataclass(frozen=True, slots=True)
class _MissingCause:
    """Why files were not found, or not as ROS would find them.

    Attributes:
        code: of the problem.
        kind: "mesh" or "texture".
        where: the package or folder they were looked for in; files of one folder
            are reported together.
    """

    code: str
    kind: str
    where: str


@dataclass(slots=True)
class _Affected:
    """The files with one cause: the first with all details, the others by name."""

    element: Element
    resolution: Resolution
    names: list[str] = field(default_factory=list[str])


class FileFinder:
    """Finds meshes and textures; `report` has one Problem for each cause.

    Attributes:
        roots: the folders that files may be in, resolved; None for no limit.
    """

    def __init__(
        self,
        folder: Path | None,
        package_path: Sequence[Path | str],
        findings: UrdfFindings,
        trusted: bool = True,
    ) -> None:
        """Prepare.

        Args:
            folder: the model's folder, or None for a model given as text.
            package_path: as for `load_robot`.
            findings: where problems go.
            trusted: False finds nothing outside the model's folder and packages.
        """
        index = PackageIndex(folder, package_path)
        self._resolver = FileResolver(index, folder)
        self._findings = findings
        self._seen: set[str] = set()
        self._causes: dict[_MissingCause, _Affected] = {}
        self.roots: tuple[Path, ...] | None = None
        if not trusted:
            self.roots = tuple(root.resolve() for root in index.own_roots())

    def mesh(self, filename: str, element: Element) -> Path | None:
        """The file of a <mesh>."""
        return self._find("mesh", filename, element)

    def texture(self, filename: str, element: Element) -> Path | None:
        """The file of a <texture>."""
        return self._find("texture", filename, element)

    def report(self) -> None:
        """Add a problem for every cause, once all files have been asked for."""
        for cause, affected in self._causes.items():
            if cause.code.endswith("-not-found"):
                self._report_missing(cause, affected)
            else:
                self._report_doubt(cause, affected)

    def _find(self, kind: str, filename: str, element: Element) -> Path | None:
        if not filename:
            return None
        found = self._resolver.resolve(filename)
        if self._is_outside(found):
            found = Resolution(None, (_OUTSIDE,))
        if filename in self._seen:
            return found.path
        self._seen.add(filename)
        code = f"{kind}-not-found" if found.path is None else ""
        if found.doubt is not None:
            code = _DOUBTS[found.doubt][0]
        if code:
            cause = _MissingCause(
                code, kind, found.missing_package or _folder_of(filename)
            )
            affected = self._causes.setdefault(cause, _Affected(element, found))
            affected.names.append(filename)
        return found.path

    def _is_outside(self, found: Resolution) -> bool:
        """Whether an untrusted model may not name this file, even if it is missing."""
        if self.roots is None:
            return False
        if found.path is not None:
            return not is_below(found.path, self.roots)
        if found.missing_package is not None:
            return False
        tried = [Path(text) for text in found.searched]
        return any(p.is_absolute() and not is_below(p, self.roots) for p in tried)

    def _report_doubt(self, cause: _MissingCause, affected: _Affected) -> None:
        found = affected.resolution
        _, message, hint = _DOUBTS[found.doubt or "path-only"]
        path = found.path or "no file"
        text = message.format(path=path, name=found.path.name if found.path else "")
        subject = _subject(cause, affected.names)
        self._warn(cause.code, f"{subject}: {text}", hint, affected)

    def _report_missing(self, cause: _MissingCause, affected: _Affected) -> None:
        resolution = affected.resolution
        package = resolution.missing_package
        if package is not None:
            searched = ", ".join(resolution.searched[:4]) or "nowhere"
            reason = f"the package {package} is not known (searched: {searched})"
            hint = f"add --package-path FOLDER, the folder that contains {package}"
        elif resolution.searched == (_OUTSIDE,):
            reason = _OUTSIDE
            hint = "put the file below the model's folder, or open a model you trust"
        else:
            tried = ", ".join(resolution.searched) or "nowhere"
            reason = f"there is no such file (tried: {tried})"
            hint = "correct the path, or put the file there"
            if affected.names[0].startswith("http"):
                hint = "download it and name it by package:// or a relative path"
        subject = _subject(cause, affected.names)
        was = "was" if len(affected.names) == 1 else "were"
        stand_in = "; a placeholder is drawn" if cause.kind == "mesh" else ""
        text = f"{subject} {was} not found: {reason}{stand_in}"
        self._warn(cause.code, text, hint, affected)

    def _warn(self, code: str, text: str, hint: str, affected: _Affected) -> None:
        self._findings.warn(code, text, hint, affected.element, "filename")


def _folder_of(filename: str) -> str:
    """What files of one package, or of one folder, have in common."""
    scheme, separator, rest = filename.partition("://")
    if separator and scheme in ("package", "model"):
        return rest.partition("/")[0]
    return str(PurePosixPath(filename.replace("\\", "/")).parent)


def _subject(cause: _MissingCause, names: Sequence[str]) -> str:
    """The file, or how many files of which package or folder: "52 meshes of arm"."""
    if len(names) == 1:
        return f"the {cause.kind} {names[0]}"
    short = [name.rpartition("/")[2] for name in names]
    shown = ", ".join(short[:_MOST_NAMES])
    more = f" and {len(short) - _MOST_NAMES} more" if len(short) > _MOST_NAMES else ""
    of = f" of {cause.where}" if cause.where not in ("", ".") else ""
    return f"{len(names)} {_PLURALS[cause.kind]}{of} ({shown}{more})"
