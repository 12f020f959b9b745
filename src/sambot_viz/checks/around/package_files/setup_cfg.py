"""Check setup.cfg: the installed place of programs of a Python package."""

from __future__ import annotations

import configparser
from collections.abc import Iterator

from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.setup_file import SetupFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import together, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest

_FILE = "setup.cfg"
_SCRIPTS = (("develop", "script_dir"), ("install", "install_scripts"))
_IN_BASE = "$base/lib/"


def programs_elsewhere(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report a setup.cfg that does not install programs where ros2 run looks."""
    name = around.files.name
    if not setup.programs or around.cmake is not None:
        return
    text = around.files.text(_FILE) or ""
    config = configparser.RawConfigParser(strict=False)
    try:
        config.read_string(text)
    except configparser.MissingSectionHeaderError as error:
        place = Place(around.files.shown(_FILE), error.lineno)
        option = error.line.partition("=")[0].strip()
        section = next((s for s, o in _SCRIPTS if o == option), "develop")
        hint = f"add [{section}] before it"
        yield Problem.at(
            place,
            "error",
            "setup-cfg-folder",
            "this line of setup.cfg is in no section: colcon build stops",
            write_between(place, place, f"[{section}]\n", hint),
        )
        return
    except configparser.Error:
        return
    said = {
        option: config.get(section, option, fallback="")
        or config.get(section, option.replace("_", "-"), fallback="")
        for section, option in _SCRIPTS
    }
    right = f"{_IN_BASE}{name}"
    wrong = {
        value
        for value in said.values()
        if value.startswith(_IN_BASE) and value.strip("/") != right
    }
    program = setup.programs[0]
    for value in sorted(wrong):
        lines = [n for n, row in enumerate(text.splitlines(), 1) if value in row]
        place = Place(around.files.shown("setup.cfg"), lines[0])
        also = f" and in line {lines[1]}" if len(lines) > 1 else ""
        places = (Place(place.file, line) for line in lines)
        hint = f"write {right} here{also}"
        yield Problem.at(
            place,
            "error",
            "setup-cfg-folder",
            f"setup.cfg installs the programs into {value.removeprefix('$base/')}, but "
            f"the package is called {name}: ros2 run does not find "
            f"{listed(p.name for p in setup.programs)} "
            f"({where(setup.place(program.node), place)})",
            together(hint, *(write(at, value, right) for at in places)),
        )
    has_file = around.files.text("setup.cfg") is not None
    for section, option in _SCRIPTS if setup.given("options") is None else ():
        needed = section == "install" and (_used(around) or around.files.is_python)
        if not said[option] and (has_file or needed):
            yield _not_said(section, option, right, around, setup)


def _used(around: Surroundings) -> bool:
    """Return whether a launch file of the package starts a program of it."""
    return any(
        launch.text(call, "package") == around.files.name
        for launch in around.launches
        for call in launch.called()
    )


def _not_said(
    section: str, option: str, right: str, around: Surroundings, setup: SetupFile
) -> Problem:
    """Report programs installed into bin, where only a shell finds them."""
    when = "" if section == "install" else " after colcon build --symlink-install"
    program = setup.place(setup.programs[0].node)
    text = around.files.text(_FILE)
    return Problem.at(
        program if text is None else Place(around.files.shown(_FILE), 1),
        "warning" if when else "error",
        "setup-cfg-folder",
        f"setup.cfg has no {option} in [{section}], so that the programs are installed "
        f"into bin{when}: ros2 run does not find "
        f"{listed(sorted(each.name for each in setup.programs))}",
        Fix(f"write {option}={right} below [{section}] in setup.cfg")
        if text is None
        else _written(section, option, right, text, around.files.shown(_FILE)),
    )


def _written(section: str, option: str, right: str, text: str, file: str) -> Fix:
    """Return the fix that adds an option to a section of setup.cfg."""
    hint = f"write {option}={right} below [{section}] in setup.cfg"
    headers: dict[str, int] = {}
    last = ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("["):
            last = line.strip(" []")
            headers[last] = number
            continue
        said = line.partition("=")[0].strip()
        place = Place(file, number, 1)
        if nearest(said, [option], 0.8) is None or not last:
            continue
        if last == section:
            return write(place, said, option, hint=f"write {option} for {said}")
        if nearest(last, [section], 0.7) is not None:
            at = Place(file, headers[last])
            return write(at, last, section, hint=f"write [{section}] for [{last}]")
        return write_between(
            place, place, f"[{section}]\n", f"write [{section}] before line {number}"
        )
    if section in headers:
        at = Place(file, headers[section] + 1, 1)
        return write_between(at, at, f"{option}={right}\n", hint)
    end = Place(file, text.count("\n") + 2)
    begin = "" if text.endswith("\n") else "\n"
    return write_between(end, end, f"{begin}[{section}]\n{option}={right}\n", hint)
