"""Compare dependencies in package.xml with ROS packages and started programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.gazebo.both import misplaced_packages
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_CODE = "package-dependency"
_LIKENESS = 0.8


def _started() -> set[str]:
    """Return packages that launch files often start."""
    return {name for name, words in vocabulary("packages").items() if "starts" in words}


def _depends(around: Surroundings) -> list[Element]:
    return _depends_of(around.manifest)


def _depends_of(root: Element | None) -> list[Element]:
    children = root.children if root is not None else []
    return [element for element in children if element.tag.endswith("depend")]


def _place(element: Element, around: Surroundings) -> Place:
    shown = around.files.shown("package.xml")
    return Place(shown, element.place.line, element.place.column)


def misspelt_dependencies(around: Surroundings) -> Iterator[Problem]:
    """Report a dependency that misspells a package of ROS."""
    for element, near in _meant(around).items():
        name, here = element.text.strip(), _place(element, around)
        user = next((one for one in around.launches if near in _words(one)), None)
        if user is not None:
            message = (
                f"package.xml depends on {name}, but {user.path} uses {near}: rosdep "
                f"finds no {name}, and does not install {near}"
            )
        else:
            message = (
                f"package.xml depends on {name}, and no package of ROS is called so; "
                f"there is {near}: rosdep finds no {name}"
            )
        fix = write(here, name, near)
        yield Problem.at(here, "warning", _CODE, message, fix)


def _meant(around: Surroundings) -> Mapping[Element, str]:
    """Return the misspelt dependencies, each with the right package."""
    depends = _depends(around)
    named = {element.text.strip() for element in depends}
    used = {word for launch in around.launches for word in _words(launch)}
    known = vocabulary("packages")
    likely = sorted(used & _started() - named)
    found: dict[Element, str] = {}
    for element in depends:
        name = element.text.strip()
        if name in known or name in used or not name or around.files.knows(name):
            continue
        near = nearest(name, likely, _LIKENESS)
        if near is None or not is_misspelt(name, near):
            near = _of_ros(name)
        if near is not None and near not in named:
            found[element] = near
    return found


def _of_ros(name: str) -> str | None:
    """Return the only package of ROS that differs from a name in one letter."""
    plain = name.lower()
    near = [
        known
        for known in vocabulary("packages")
        if is_one_slip(plain, known) or plain.replace("-", "_") == known
    ]
    is_digit = len(near) == 1 and any(c.isdigit() for c in {*name} ^ {*near[0]})
    return near[0] if len(near) == 1 and not is_digit and len(name) > 3 else None


def missing_dependencies(around: Surroundings) -> Iterator[Problem]:
    """Note well-known packages that launch files start and package.xml does not list.

    A package.xml with fewer than two of them leaves them to other packages.
    """
    depends = _depends(around)
    named = {element.text.strip() for element in depends}
    started = _starts(around)
    # colcon cannot build two packages that depend on each other.
    own = around.files.name
    others = {
        p.name
        for p in around.files.used
        if p.folder != around.files.folder
        and own not in p.uses
        and own not in _brought(around, {p.name})
    }
    known = _started() | others
    listed_here = named & started.keys() & known
    near = {*_meant(around).values(), *misplaced_packages(around)}
    # A dependency may be in an element with a misspelt name.
    root = around.manifest
    near |= {child.text.strip() for child in root.children} if root else set()
    missing = sorted(started.keys() & known - _brought(around, named) - near)
    if missing and len(listed_here) + (len(missing) == 1) > 1:
        here = _place(depends[-1], around)
        lines = [f"<exec_depend>{name}</exec_depend>" for name in missing]
        them = "it" if len(missing) == 1 else "them"
        yield Problem.at(
            here,
            "info",
            _CODE,
            f"launch files use {listed(missing)} "
            f"({where(started[missing[0]], here)}), but package.xml does not depend on "
            f"{them}: rosdep does not install {them}",
            write_between(
                here,
                here,
                "".join(f"{line}\n  " for line in lines),
                f"add {' '.join(lines)}",
            ),
        )


def _starts(around: Surroundings) -> dict[str, Place]:
    """Return the packages that launch files start or look into, each with a place."""
    started: dict[str, Place] = {}
    for launch in around.launches:
        for call in launch.called():
            started.setdefault(launch.text(call, "package") or "", call.place)
        if any(text.startswith("xacro ") for text in launch.strings):
            started.setdefault("xacro", Place(launch.shown, 1))
        for fact in launch.paths:
            name = fact.value.removeprefix(SHARE).partition("/")[0]
            if name != around.files.name:
                started.setdefault(name, fact.place)
    for element in (e for root in around.files.frontends for e in root.iter()):
        if element.get("exec") is not None:
            started.setdefault(element.get("pkg") or "", element.place)
    return started


def _brought(around: Surroundings, named: set[str]) -> set[str]:
    """Return the dependencies, and those of the packages here among them."""
    found, waiting = set[str](), [*named]
    while waiting:
        name = waiting.pop()
        workspace = around.files.workspace
        package = workspace.named(name) if name not in found and workspace else None
        found.add(name)
        if package is not None:
            waiting += [e.text.strip() for e in _depends_of(package.manifest)]
    brought = {each for name in found for each in vocabulary("packages").get(name, ())}
    return found | brought


def _words(launch: LaunchFile) -> set[str]:
    return {word for text in launch.strings for word in text.split()}


def packages_of_ros1(around: Surroundings) -> Iterator[Problem]:
    """Report dependencies of a package of ROS 2 on packages that only ROS 1 has."""
    root = around.manifest
    built = (
        {e.text.strip() for e in root.iter() if e.tag == "build_type"} if root else ()
    )
    if not any(kind.startswith("ament") for kind in built):
        return
    for element in _depends(around):
        name = element.text.strip()
        better = vocabulary("ros1_packages").get(name, ())
        skipped = name in around.names or element.get("condition") is not None
        if not better or skipped:
            continue
        place = _place(element, around)
        yield Problem.at(
            place,
            "warning",
            _CODE,
            f"{name} is a package of ROS 1, and this package is of ROS 2: rosdep does "
            "not find it",
            write(place, name, better[0]),
        )


def misspelt_packages(around: Surroundings) -> Iterator[Problem]:
    """Report a find_package that misspells a dependency or a package of ROS."""
    root, cmake = around.manifest, around.cmake
    if root is None or cmake is None or cmake.fault is not None:
        return
    needed = {element.text.strip() for element in _depends(around)}
    calls = [c for c in cmake.commands if c.name == "find_package" and c.words]
    found = {call.words[0].text for call in calls}
    for call in calls:
        name = call.words[0].text
        # Packages outside ROS have other names there: eigen is Eigen3.
        of_ros = [each for each in needed if "_" in each and "_" in name]
        slips = [each for each in of_ros if is_one_slip(name, each)]
        near = _of_ros(name) or (slips[0] if len(slips) == 1 else None)
        required = "REQUIRED" in (word.text for word in call.words)
        known = name in vocabulary("packages") or name in needed
        if known or near not in needed - found or not required:
            continue
        place = cmake.place(call.words[0].line)
        yield Problem.at(
            place,
            "warning",
            _CODE,
            f"CMake is to find {name}, but package.xml depends on {near}: colcon build "
            f"stops where there is no {name}",
            write(place, name, near),
        )
