"""Find the mesh and texture files that a model names, and report missing ones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from sambot_viz.cached import cached_property
from sambot_viz.edits import write_path
from sambot_viz.errors import Fix, Problem
from sambot_viz.files import is_below
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.packages.near_file import near_file
from sambot_viz.robot.packages.package_index import (
    PackageIndex,
    package_around,
    package_name,
    places_of,
)
from sambot_viz.robot.slips.vocabulary import is_one_slip, meant
from sambot_viz.robot.xml.element import Element

if TYPE_CHECKING:
    from sambot_viz.robot.packages.resolve import FileResolver, Resolution

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
    "model-scheme": (
        "file-model-scheme",
        "only Gazebo looks for model:// among its models, RViz does not find the "
        "file; {path} was used",
        "write package://PACKAGE/…, which RViz finds, and Gazebo too when the share "
        "folder of the workspace is in GZ_SIM_RESOURCE_PATH",
    ),
    "name-form": ("file-name-form", "{cause}; {path} was used", ""),
}
_BY_NAME = frozenset(
    {"other-machine", "path-only", "three-slashes", "model-scheme", "name-form"}
)
"""Doubts that concern the name of the package in package://."""
_MESHES = (".stl", ".stlb", ".dae", ".obj", ".glb", ".gltf", ".ply")
"""Endings of the supported mesh files."""
_NOT_FOUND, _STAND_IN = " was not found: ", "; a placeholder is drawn"
_OUTSIDE = "it is outside the model's folder and packages, and the model is not trusted"

_OF_MESSAGES = (
    "messages may only name files of packages; write package://PACKAGE/…, and add "
    "--package-path FOLDER-THAT-HOLDS-PACKAGE"
)


class FileFinder:
    """Finds meshes and textures; reports each that is missing or doubtful once.

    Attributes:
        roots: folders from which files may come, resolved; None for no limit.
    """

    def __init__(
        self,
        folder: Path | None,
        package_path: Sequence[Path | str],
        findings: ModelFindings,
        trusted: bool = True,
    ) -> None:
        """Prepare.

        Args:
            folder: the model's folder, or None for a model given as text.
            package_path: as for `load_robot`.
            findings: receives the problems.
            trusted: False finds nothing outside the model's folder and packages.
        """
        self._where = (folder, package_path)
        self._findings = findings
        self._seen: set[str] = set()
        self.roots: tuple[Path, ...] | None = None
        if not trusted:
            self.roots = tuple(
                root.resolve() for root in PackageIndex(*self._where).own_roots()
            )

    @cached_property
    def _resolver(self) -> FileResolver:
        # Imported late: most robots have no meshes.
        from sambot_viz.robot.packages.resolve import FileResolver

        return FileResolver(PackageIndex(*self._where), self._where[0])

    def mesh(self, filename: str, element: Element) -> Path | None:
        """Find the file of a <mesh>."""
        return self._find("mesh", filename, element)

    def texture(self, filename: str, element: Element) -> Path | None:
        """Find the file of a <texture>."""
        return self._find("texture", filename, element)

    def _find(self, kind: str, filename: str, element: Element) -> Path | None:
        if not filename:
            return None
        found = self._resolver.resolve(filename)
        if self._is_outside(found):
            found = type(found)(None, (_OUTSIDE,))
        if filename in self._seen:
            return found.path
        self._seen.add(filename)
        if found.path is None and found.doubt is None:
            self._report_missing(kind, filename, found, element)
        elif found.doubt is not None:
            self._report_doubt(kind, filename, found, element)
        return found.path

    def _is_outside(self, found: Resolution) -> bool:
        """Return whether an untrusted model may not use this file, found or missing."""
        if self.roots is None:
            return False
        if found.path is not None:
            return not is_below(found.path, self.roots)
        if found.missing_package is not None:
            return False
        tried = [Path(text) for text in found.searched]
        return any(p.is_absolute() and not is_below(p, self.roots) for p in tried)

    def _report_doubt(
        self, kind: str, filename: str, found: Resolution, element: Element
    ) -> None:
        code, message, hint = _DOUBTS[found.doubt or "path-only"]
        path = found.path or "no file"
        name, cause = found.path.name if found.path else "", _home_of(filename)
        if found.form is not None:
            cause, hint = found.form.cause, found.form.hint
        text = message.format(path=path, name=name, cause=cause)
        hint = self._with_near_package(filename, found, element) or hint
        uri = _in_package(found.path) if found.doubt in _BY_NAME else ""
        if uri:
            hint = write_path(element.place, filename, uri)
        elif found.path is not None and found.doubt == "letter-case":
            tried = Path(found.searched[0])
            hint = _named(element, filename, tried, found.path)
        self._warn(code, f"the {kind} {filename}: {text}", hint, cause, element)

    def _report_missing(
        self, kind: str, filename: str, found: Resolution, element: Element
    ) -> None:
        package = found.missing_package
        if package == "":
            reason, hint = "it names no package", "write package://PACKAGE/…"
        elif package is not None:
            searched = places_of(found.searched)
            reason = f"the package {package} is not known (searched: {searched})"
            hint = f"add --package-path FOLDER-THAT-HOLDS-{package}"
            hint = self._with_near_package(filename, found, element) or hint
        elif found.searched == (_OUTSIDE,):
            reason = _OUTSIDE
            hint = "put the file below the model's folder, or open a model you trust"
        else:
            tried = ", ".join(found.searched) or "nowhere"
            reason = f"there is no such file (tried: {tried})"
            hint = "correct the path, or put the file there"
            if filename.startswith("http"):
                hint = "download it and name it by package:// or a relative path"
            folder = Path(found.searched[0]) if found.searched else None
            if folder is not None and folder.is_absolute() and folder.is_dir():
                reason, hint = "it is a folder", _file_in(folder, filename)
            elif folder is not None and folder.is_absolute():
                near = near_file(folder)
                reason += f"; the package has {_below_package(near)}" if near else ""
                hint = _named(element, filename, folder, near) if near else hint
        if found.form is not None:
            right = found.form.right
            reason = f"{found.form.cause} (tried: {', '.join(found.searched[:4])})"
            in_package = right.startswith("pack")
            hint = (
                write_path(element.place, filename, right)
                if in_package
                else found.form.hint
            )
        stand_in = _STAND_IN if kind == "mesh" else ""
        text = f"the {kind} {filename}{_NOT_FOUND}{reason}{stand_in}"
        self._warn(f"{kind}-not-found", text, hint, _home_of(filename), element)

    def _with_near_package(
        self, filename: str, found: Resolution, element: Element
    ) -> str | Fix:
        """Suggest a package with a similar name, or with a longer one."""
        if right := _with_right_package(filename, found):
            return write_path(element.place, filename, right)
        right = _with_longer_name(filename, found)
        if not right or self._resolver.resolve(right).path is not None:
            return write_path(element.place, filename, right) if right else ""
        return (
            f"did you mean {right}? If not, add --package-path "
            f"FOLDER-THAT-HOLDS-{found.missing_package}"
        )

    def _warn(
        self, code: str, text: str, hint: str | Fix, cause: str, element: Element
    ) -> None:
        self._findings.warn(code, text, hint, element, "filename", cause=cause)


def why_not_found(problems: Iterable[Problem]) -> str:
    """Explain why a mesh is missing, with a remedy; empty when it is not.

    Args:
        problems: problems of a model with a single mesh.
    """
    for problem in problems:
        if problem.code == "mesh-not-found":
            reason = problem.message.partition(_NOT_FOUND)[2].removesuffix(_STAND_IN)
            return _OF_MESSAGES if reason == _OUTSIDE else f"{reason}; {problem.hint}"
    return ""


def _with_right_package(filename: str, found: Resolution) -> str:
    """Suggest the package for a misspelt name, if there is one here."""
    package = found.missing_package
    near = meant(package, found.known_packages) if package else None
    if package is None or near is None or not is_one_slip(package, near):
        return ""
    return filename.replace(package, near, 1)


def _with_longer_name(filename: str, found: Resolution) -> str:
    """Suggest the only package whose name extends this one, if there is one here."""
    package = found.missing_package
    # One package may appear several times, as in the folders src and install.
    longer = [*{n for n in found.known_packages if n.startswith(f"{package}_")}]
    if package is None or len(longer) != 1:
        return ""
    return filename.replace(package, longer[0], 1)


def _named(element: Element, filename: str, tried: Path, meant: Path) -> Fix:
    """Return the fix that names a file in the style of another name."""
    uri = _in_package(meant)
    if filename.startswith("package://") and uri:
        return write_path(element.place, filename, uri)
    return write_path(element.place, str(tried), str(meant))


def _in_package(path: Path | None) -> str:
    """Return the package:// name of a file; empty for one outside all packages."""
    folder = None if path is None else package_around(path)
    if path is None or folder is None or not (folder / "package.xml").is_file():
        return ""
    return f"package://{package_name(folder)}/{_below_package(path)}"


def _below_package(path: Path) -> str:
    folder = package_around(path)
    return path.relative_to(folder).as_posix() if folder else path.name


def _file_in(folder: Path, filename: str) -> str:
    """Suggest a file to name instead of a folder."""
    inside = sorted(p.name for p in folder.iterdir() if p.suffix.lower() in _MESHES)
    example = f", such as {filename.rstrip('/')}/{inside[0]}" if inside else ""
    return f"write the name of a mesh file{example}"


def _home_of(filename: str) -> str:
    """Describe the common place of files of one package, or of one folder."""
    scheme, separator, rest = filename.partition("://")
    if separator and scheme in ("package", "model"):
        return f"package {rest.partition('/')[0]}" if rest[:1] != "/" else "no package"
    parent = str(PurePosixPath(filename.replace("\\", "/")).parent)
    return "the model's folder" if parent == "." else f"folder {parent}"
