"""Finds the main model of a package when the user names only the folder.

The search reads the files as text and does not parse them: it must also find a model
with a mistake, so that the mistake can be explained.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.files import read_limited
from sambot_viz.robot.packages.package_index import (
    MANIFESTS,
    package_around,
    package_name,
)

MODEL_ENDINGS = (".urdf.xacro", ".urdf", ".xacro", ".sdf.xacro", ".sdf")
"""Endings of model names, the most likely one first."""

_FOLDERS = (
    "urdf",
    "description",
    "robots",
    "robot",
    "model",
    "models",
    "xacro",
    "sdf",
)
_SKIPPED = frozenset({"build", "install", "log", "node_modules"})
_TESTS = frozenset({"test", "tests"})
_SUFFIXES = ("", "_description", "_support", "_urdf", "_robot", "_model", "_pkg")

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_INNERMOST_MACRO = re.compile(
    r"<xacro:macro\b[^>]*(?<!/)>(?:(?!<xacro:macro\b).)*?</xacro:macro\s*>", re.DOTALL
)
_INCLUDE = re.compile(r"<(?:xacro:)?include\b[^>]*?filename\s*=\s*[\"']([^\"']+)")
_LINK = re.compile(r"<link\b")
_WORLD = re.compile(r"<world\b")
_STATIC = re.compile(r"<static>\s*(?:1|true)\s*</static>")
_SEMANTIC = ".srdf.xacro"
"""MoveIt's description of a robot, which names links but defines none."""
_CALL = re.compile(r"<xacro:(?!property|arg\b|include|macro|insert_block|element|attr)")
_UNKNOWN = re.compile(
    r"<(?![/?!]|robot\b|include\b|material\b|color\b|texture\b"
    r"|xacro:(?:property|arg|include|macro)\b)"
)
"""An element that may be a macro call without its prefix."""
_EXPRESSION = re.compile(r"\$[({][^)}]*[)}]")


class _ModelFile(NamedTuple):
    """Findings from a look at the text of a file.

    Attributes:
        path: the file.
        has_links: whether it has links, or calls that may create some.
        includes: files that it includes, as written.
        includes_outside: whether it includes one of them outside its macros.
        may_be_robot: whether it is neither a world nor MoveIt's description of a robot.
    """

    path: Path
    has_links: bool
    includes: tuple[str, ...]
    includes_outside: bool
    may_be_robot: bool = True

    @property
    def builds_links(self) -> bool:
        """Return whether it has links, or calls or includes that may create some."""
        return self.may_be_robot and (self.has_links or self.includes_outside)


@dataclass(slots=True)
class ModelWalk:
    """A walk through a folder in search of files with a model's ending.

    Attributes:
        left_out: the folders that it did not search, as a sentence; "" if none.
    """

    left_out: str = ""

    def files(self, top: Path) -> Iterator[Path]:
        """Yield the files, without those of other packages inside the folder.

        If the folder is not a package itself, search all packages in it.
        """
        in_package = package_name(top) is not None
        count = 0
        for place, folders, names in os.walk(top):
            folder = Path(place)
            depth = len(folder.relative_to(top).parts)
            if in_package and depth and not set(names).isdisjoint(MANIFESTS):
                folders.clear()
                continue
            folders[:] = sorted(f for f in folders if _worth_entering(f))
            count += 1
            if folders and depth >= limits.MODEL_DEPTH.value:
                self._leave_out(f"{limits.MODEL_DEPTH.value:,} folders deep")
                folders.clear()
            if count > limits.MODEL_FOLDERS.value:
                self._leave_out(f"{limits.MODEL_FOLDERS.value:,} folders")
                return
            for name in sorted(names):
                if name.endswith(MODEL_ENDINGS):
                    yield folder / name

    def _leave_out(self, most: str) -> None:
        self.left_out = f"not all of it was searched: {most} at most"


def models_in(folder: Path, walk: ModelWalk) -> list[Path]:
    """Return the files of a folder that are complete models, sorted.

    The result omits files without links, files with only macros, and files that another
    file includes. Models for tests count only when there are no others.

    Args:
        folder: the folder to search.
        walk: searches the folder, and reports afterwards what it left out.
    """
    paths = list(walk.files(folder))
    products = [p for p in paths if not is_for_tests(p.relative_to(folder))]
    found = (
        _complete_models(products)
        or _complete_models(paths)
        or [path for path in products if _is_model_in_world(path)]
    )
    return [path for path in found if not is_scenery(path)] or found


def is_scenery(path: Path) -> bool:
    """Return whether an SDF file never moves: it is part of a world, not a robot."""
    is_sdf = "sdf" in model_ending(path.name)
    return is_sdf and bool(_STATIC.search(_text_of(path)))


def _is_model_in_world(path: Path) -> bool:
    """Return whether a file is a robot inside a <world>, which its reader reports.

    A world is in a folder of worlds of its package, or has the word in its name.
    """
    text = _text_of(path)
    if not (_WORLD.search(text) and _LINK.search(text)):
        return False
    file = path.absolute()
    inside = file.relative_to(package_around(file) or file.parent.parent)
    return not any("world" in part for part in (file.stem, *inside.parts[:-1]))


def is_for_tests(path: Path) -> bool:
    """Return whether a path leads through a folder of tests."""
    return not _TESTS.isdisjoint(part.lower() for part in path.parts)


def _complete_models(paths: Sequence[Path]) -> list[Path]:
    files = [_look_at(path) for path in paths]
    names = [file.path.name for file in files]
    included = {
        other.path
        for file in files
        for include in file.includes
        for other in files
        if other is not file and _is_included(other.path, include, names)
    }
    complete = [f for f in files if f.builds_links and f.path not in included]
    return [f.path for f in complete if _brings_links(f, files, names, {f.path})]


def _brings_links(
    file: _ModelFile, files: Sequence[_ModelFile], names: Sequence[str], seen: set[Path]
) -> bool:
    """Return whether a file has links, or includes a file with links or a missing one.

    Args:
        file: the file.
        files: files of the package.
        names: their names.
        seen: files already visited.
    """
    if file.has_links:
        return True
    for include in file.includes:
        here = [f for f in files if _is_included(f.path, include, names)]
        more = [f for f in here if f.path not in seen]
        seen |= {f.path for f in more}
        if not here or any(_brings_links(f, files, names, seen) for f in more):
            return True
    return False


def is_model(path: Path) -> bool:
    """Return whether a file is a complete model: it has links, or calls for some."""
    return _look_at(path).builds_links


def choose_model(folder: Path, models: Sequence[Path]) -> Path | None:
    """Choose the obvious one of several models, or None.

    The rules in order: the only model; the model with the package's name; the only one
    that a launch file names; the one whose name the others extend ("arm" beside
    "arm_gazebo"); the only one with the most likely ending and folder. The first rule
    that finds a model decides.
    """
    models = _without_generated(models)
    rules: tuple[Callable[[Path, Sequence[Path]], list[Path]], ...] = (
        lambda _folder, known: list(known),
        _named_like_package,
        _named_in_launch_files,
        _shortest_name,
        _likeliest_place,
    )
    for rule in rules:
        found = rule(folder, models)
        if len(found) == 1:
            return found[0]
        models = found or models
    return None


def _worth_entering(name: str) -> bool:
    return name not in _SKIPPED and not name.startswith(".")


def _text_of(path: Path) -> str:
    """Return the text of a file without comments; "" when it cannot be read."""
    try:
        data = read_limited(path, limits.XACRO_SOURCE.value)
    except (OSError, ValueError):
        return ""
    return _COMMENT.sub("", data.decode("utf-8", "replace"))


def _look_at(path: Path) -> _ModelFile:
    text = _text_of(path)
    includes = tuple(_INCLUDE.findall(text))
    outside = _outside_macros(text)
    has_links = bool(_LINK.search(outside) or _CALL.search(outside))
    has_links |= bool(includes and _UNKNOWN.search(outside))
    other = _WORLD.search(outside) or path.name.endswith(_SEMANTIC)
    outer = bool(_INCLUDE.search(outside))
    return _ModelFile(path, has_links, includes, outer, not other)


def _outside_macros(text: str) -> str:
    """Return a text without its macros, which may have macros in them."""
    removed = 1
    while removed:
        text, removed = _INNERMOST_MACRO.subn("", text)
    return text


def _is_included(path: Path, include: str, names: Sequence[str]) -> bool:
    """Return whether an include names this file, as far as is known without xacro."""
    tail = _EXPRESSION.split(include)[-1].lstrip("./")
    if f"/{path.as_posix()}".endswith(f"/{tail}"):
        return bool(tail)
    name = tail.rpartition("/")[2]
    return path.name == name and names.count(name) == 1


def _without_generated(models: Sequence[Path]) -> list[Path]:
    """Omit x.urdf beside x.urdf.xacro, which generated it."""
    known = set(models)
    return [
        path
        for path in models
        if not (
            path.suffix in (".urdf", ".sdf")
            and known
            & {path.with_suffix(f"{path.suffix}.xacro"), path.with_suffix(".xacro")}
        )
    ]


def model_ending(name: str) -> str:
    """Return the ending of a model's file name, "" when it has none."""
    endings = (ending for ending in MODEL_ENDINGS if name.endswith(ending))
    return max(endings, key=len, default="")


def _stem(path: Path) -> str:
    return path.name.removesuffix(model_ending(path.name))


def _named_like_package(folder: Path, models: Sequence[Path]) -> list[Path]:
    names = {folder.resolve().name, package_name(folder) or ""}
    stems = [n.removesuffix(s) for n in names for s in _SUFFIXES if n.endswith(s)]
    wanted = {stem.lower() for stem in stems if stem}
    found = [path for path in models if _stem(path).lower() in wanted]
    return found or [path for path in models if _stem(path) == "robot"]


def _named_in_launch_files(folder: Path, models: Sequence[Path]) -> list[Path]:
    texts: list[str] = []
    for file in sorted(folder.glob("launch/**/*launch*"))[:50]:
        try:
            data = read_limited(file, limits.PACKAGE_TEXT.value)
        except (OSError, ValueError):
            continue
        texts.append(data.decode("utf-8", "replace"))
    return [p for p in models if any(_names(p.name, text) for text in texts)]


def _names(name: str, text: str) -> bool:
    return re.search(rf"(?<![\w.-]){re.escape(name)}(?![\w-])", text) is not None


def _shortest_name(folder: Path, models: Sequence[Path]) -> list[Path]:
    stems = [_stem(path) for path in models]
    return [p for p in models if all(stem.startswith(_stem(p)) for stem in stems)]


def _likeliest_place(folder: Path, models: Sequence[Path]) -> list[Path]:
    def rank(path: Path) -> tuple[int, int]:
        ending = MODEL_ENDINGS.index(model_ending(path.name))
        parts = path.relative_to(folder).parts
        at = _FOLDERS.index(parts[0]) if parts[0] in _FOLDERS else len(_FOLDERS)
        return (ending, at)

    best = min((rank(path) for path in models), default=None)
    return [path for path in models if rank(path) == best]
