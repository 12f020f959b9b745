"""Report maps that map_server cannot load, and their images in place of them."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import YamlFile, pairs, place_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.edits import exchange, write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_MAP = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
_ENOUGH = len(_MAP) - 2
"""Number of these keys from which a file is a map."""
_MODES = ("trinary", "scale", "raw")
_IMAGES = (".pgm", ".png", ".bmp", ".jpg")


def maps_that_do_not_load(around: Surroundings) -> Iterator[Problem]:
    """Report maps without an existing image, or without a required value."""
    for package in around.packages:
        for path in package.ending(".yaml", ".yml"):
            file = _map_file(package, path)
            if file is None:
                continue
            values = {key.value: (key, value) for key, value in pairs(file.root)}
            for name in _MAP:
                if name not in values:
                    yield _no_value(file, name, list(values))
            yield from _other_mode(file, values.get("mode"))
            yield from _exchanged(file)
            _, image = values.get("image", (None, None))
            said = image.value if isinstance(image, yaml.ScalarNode) else ""
            below = path.rpartition("/")[0]
            there = f"{below}/{said}".lstrip("/")
            beside = [
                p for p in package.ending(*_IMAGES) if p.rpartition("/")[0] == below
            ]
            # Without any image, all of them may come from another folder.
            if image is None or said[:1] == "/" or not beside:
                continue
            place = place_of(image, file.shown)
            right = beside[0].rpartition("/")[2] if len(beside) == 1 else ""
            if not (package.folder / there).exists():
                yield Problem.at(
                    place,
                    "error",
                    "parameter-value",
                    f"this map has the image {said}, which is not beside it: "
                    "map_server stops with an error",
                    write(place, said, right) if right else "add that image",
                )


def images_for_maps(around: Surroundings) -> Iterator[Problem]:
    """Report the image of a map that a launch file names in place of the map."""
    for launch in around.launches:
        for fact in launch.paths:
            stem, dot, ending = fact.value.rpartition(".")
            beside = f"{stem}.yaml"
            if f"{dot}{ending}" not in _IMAGES or around.text(beside) is None:
                continue
            name = fact.value.rpartition("/")[2]
            right = f"{name.removesuffix(ending)}yaml"
            yield Problem.at(
                fact.place,
                "warning",
                "parameter-value",
                f"{name} is the image of a map, and map_server reads the map, "
                f"{right}, which names it: map_server stops with an error",
                write(fact.place, name, right),
            )


def _exchanged(file: YamlFile) -> Iterator[Problem]:
    """Report a free_thresh above the occupied_thresh."""
    facts = {
        key.value: Fact(value.value, place_of(value, file.shown))
        for key, value in pairs(file.root)
        if isinstance(value, yaml.ScalarNode)
    }
    free, occupied = facts.get("free_thresh"), facts.get("occupied_thresh")
    if free is None or occupied is None:
        return
    if free.number is not None and occupied.number is not None:
        if free.number > occupied.number:
            yield Problem.at(
                free.place,
                "warning",
                "parameter-value",
                f"free_thresh is {free.value}, and occupied_thresh "
                f"({where(occupied.place, free.place)}) is less: hardly a cell of the "
                "map is free and none unknown",
                exchange(
                    f"exchange {free.value} and {occupied.value}",
                    (free.place, free.value),
                    (occupied.place, occupied.value),
                ),
            )


def _other_mode(
    file: YamlFile, mode: tuple[yaml.Node, yaml.Node] | None
) -> Iterator[Problem]:
    said = mode[1].value if mode and isinstance(mode[1], yaml.ScalarNode) else ""
    if mode is not None and said and said.lower() not in _MODES:
        place = place_of(mode[1], file.shown)
        near = nearest(said.lower(), _MODES)
        yield Problem.at(
            place,
            "error",
            "parameter-value",
            f"a map has no mode {said}, but {', '.join(_MODES)}: map_server stops with "
            "an error",
            write(place, said, near) if near else "write one of these",
        )


def _map_file(package: Package, path: str) -> YamlFile | None:
    """Return a file that has most of what a map has."""
    text = package.text(path) or ""
    if sum(name in text for name in _MAP) < _ENOUGH:
        return None
    file = package.yaml(path)
    keys = [key.value for key, _ in pairs(file.root)] if file is not None else []
    return file if len({*keys}.intersection(_MAP)) >= _ENOUGH else None


def _no_value(file: YamlFile, name: str, given: list[str]) -> Problem:
    near = next((g for g in given if g not in _MAP and is_one_slip(g, name)), "")
    keys = {key.value: key for key, _ in pairs(file.root)}
    place = place_of(keys[near], file.shown) if near else Place(file.shown, 1)
    return Problem.at(
        place,
        "error",
        "parameter-value",
        f"this map has no {name}: map_server stops with an error",
        write(place, near, name) if near else f"add {name}",
    )
