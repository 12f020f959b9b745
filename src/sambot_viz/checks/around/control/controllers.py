"""Controllers of ros2_control: their names and classes, and who asks for them."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise

from sambot_viz.checks.around.files.parameters import (
    Parameter,
    YamlFile,
    controller_types,
)
from sambot_viz.checks.around.parameters.known import known_parameters
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_MANAGER = "controller_manager"
_WITH_VALUE = frozenset(
    """
    -c --controller-manager -p --param-file -t --controller-type -n --namespace
    --controller-manager-timeout --switch-timeout --service-call-timeout
    --controller-ros-args
    """.split()
)
"""Options of the spawner that have a value."""
_FILES = frozenset({"-p", "--param-file"})
_OPTION = re.compile(r"--?[a-z-]*")
_GENERIC = frozenset({"broadcaster", "controller"})
"""Words that many names share."""
_LIKENESS, _LIKE_CLASS = 0.9, 0.5


def declared_controllers(around: Surroundings) -> dict[str, Parameter]:
    """Return the controllers that a controller manager knows, by their names."""
    return controller_types(around.yaml_files)


def _meant(name: str, names: Iterable[str]) -> str | None:
    """Return the name with all words of another, or the most similar one."""
    words = set(name.split("_"))
    for other in names:
        if len(words) > 1 and words < set(other.split("_")):
            return other
    return nearest(name, names, _LIKENESS)


def undeclared_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report controllers whose spawner or parameters use another name."""
    every = declared_controllers(around)
    if not every:
        return
    spawners = list(_spawners(around))
    foreign = around.ownership.foreign
    of_robot = declared_controllers(around.of_robot) if foreign else every
    for node in spawners:
        words = [word for word, _ in node.placed_arguments]
        own = _own_parameters(around, node)
        if None in words or "-t" in words or (own is None and _has_own(words)):
            # Its own parameters are unknown.
            continue
        known = every if node.launch in foreign else of_robot
        given = controller_types([own]) if own is not None else known
        beside = (each for each in spawners if each.launch == node.launch)
        asked = {name for each in beside for name, _ in _asked(each)}
        free = [name for name in given if name not in asked]
        inside = {key.rpartition("/")[2] for key in own.nodes} if own else set[str]()
        lost = asked.difference(known, given, inside)
        for name, place in _asked(node):
            if name not in lost:
                continue
            near = _meant(name, given)
            is_single = near is None and len(free) == len(lost) == 1
            only = free[0] if is_single else None
            if only is not None and (own or _is_only(around, name, given[only], only)):
                near = only
            if near is not None:
                yield _undeclared(name, near, given[near], place, of_file=bool(own))
    yield from _unread_sections(around)


def _undeclared(
    name: str, near: str, right: Parameter, place: Place, *, of_file: bool
) -> Problem:
    knows = "its --param-file has" if of_file else "the controller manager knows"
    return Problem.at(
        place,
        "warning",
        "controller-unknown",
        f"the spawner asks for the controller {name}, but {knows} {near} "
        f"({where(right.place, place)}): it waits, and the controller does not start",
        write(place, name, near),
    )


def _spawners(around: Surroundings) -> Iterator[RunningNode]:
    known = known_nodes().nodes
    for node in around.running.started:
        program = known.get((node.package, node.executable))
        if program is not None and program.does("spawns"):
            yield node


def _has_own(words: Collection[str | None]) -> bool:
    return not _FILES.isdisjoint(words)


def _own_parameters(around: Surroundings, node: RunningNode) -> YamlFile | None:
    """Return the only --param-file of a spawner; None where it is not known."""
    words = [word or "" for word, _ in node.placed_arguments]
    paths = [after for word, after in pairwise(words) if word in _FILES]
    named = around.named(paths[0]) if len(paths) == 1 else None
    own = installed_as(*named) if named is not None else None
    shown = named[0].shown(own) if named is not None and own is not None else None
    return next((file for file in around.yaml_files if file.shown == shown), None)


def _is_only(around: Surroundings, name: str, right: Parameter, free: str) -> bool:
    """Return whether a name can only mean the one controller that none asks for.

    The model names the file with this controller, or the names share a word, or one
    with the class, and no unknown node is a controller manager with others.
    """
    sections = {key.rpartition("/")[2] for f in around.yaml_files for key in f.nodes}
    of_model = {
        posixpath.basename(fact.value)
        for plugin in around.plugins
        for fact in plugin.all("parameters")
    }
    said = {*free.split("_"), *right.fact.value.partition("/")[0].split("_")}
    shares = bool({*name.split("_")} & said - _GENERIC)
    is_of_model = posixpath.basename(right.place.file) in of_model
    is_it = is_of_model or (shares and around.running.is_whole)
    return is_it and name not in sections


def options_without_value(around: Surroundings) -> Iterator[Problem]:
    """Report an option of a spawner whose value is missing."""
    for node in _spawners(around):
        words = [*node.placed_arguments, ("--", node.place)]
        for (word, place), (after, _) in pairwise(words):
            if word in _WITH_VALUE and _OPTION.fullmatch(after or ""):
                yield Problem.at(
                    place,
                    "error",
                    "controller-unknown",
                    f"{word} of the spawner has no value after it: the spawner stops "
                    "with an error",
                    f"write the value after {word}, or delete {word}",
                )


def _asked(node: RunningNode) -> Iterator[tuple[str, Place]]:
    """Yield the controllers that a spawner asks for, with their places."""
    before = ""
    for word, place in node.placed_arguments:
        name, option, before = word or "", before, word or ""
        if name and not name.startswith("-") and option not in _WITH_VALUE:
            yield name, place


def _fitting(
    given: Iterable[str], free: Iterable[str], declared: dict[str, Parameter]
) -> str | None:
    """Return the only controller that knows most of these parameters."""
    names = [name for name in given if name != "use_sim_time"]
    found: list[str] = []
    for other in free:
        kind = known_parameters().classes.get(declared[other].fact.value)
        known = [n for n in names if kind is not None and kind.block.find(n)]
        if len(known) > 1 and len(known) >= 0.8 * len(names):
            found.append(other)
    return found[0] if len(found) == 1 else None


def _unread_sections(around: Surroundings) -> Iterator[Problem]:
    """Report parameters for a controller that no controller manager knows."""
    for file in around.yaml_files:
        own = controller_types([file])
        sections = {key.rpartition("/")[2] for key in file.nodes}
        free = [name for name in own if name not in sections]
        for key in file.nodes:
            name = key.rpartition("/")[2]
            if name in own or name == _MANAGER or "*" in name:
                continue
            near = _meant(name, free) or _fitting(file.of(key), free, own)
            place = file.keys.get(key, file.nodes[key])
            if near is not None:
                yield Problem.at(
                    place,
                    "warning",
                    "controller-unknown",
                    f"no controller is called {name}: the controller manager knows "
                    f"{near} ({where(own[near].place, place)}), which has no "
                    "parameters then",
                    write(place, name, near),
                )


def unknown_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report classes of controllers that their package does not have."""
    classes = vocabulary("controllers")
    packages = {name.partition("/")[0] for name in classes}
    # Each robot may have its own file with controllers of the same names.
    files = (controller_types([file]) for file in around.yaml_files)
    for parameter in (one for found in files for one in found.values()):
        kind = parameter.fact.value
        package = kind.partition("/")[0]
        # Other packages have their own.
        right = next((name for name in packages if is_one_slip(package, name)), None)
        alike = [name for name in classes if name.startswith(f"{right}/")]
        near = nearest(kind, alike, _LIKE_CLASS) if kind not in classes else None
        was = f"was:{kind}"
        near = next((name for name, words in classes.items() if was in words), near)
        whole = [] if near else _whole_classes(kind, classes)
        if near is not None or whole:
            first, *more = [near] if near is not None else whole
            yield Problem.at(
                parameter.value_place,
                "warning",
                "controller-unknown",
                f"{kind} is no class of a controller, which is written as "
                "package/class: the controller manager cannot load it"
                if whole
                else f"{right or package} has no controller {kind}: the controller "
                "manager cannot load it",
                Fix(f"write {first} or {' or '.join(more)}")
                if more
                else write(parameter.value_place, kind, first),
            )


def _whole_classes(kind: str, classes: Iterable[str]) -> list[str]:
    """Return the classes with the words of one that is not package/class."""
    package, slash, name = kind.partition("/")
    if slash and package.islower() and name:
        return []
    said = [word for word in re.split(r"\W+", kind.lower()) if word]
    parts = {each: each.lower().split("/") for each in classes}
    found = [n for n, p in parts.items() if said in (p, p[::-1], p[:1], p[1:])]
    near = nearest(said[-1] if said else "", [p[1] for p in parts.values()], _LIKENESS)
    return found or [each for each, (_, last) in parts.items() if last == near]
