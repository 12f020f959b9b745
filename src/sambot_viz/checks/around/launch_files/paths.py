"""Check files and parameter files that launch files name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.launch_files.braces import braced_names
from sambot_viz.checks.around.launch_files.imports import modules
from sambot_viz.checks.around.launch_files.words import of_ros1
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

OWN_NAMES = {
    "ekf_node": "ekf_filter_node",
    "ukf_node": "ukf_filter_node",
    "navsat_transform_node": "navsat_transform",
    "async_slam_toolbox_node": "slam_toolbox",
    "sync_slam_toolbox_node": "slam_toolbox",
    "ros2_control_node": "controller_manager",
}
"""Programs whose nodes have different names."""

_FOUND = re.compile(r"\$\(find ([\w-]+)\)/([^$\s]+)")
_ASKING = frozenset({"exists", "isfile", "is_file", "write_text"})
_IN_SHARE = re.compile(
    r"(FILES|PROGRAMS|DIRECTORY[^)]*/)\s[^)]*DESTINATION\s+[\"']?(share|\$\{CMAKE_INSTALL_"
    r"DATADIR\})/\$\{PROJECT_NAME\}/?[\"']?\s*\)"
)
"""A command that installs files or the contents of a folder into the share folder."""
_FILE = re.compile(r"[\w/.-]*\.(\w{4,5})")
_ENDINGS = frozenset({"rviz", "urdf", "world", "xacro", "yaml"})
_MODELS = (".urdf", ".xacro", ".sdf")


def missing_files(around: Surroundings) -> Iterator[Problem]:
    """Report files that a launch file names wrongly."""
    python = {launch.shown: launch for launch in around.launches}
    known: set[tuple[str, str]] = set()
    old = {root.place.file for each in around.packages for root in of_ros1(each)}
    for fact in (*_python_paths(around), *around.running.paths):
        package, below = around.named(fact.value) or (None, "")
        key, launch = (fact.place.file, fact.value), python.get(fact.place.file)
        if package is None or key in known or "*" in below or ".." in below:
            continue
        if fact.place.file in old:
            continue
        known.add(key)
        if launch and braced_names(below, launch):
            # The file that is meant has another name.
            continue
        if (launch and _makes_files(launch)) or not _is_missing(below, package):
            continue
        read = _read_by(launch, fact, package) if launch is not None else None
        near = read or _near(below, package.paths)
        if near is not None and _is_installed_as(below, near, package):
            continue
        others = [p.name for p in around.packages if _has_instead(p, below, package)]
        if near is not None:
            yield _missing(
                fact,
                below,
                package,
                f"it has {near}",
                _renamed(fact.place, below, near)
                if read or _is_meant(below, near, package.paths)
                else f"add that file, or write {near} if it is meant",
            )
        elif len(others) == 1:
            yield _missing(
                fact,
                below,
                package,
                f"the package {others[0]} has one",
                f"name the package {others[0]} there",
            )


def missing_plugin_files(around: Surroundings) -> Iterator[Problem]:
    """Report the parameters of a plugin in a file that its package does not have."""
    for plugin in around.plugins:
        for element in plugin.element.find_all("parameters"):
            path = _FOUND.fullmatch(element.text.strip())
            named = around.named(f"{SHARE}{path[1]}/{path[2]}") if path else None
            package, below = named or (None, "")
            near = _near(below, package.paths) if package is not None else None
            if package is None or near is None or not _is_missing(below, package):
                continue
            yield Problem.at(
                element.place,
                "warning",
                "gazebo-plugin",
                f"the plugin {plugin.filename} reads {below}, which the package "
                f"{package.name} does not have; it has {near}",
                _renamed(element.place, below, near)
                if _is_meant(below, near, package.paths)
                else f"add that file, or write {near} if it is meant",
            )


def _has_instead(other: Package, below: str, package: Package) -> bool:
    """Return whether a package has a file that the build of another one lacks."""
    nested = package.folder in other.folder.parents
    return "/" in below and below in other.paths and not nested


def _python_paths(around: Surroundings) -> Iterator[Fact]:
    """Yield the paths in Python files, each at the expression that builds it."""
    for launch in around.launches:
        given = _given_to_others(launch)
        yield from (fact for fact in launch.paths if fact.place not in given)


def _given_to_others(launch: LaunchFile) -> set[Place]:
    """Return the places of what functions of other modules get: they may make it."""
    steps = [s for s in launch.tree.body if isinstance(s, ast.ImportFrom)]
    names = {alias.asname or alias.name for s in steps for alias in s.names}
    foreign = {name for name in names - modules().keys() if name[:1].islower()}
    found: set[Place] = set()
    for call in ast.walk(launch.tree):
        func = call.func if isinstance(call, ast.Call) else None
        if not isinstance(func, ast.Name):
            continue
        made = launch.origin(func)
        is_found = isinstance(made, ast.Call) and call_name(made.func) == "getattr"
        if is_found or func.id in foreign:
            inner = ast.walk(call)
            found.update(launch.place(n) for n in inner if isinstance(n, ast.expr))
    return found


def _missing(
    fact: Fact, below: str, package: Package, instead: str, fix: str | Fix
) -> Problem:
    own = Path(fact.place.file).absolute().is_relative_to(package.folder)
    whose = "the package" if own else f"the package {package.name}"
    return Problem.at(
        fact.place,
        "warning",
        "launch-file-missing",
        f"the launch file uses {below}, which {whose} does not have; {instead}",
        fix,
    )


def _is_installed_as(below: str, near: str, package: Package) -> bool:
    """Return whether the build may install a file of the same name at a path."""
    folder, _, name = below.rpartition("/")
    if name != PurePosixPath(near).name:
        return False
    cmake, setup = package.text("CMakeLists.txt"), package.setup
    if cmake is not None or setup is None:
        return cmake is not None and near in cmake
    target = f"share/{package.name}/{folder}".rstrip("/")
    to_folder = (e.files.known or () for e in setup.data_files if e.target == target)
    return not setup.installs_only_known or any(near in files for files in to_folder)


def _renamed(place: Place, below: str, near: str) -> Fix:
    """Return the fix that writes another file, even with its folder in another text."""
    old, new = PurePosixPath(below), PurePosixPath(near)
    if not place.file.endswith(".py"):
        return write(place, f"/{below}", f"/{near}", hint=f"write {near}")
    whole = write(place, below, near)
    if whole.edits or old.parent != new.parent:
        return whole
    return write(place, old.name, new.name, hint=f"write {near}")


def _is_meant(below: str, near: str, paths: Sequence[str]) -> bool:
    """Return whether a file is misspelt, or has only one possible correction."""
    folder, kind = PurePosixPath(near).parent, PurePosixPath(near).suffix
    beside = [p for p in paths if PurePosixPath(p).parent == folder]
    stem = PurePosixPath(near).name.partition(".")[0]
    if sum(PurePosixPath(p).name.partition(".")[0] == stem for p in beside) > 1:
        return False
    names = (PurePosixPath(path).name for path in (below, near))
    if is_misspelt(*(name.partition(".")[0] for name in names)):
        return True
    return sum(p.endswith(kind) for p in beside) == 1


def _makes_files(launch: LaunchFile) -> bool:
    """Return whether a launch file asks which files there are, or writes some."""
    return any(
        call.name in _ASKING
        or (call.name == "open" and "w" in (launch.text(call, "mode", 1) or ""))
        for call in launch.calls
    )


def _is_missing(below: str, package: Package) -> bool:
    folder, slash, _ = below.partition("/")
    paths = package.paths
    if below in paths or any(p.startswith(f"{below}/") for p in paths):
        return False
    if not slash:
        names = [path.rpartition("/")[2] for path in paths]
        return names.count(below) == 1 and not _installs_beside_manifest(package)
    inner = any(path.endswith(f"/{below}") for path in paths)
    if inner and _installs_beside_manifest(package):
        return False
    if (package.folder / below).exists():
        # Such as a mesh or a test: the package does not list them.
        return False
    if any(path.startswith(f"{folder}/") for path in paths):
        return True
    # The build may give a folder another name.
    files = ("setup.py", *package.ending("CMakeLists.txt"))
    build = (package.text(name) for name in files)
    return not any(text is not None and folder in text for text in build)


def _installs_beside_manifest(package: Package) -> bool:
    """Return whether the build may install files directly into the share folder."""
    cmake, setup = package.text("CMakeLists.txt"), package.setup
    if cmake is not None:
        return _IN_SHARE.search(cmake) is not None
    if setup is None or not setup.installs_only_known:
        return True
    share = f"share/{package.name}"
    beside = [e for e in setup.data_files if (e.target or "").rstrip("/") == share]
    return any(list(entry.files.known or ()) != ["package.xml"] for entry in beside)


def _read_by(launch: LaunchFile, fact: Fact, package: Package) -> str | None:
    """Return the only file with parameters for the node that gets a missing file."""
    for node in launch.nodes:
        name = node.name or OWN_NAMES.get(node.executable)
        if name and any(given.value == fact.value for given in node.files):
            files = (file for file in package.yaml_files if file.nodes)
            fitting = [file.path for file in files if _has(file, name)]
            return fitting[0] if len(fitting) == 1 else None
    return None


def _near(below: str, paths: Sequence[str]) -> str | None:
    """Return the probable file: of the same kind, with the most similar name."""
    wanted = PurePosixPath(below)
    if not wanted.suffix:
        return None
    kinds = _MODELS if wanted.suffix in _MODELS else (wanted.suffix,)
    alike = [p for p in paths if "/" in p and p.endswith(kinds)]
    same = [p for p in alike if PurePosixPath(p).name == wanted.name]
    if len(same) == 1:
        return same[0]
    beside = [p for p in paths if PurePosixPath(p).parent == wanted.parent]
    stem = wanted.name.partition(".")[0]
    twins = [p for p in beside if PurePosixPath(p).name.partition(".")[0] == stem]
    if len(twins) == 1 or (twins and not alike):
        return nearest(below, twins, likeness=0.0)
    return nearest(below, sorted({*beside} & {*alike}), likeness=0.0)


def _has(file: YamlFile, name: str) -> bool:
    parts = {part for key in file.nodes for part in key.split("/")}
    return not parts or name in parts or any("*" in part for part in parts)


def misspelt_endings(around: Surroundings) -> Iterator[Problem]:
    """Report a misspelt extension of a file name."""
    paths = [path for package in around.packages for path in package.paths]
    endings = {path.rpartition(".")[2] for path in paths}
    for launch in around.launches:
        named = [fact.value for fact in launch.paths]
        for node in ast.walk(launch.tree):
            if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
                continue
            found = _FILE.fullmatch(node.value)
            if found is None or any(name.endswith(found[0]) for name in named):
                # A file with a fully known path has another finding.
                continue
            near = [e for e in _ENDINGS & endings if is_one_slip(found[1], e)]
            if found[1] not in endings and len(near) == 1:
                place, right = launch.place(node), found[0].removesuffix(found[1])
                yield Problem.at(
                    place,
                    "warning",
                    "launch-file-missing",
                    f"no file here ends with .{found[1]}, but others end with "
                    f".{near[0]}: there is no such file",
                    write(place, found[0], right + near[0]),
                )
