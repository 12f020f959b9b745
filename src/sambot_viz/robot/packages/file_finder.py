"""Finding the files a model names, and telling of those that are not there."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sambot_viz.files import is_below
from sambot_viz.robot.packages.package_index import PackageIndex
from sambot_viz.robot.packages.resolve import FileResolver, Resolution
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.xml.parse import Element

_DOUBTS = {
    "letter-case": (
        "file-letter-case",
        "is called {name} here; on Linux ROS does not find it",
        "write the name with the same capital and small letters as the file",
    ),
    "other-machine": (
        "file-other-machine",
        "is a path of another machine; {path} was taken for it",
        "write package://…, so that it is found everywhere",
    ),
    "other-layout": (
        "file-other-layout",
        "is not at that place of the package; {path} was taken for it",
        "correct the path; an installed package may be laid out differently",
    ),
    "path-only": (
        "file-by-path-only",
        "was not found by its package or folder; {path} was taken for it because it "
        "ends the same",
        "correct the name, or give the package's folder with --package-path",
    ),
}


_OUTSIDE = "it is outside the model's folder and packages, and the model is not trusted"


class FileFinder:
    """Answers mesh and texture names, with a Problem for each doubtful one.

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
        self._told: set[str] = set()
        self.roots: tuple[Path, ...] | None = None
        if not trusted:
            self.roots = tuple(root.resolve() for root in index.own_roots())

    def mesh(self, filename: str, element: Element) -> Path | None:
        """The file of a <mesh>."""
        return self._find("mesh", filename, element)

    def texture(self, filename: str, element: Element) -> Path | None:
        """The file of a <texture>."""
        return self._find("texture", filename, element)

    def _find(self, kind: str, filename: str, element: Element) -> Path | None:
        if not filename:
            return None
        found = self._resolver.resolve(filename)
        if self._is_outside(found):
            found = Resolution(None, (_OUTSIDE,))
        if filename in self._told:
            return found.path
        self._told.add(filename)
        if found.path is None:
            self._tell_missing(kind, filename, element, found)
        elif found.doubt is not None:
            code, message, hint = _DOUBTS[found.doubt]
            shown = message.format(name=found.path.name, path=found.path)
            self._findings.warn(
                code, f"the {kind} {filename} {shown}", hint, element, "filename"
            )
        return found.path

    def _is_outside(self, found: Resolution) -> bool:
        """Whether an untrusted model may not name this file, be it there or not."""
        if self.roots is None:
            return False
        if found.path is not None:
            return not is_below(found.path, self.roots)
        if found.missing_package is not None:
            return False
        tried = [Path(text) for text in found.searched]
        return any(p.is_absolute() and not is_below(p, self.roots) for p in tried)

    def _tell_missing(
        self, kind: str, filename: str, element: Element, found: Resolution
    ) -> None:
        if found.missing_package is not None:
            name = found.missing_package
            where = ", ".join(found.searched[:4]) or "nowhere"
            message = f"the package {name} is not known (searched: {where})"
            hint = f"give the folder that holds {name} with --package-path"
        elif found.searched == (_OUTSIDE,):
            message = _OUTSIDE
            hint = "put the file below the model's folder, or open a model you trust"
        else:
            where = ", ".join(found.searched) or "nowhere"
            message = f"there is no such file (tried: {where})"
            hint = "correct the path, or put the file there"
        if "://" in filename and filename.startswith("http"):
            hint = "download the file and name it by package:// or a relative path"
        self._findings.warn(
            f"{kind}-not-found",
            f"the {kind} {filename} was not found: {message}; a stand-in is drawn"
            if kind == "mesh"
            else f"the {kind} {filename} was not found: {message}",
            hint,
            element,
            "filename",
        )
