"""Find and read the files of the packages around a model, each once, by kind.

A package is the folder of a package.xml. It reads files as text when a rule asks for
them, within limits, and keeps them for all rules and models of one check.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, TypeVar

from sambot_viz import limits
from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.cmake import CMakeFile
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import YamlFile, read_yaml
from sambot_viz.checks.around.launching.launch_file import LaunchFile, read_launch
from sambot_viz.files import is_below, read_limited, relative_path
from sambot_viz.robot.packages.package_index import PackageIndex, package_name
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml
from sambot_viz.unsaved import unsaved_text

if TYPE_CHECKING:
    from sambot_viz.checks.around.launching.actions import Action
    from sambot_viz.checks.around.setup_file import SetupFile
    from sambot_viz.robot.packages.resolve import FileResolver

_SKIPPED = frozenset(
    {"build", "install", "log", "meshes", "node_modules", "test", "tests"}
)
_YAML = (".yaml", ".yml")
_ENTRY = "def generate_launch_description"
_WITHOUT_PARAMETERS = re.compile(r"(^|/)(maps?|meshes)/")
_OTHER_LAUNCHES = (".launch", ".launch.xml", ".launch.yaml", ".launch.yml")
_IN_SHARE = re.compile(
    r"\$\(find(?:-pkg-share)?\s+([\w.-]+)\s*\)((?:/[\w.+-]+)+)"
    r"|package://([\w.-]+)((?:/[\w.+-]+)+)"
)
"""A path in the share folder of a package, as XML and YAML launch files write it."""
_SHARE_CALL = re.compile(
    r"(?:FindPackageShare|get_package_share_\w+)\(\s*(?:\w+\s*=\s*)?[\"']([\w.-]+)"
)
_T = TypeVar("_T")
_QUOTED_FILE = re.compile(r"[\"']/?([\w./+-]+\.\w+)[\"']")


@dataclass(frozen=True, eq=False)
class Package:
    """A package, with the contents of its files.

    Attributes:
        folder: the package, absolute.
        name: its name in package.xml.
        relative: True for paths relative to the working folder, as the user wrote the
            model's; False for absolute ones.
        trusted: False reads no file that a link leads out of the package.
        read: receives each file that the package looks for.
        workspace: finds other packages; None for a folder alone.
        known: what was read of each file: the way to read it, and its path → that.
    """

    folder: Path
    name: str
    relative: bool
    trusted: bool
    read: set[Path]
    workspace: Workspace | None = None
    known: dict[tuple[str, str], Any] = field(
        default_factory=dict[tuple[str, str], Any], repr=False
    )

    def _once(self, read: Callable[[str], _T], path: str) -> _T:
        """Read a file in one way, once."""
        key = read.__name__, path
        if key not in self.known:
            self.known[key] = read(path)
        return self.known[key]

    def edited(self, workspace: Workspace, files: Collection[Path]) -> Package:
        """Return the package as it is when some files have other texts; see `unsaved`.

        Only these files are read again.
        """
        known = {k: v for k, v in self.known.items() if self.folder / k[1] not in files}
        is_named = self.folder / "package.xml" in files
        name = package_name(self.folder) if is_named else self.name
        return replace(self, name=name or self.name, workspace=workspace, known=known)

    @property
    def paths(self) -> tuple[str, ...]:
        """All files, relative to the package with slashes, without other packages."""
        return self._once(self._paths, "")

    def _paths(self, _: str) -> tuple[str, ...]:
        return tuple(sorted(self._walk()))

    def _walk(self) -> Iterator[str]:
        folders, files = 0, 0
        for folder, inner, names in os.walk(self.folder):
            below = os.path.relpath(folder, self.folder).replace(os.sep, "/")
            folders += 1
            nested = below != "." and "package.xml" in names
            if (
                folders > limits.PACKAGE_FOLDERS.value
                or nested
                or below.count("/") >= limits.PACKAGE_DEPTH.value
            ):
                inner.clear()
            if nested:
                continue
            inner[:] = sorted(
                n for n in inner if n not in _SKIPPED and not n.startswith(".")
            )
            for name in names:
                files += 1
                if files <= limits.PACKAGE_FILES.value:
                    yield name if below == "." else f"{below}/{name}"

    def ending(self, *endings: str) -> list[str]:
        """Return the files with one of these endings, at most fifty."""
        return [path for path in self.paths if path.endswith(endings)][:50]

    def text(self, path: str) -> str | None:
        """Return the text of a file; None for an unreadable or very large one."""
        return self._once(self._read, path)

    def _read(self, path: str) -> str | None:
        file = self.folder / path
        self.read.add(file)
        if (text := unsaved_text(file)) is not None:
            return text
        if not self.trusted and not is_below(file, [self.folder.resolve()]):
            return None
        try:
            return read_limited(file, limits.PACKAGE_TEXT.value).decode("utf-8")
        except (OSError, ValueError):
            return None

    def shown(self, path: str) -> str:
        """Return a path as the user would write it."""
        return shown(self.folder / path, self.relative)

    @cached_property
    def launches(self) -> tuple[LaunchFile, ...]:
        """The Python launch files."""
        named = self.ending("launch.py")
        # Others in a folder launch, such as launch/sim.py, if they describe a launch.
        inside = [p for p in self.ending(".py") if "launch" in p.split("/")[:-1]]
        paths = dict.fromkeys([*named, *inside])
        read = (self._once(self._launch, path) for path in paths)
        return tuple(launch for launch in read if launch is not None)

    def _launch(self, path: str) -> LaunchFile | None:
        text = self.text(path)
        if not path.endswith("launch.py") and _ENTRY not in (text or ""):
            return None
        return read_launch(text, path, self.shown(path)) if text else None

    def actions(self, path: str) -> tuple[Action, ...] | None:
        """Return the actions of a launch file; None for an unreadable one."""
        return self._once(self._actions, path)

    def _actions(self, path: str) -> tuple[Action, ...] | None:
        # Import late: many packages have no launch files.
        from sambot_viz.checks.around.launching.read import read_actions

        launch = next((f for f in self.launches if f.path == path), None)
        if launch is not None:
            return launch.values.actions
        file = next((f for f in self.yaml_files if f.path == path), None)
        return read_actions(self.text(path) or "", path, self.shown(path), file)

    @cached_property
    def frontends(self) -> tuple[Element, ...]:
        """The <launch> of each launch file in XML or YAML."""
        read = (self._once(self._root, path) for path in self.ending(*_OTHER_LAUNCHES))
        return tuple(root for root in read if root is not None)

    def _root(self, path: str) -> Element | None:
        from sambot_viz.checks.around.launching.read import read_root

        return read_root(self.text(path) or "", path, self.shown(path))

    @cached_property
    def launch_paths(self) -> dict[str, tuple[str, ...]]:
        """Launch file → the paths in packages that it names, such as package://p/x."""
        found = {
            launch.path: tuple(fact.value for fact in launch.paths)
            for launch in self.launches
        }
        for path in self.ending("launch.py", *_OTHER_LAUNCHES):
            if path not in found:
                found[path] = tuple(_named_in(self.text(path) or ""))
        return found

    @cached_property
    def uses(self) -> frozenset[str]:
        """The packages that its launch files name."""
        return frozenset(
            value.removeprefix(SHARE).partition("/")[0]
            for values in self.launch_paths.values()
            for value in values
        )

    def knows(self, name: str) -> bool:
        """Return whether there is another package of that name, here or installed."""
        return self.workspace is not None and self.workspace.is_known(name)

    @cached_property
    def used(self) -> tuple[Package, ...]:
        """The packages of the workspace that its launch files name."""
        if self.workspace is None:
            return ()
        found = (self.workspace.named(name) for name in sorted(self.uses))
        return tuple(package for package in found if package is not None)

    @cached_property
    def configs(self) -> dict[str, YamlFile]:
        """The RViz configs that are YAML, by their paths."""
        read = map(self.yaml, self.ending(".rviz"))
        return {file.path: file for file in read if file is not None}

    @cached_property
    def yaml_files(self) -> tuple[YamlFile, ...]:
        """The YAML files."""
        return tuple(self._yaml_files())

    def _yaml_files(self) -> Iterator[YamlFile]:
        for path in self.ending(*_YAML):
            read = None if _WITHOUT_PARAMETERS.search(path) else self.yaml(path)
            if read is not None:
                yield read

    def yaml(self, path: str) -> YamlFile | None:
        """Return a file of any ending as YAML; None when it is not."""
        return self._once(self._yaml, path)

    def _yaml(self, path: str) -> YamlFile | None:
        text = self.text(path)
        return read_yaml(text, path, self.shown(path)) if text else None

    @property
    def manifest(self) -> Element | None:
        """The root of package.xml; None for a missing or broken one."""
        return self._once(self._manifest, "package.xml")

    def _manifest(self, name: str) -> Element | None:
        try:
            return parse_xml(self.text(name) or "", name)
        except XmlFault:
            return None

    @property
    def cmake(self) -> CMakeFile | None:
        """CMakeLists.txt; None for a missing or very long one."""
        return self._once(self._cmake, "CMakeLists.txt")

    def _cmake(self, name: str) -> CMakeFile | None:
        text = self.text(name)
        if text is None or len(text) > limits.BUILD_FILE.value:
            return None
        return CMakeFile(text, self.shown(name))

    @property
    def is_python(self) -> bool:
        """True when package.xml makes colcon build it by setup.py."""
        elements = self.manifest.iter() if self.manifest is not None else ()
        kinds = (e.text.strip() for e in elements if e.tag == "build_type")
        return "ament_python" in kinds

    @cached_property
    def is_ros1(self) -> bool:
        """True when only catkin builds it: it is not for ROS 2."""
        root = self.manifest
        if root is None:
            return False
        kinds = (e.text for e in root.iter() if e.tag == "build_type")
        tools = root.find_all("buildtool_depend")
        return not any("ament" in kind for kind in kinds) and {
            tool.text.strip() for tool in tools
        } == {"catkin"}

    @property
    def setup(self) -> SetupFile | None:
        """setup.py; None for a missing, broken or very long one."""
        return self._once(self._setup, "setup.py")

    def _setup(self, name: str) -> SetupFile | None:
        text = self.text(name) if name in self.paths else None
        if text is None or len(text) > limits.BUILD_FILE.value:
            return None
        # Import late: most packages have none.
        from sambot_viz.checks.around.setup_file import read_setup

        return read_setup(text, self.shown(name), self.folder, trusted=self.trusted)


class Workspace:
    """Finds packages, and makes each once.

    Args:
        start: the folder of the model, or the package.
        package_path: as for `check`.
        given: folders whose packages belong to the check.
        relative: as for `Package`.
        trusted: False finds only the package of the model.
        read: as for `Package`.
    """

    def __init__(
        self,
        start: Path,
        package_path: Sequence[Path | str] = (),
        given: Sequence[Path | str] = (),
        *,
        relative: bool = True,
        trusted: bool = True,
        read: set[Path] | None = None,
    ) -> None:
        self._index = PackageIndex(start, package_path)
        self._start = start
        self._package_path = package_path
        self._given = PackageIndex(None, given)
        self._chosen = {Path(folder).resolve() for folder in given}
        self._made: dict[Path, Package] = {}
        self.relative = relative
        self._trusted = trusted
        self._read = set[Path]() if read is None else read

    @cached_property
    def _resolver(self) -> FileResolver:
        # Import late: few checks look for a file of an unknown package.
        from sambot_viz.robot.packages.resolve import FileResolver

        return FileResolver(self._index, self._start)

    def at(self, folder: Path) -> Package | None:
        """Return the package in a folder; None for other folders."""
        key = folder.resolve()
        if key not in self._made:
            name = package_name(folder)
            self._read.add(folder / "package.xml")
            if name is None:
                return None
            absolute = folder.absolute()
            self._made[key] = Package(
                absolute, name, self.relative, self._trusted, self._read, self
            )
        return self._made[key]

    def edited(self, files: Collection[Path]) -> Workspace:
        """Return the workspace as it is when some files have other texts.

        See `Package.edited`; which packages are given stays.
        """
        other = copy(self)
        # What is known of the packages is that of their files before.
        for name in ("given", "_resolver"):
            other.__dict__.pop(name, None)
        other._made = {f: p.edited(other, files) for f, p in self._made.items()}
        if any(p.name != self._made[f].name for f, p in other._made.items()):
            other._index = PackageIndex(self._start, self._package_path)
        return other

    @cached_property
    def given(self) -> tuple[Package, ...]:
        """The packages at and below the folders that the user gave."""
        folders = self._given.below().values() if self._trusted else ()
        # Models of Gazebo have no package.xml.
        found = (self.at(f) for f in folders if (f / "package.xml").is_file())
        return tuple(package for package in found if package is not None)

    def is_chosen(self, package: Package) -> bool:
        """Return whether the user gave this very package, not a folder above it."""
        return package.folder.resolve() in self._chosen

    def named(self, name: str) -> Package | None:
        """Return a package of the workspace; None for one that is only installed."""
        lookup = self._index.find(name) if self._trusted else None
        if lookup is None or lookup.path is None or lookup.installed:
            return next((p for p in self.given if p.name == name), None)
        return self.at(lookup.path)

    def is_known(self, name: str) -> bool:
        """Return whether there is a package of that name, here or installed."""
        path = self._index.find(name).path if self._trusted else None
        # A folder with that name, such as rviz, is not enough.
        found = path is not None and (path / "package.xml").is_file()
        return found or any(package.name == name for package in self.given)

    def file(self, value: str) -> Path | None:
        """Return the file at a path such as package://p/urdf/x.urdf."""
        name, _, below = value.removeprefix(SHARE).partition("/")
        package = next((p for p in self.given if p.name == name), None)
        if package is None:
            found = self._resolver.resolve(value)
            doubtful = found.missing_package or found.doubt == "letter-case"
            return None if doubtful else found.path
        if (package.folder / below).is_file():
            return package.folder / below
        from sambot_viz.robot.packages.resolve import inside_package

        return inside_package(package.folder, PurePosixPath(below), ())

    def shown(self, path: Path) -> str:
        """Return a path as the user would write it."""
        return shown(path, self.relative)


def shown(path: Path, relative: bool) -> str:
    """Return a path as the user would write it."""
    return relative_path(path) if relative else str(path)


def _named_in(text: str) -> Iterator[str]:
    """Yield the paths in packages that an XML or YAML launch file names.

    In a broken launch file, each file may be in each of the packages.
    """
    for found in _IN_SHARE.finditer(text):
        yield f"{SHARE}{found[1] or found[3]}{found[2] or found[4]}"
    for package in dict.fromkeys(_SHARE_CALL.findall(text)):
        for file in dict.fromkeys(_QUOTED_FILE.findall(text)):
            yield f"{SHARE}{package}/{file}"
