"""Report plugins that Gazebo cannot load, and drive settings that it cannot read."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from sambot_viz.checks.around.files.gazebo import Fact, Plugin, facts, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import exchange_attributes, write, write_attribute
from sambot_viz.errors import Fix, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_FILE = re.compile(r"(?:lib)?(gz-sim\d*|ignition-gazebo\d*)-([a-z-]+)-system(?:\.so)?")
_LIKE_FILE = re.compile(r"(lib)?(gz-sim\d*|ignition-gazebo\d*)[-_]([\w-]+?)(\.so)?")
_LIKENESS = 0.8
_SPACE = {"gz": "gz::sim::systems", "ignition": "ignition::gazebo::systems"}
_NUMBERS = (
    "wheel_separation",
    "wheel_radius",
    "wheel_diameter",
    "wheelSeparation",
    "wheelDiameter",
    "odom_publish_frequency",
    "update_rate",
)
_COMMA = re.compile(r"-?\d+,\d+")


def attributes(system: str) -> str:
    """Return the attributes of a plugin that loads a system, such as "diff-drive"."""
    (name,) = vocabulary("gz_systems")[system]
    name = f"{_SPACE['gz']}::{name}"
    return f'filename="gz-sim-{system}-system" name="{name}"'


def unknown_systems(robot: Robot) -> Iterator[Problem]:
    """Report plugins of a model that Gazebo does not load."""
    found = list(plugins(robot.gazebo))
    for plugin in found:
        beside = [p.filename for p in found if p is not plugin]
        problem = faulty_system(plugin.element, beside)
        other = among_others(plugin, found)
        if problem is not None and other is None:
            yield problem
        elif (
            problem is not None
            and other is not None
            and not any(both_generations(robot))
        ):
            yield Problem.at(
                plugin.element.place,
                "warning",
                "gazebo-generation",
                f"{plugin.filename} is for Gazebo, and the other plugins, such as "
                f"{other.filename} ({where(other.element.place, plugin.element.place)})"
                ", are for Gazebo Classic: one simulator loads only its own",
                "write the plugin of Gazebo Classic",
            )


def among_others(plugin: Plugin, found: Sequence[Plugin]) -> Plugin | None:
    """Return one of the other plugins, where all except this one are for Classic.

    Then its presence is the fault, not its name.
    """
    others = [p for p in found if p.generation and p.element is not plugin.element]
    if plugin.generation != "gz" or any(p.generation == "gz" for p in others):
        return None
    return next(iter(others), None)


def faulty_system(plugin: Element, beside: Collection[str]) -> Problem | None:
    """Report a misspelt system of Gazebo, or the name of another class.

    Args:
        plugin: loads the system.
        beside: the files of the other plugins there.
    """
    filename = plugin.get("filename") or ""
    name = (plugin.get("name") or "").strip()
    near, right = near_system(filename), _class_of(filename)
    if "::" in filename and _FILE.fullmatch(name) is not None:
        what = f"{filename} is a class and {name} its file: Gazebo finds no such file"
        edits = exchange_attributes(plugin.place, "filename", "name")
        fix = Fix(f'write filename="{name}" and name="{filename}"', edits)
    elif near is not None:
        what = f"Gazebo has no plugin {filename}: it does not load it"
        fix = write_attribute(plugin.place, "filename", filename, near)
    elif right is not None and not _is_class(name, right):
        holds = _file_of(name, filename)
        what = (
            f"{filename} has no class {name or 'without a name'}: in Gazebo the name "
            "of a plugin is that of its class, and it does not load this one"
        )
        fix = write_attribute(plugin.place, "name", name, right)
        is_copied = holds in beside and filename not in beside
        if holds is not None and holds != filename and not is_copied:
            fix = write_attribute(plugin.place, "filename", filename, holds)
    else:
        return None
    return Problem.at(plugin.place, "warning", "gazebo-plugin", what, fix)


def _is_class(name: str, right: str) -> bool:
    """Return whether a name is a class in a namespace of Gazebo."""
    space, _, last = name.rpartition("::")
    plain = re.sub(r"::v\d+(?=::|$)", "", space)
    return last == right.rpartition("::")[2] and plain in ("", *_SPACE.values())


def _class_of(filename: str) -> str | None:
    """Return the class in a file of Gazebo; None for an unknown file."""
    file = _FILE.fullmatch(filename)
    classes = vocabulary("gz_systems").get(file[2], ()) if file else ()
    if file is None or not classes:
        return None
    return f"{_SPACE[file[1].partition('-')[0]]}::{classes[0]}"


def _file_of(name: str, filename: str) -> str | None:
    """Return the file with the class of a plugin, in the naming of another file."""
    file, last = _FILE.fullmatch(filename), name.rpartition("::")[2]
    systems = vocabulary("gz_systems").items()
    holds = next((system for system, classes in systems if last in classes), None)
    if file is None or holds is None:
        return None
    return f"{filename[: file.start(2)]}{holds}{filename[file.end(2) :]}"


def near_system(filename: str) -> str | None:
    """Return the file that a missing one misspells, or None."""
    file = _LIKE_FILE.fullmatch(filename)
    if file is None:
        return None
    name = file[3].replace("_", "-")
    head, _, last = name.rpartition("-")
    if nearest(last, ["system"], _LIKENESS):
        name = head
    near = nearest(name, vocabulary("gz_systems"), _LIKENESS)
    if near is not None and {*near.split("-")} < {*name.split("-")}:
        # A name with one more word, such as yarp-forcetorque, is from another package.
        return None
    better = f"{file[1] or ''}{file[2]}-{near}-system{file[4] or ''}"
    return None if near is None or better == filename else better


def both_generations(robot: Robot) -> Iterator[Problem]:
    """Report a drive of Gazebo Classic among plugins of Gazebo, or the reverse."""
    found = [plugin for plugin in plugins(robot.gazebo) if plugin.generation]
    drives = [plugin for plugin in found if plugin.is_drive]
    others = [plugin for plugin in found if not plugin.is_drive]
    if len({plugin.generation for plugin in drives}) != 1:
        return
    drive = drives[0]
    if not others or drive.generation in {plugin.generation for plugin in others}:
        return
    yield Problem.at(
        drive.element.place,
        "warning",
        "gazebo-generation",
        f"{drive.filename} is for {_NAMES[drive.generation == 'gz']}, and the other "
        f"plugins, such as {others[0].filename} "
        f"({where(others[0].element.place, drive.element.place)}), are for "
        f"{_NAMES[drive.generation != 'gz']}: one simulator loads only its own, and "
        "the robot does not drive",
        f"write {_DRIVES[drive.generation != 'gz']}, and the elements that it reads",
    )


_NAMES = ("Gazebo Classic", "Gazebo")
_DRIVES = (
    'filename="libgazebo_ros_diff_drive.so"',
    attributes("diff-drive"),
)


def malformed_values(robot: Robot) -> Iterator[Problem]:
    """Report numbers of a drive with a comma or a unit, and misspelt true or false."""
    for plugin in plugins(robot.gazebo):
        for element in plugin.element.iter() if plugin.generation else ():
            said = element.text.strip()
            near = [w for w in ("true", "false") if is_one_slip(said.lower(), w)]
            if near and not element.children and said.lower() != near[0]:
                yield Problem.at(
                    element.place,
                    "warning",
                    "gazebo-plugin",
                    f"<{element.tag}>{said}</{element.tag}> of {plugin.filename} is "
                    "neither true nor false: Gazebo uses another value",
                    write(element.place, said, near[0]),
                )
        for fact in facts(plugin.element, *_NUMBERS) if plugin.is_drive else ():
            if fact.number is None:
                yield _malformed(plugin, fact)


def _malformed(plugin: Plugin, fact: Fact) -> Problem:
    comma = _COMMA.fullmatch(fact.value)
    return Problem.at(
        fact.place,
        "warning",
        "gazebo-plugin",
        f"{fact.value} is no number for {plugin.filename} "
        f"({where(plugin.element.place, fact.place)}): Gazebo uses another value",
        write(fact.place, fact.value, fact.value.replace(",", "."))
        if comma
        else "write a number alone",
    )
