"""Report values, planes and included models with which a world does not work."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.gazebo.world_systems import elements_of_worlds
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.rule import number
from sambot_viz.edits import put_into, write
from sambot_viz.errors import Fix, Problem, nearest
from sambot_viz.robot.xml.element import Element

_VECTORS = ("gravity", "magnetic_field")
_ENGINES = ("ogre2", "ogre")
_COMMAS = re.compile(r"(?=.*,)-?\d+([.,]\d+)?(\s+-?\d+([.,]\d+)?)*")
_EARTH, _LIKE_EARTH = 9.81, 0.2
"""Gravity on Earth, and the greatest difference of what people write [m/s²]."""
_LONG_STEP, _MUCH = 0.1, 10.0
"""A step from which wheels and contacts are unstable [s], and the ratio of the speed
that steps and their rate make to the wanted one from which one of them is wrong."""
_OF_CLASSIC = {"sun": "Sun", "ground_plane": "Ground Plane"}
"""Models that come with Gazebo Classic → their names at Fuel."""
_FUEL = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/"


def values_of_worlds(around: Surroundings) -> Iterator[Problem]:
    """Report vectors of a world without three numbers, and unknown engines."""
    for element in elements_of_worlds(around):
        said = element.text.strip()
        if element.tag in _VECTORS and said and len(said.split()) != 3:
            alone = element.tag == "gravity" and len(said.split()) == 1
            right = f"0 0 {said}" if alone else ""
            yield Problem.at(
                element.place,
                "error",
                "sdf-value",
                f"<{element.tag}>{said}</{element.tag}> of the world is not three "
                "numbers: Gazebo does not load the world",
                write(element.place, said, right) if right else "write three numbers",
            )
        elif element.tag == "render_engine" and said not in _ENGINES:
            if nearest(said, _ENGINES) is not None:
                yield Problem.at(
                    element.place,
                    "warning",
                    "world-system",
                    f"Gazebo has no render engine {said}: cameras and lidars send "
                    "nothing",
                    write(element.place, said, _ENGINES[0]),
                )


def numbers_of_worlds(around: Surroundings) -> Iterator[Problem]:
    """Report decimal commas, gravity that points up, and steps in milliseconds."""
    for element in elements_of_worlds(around):
        said = element.text.strip()
        if not element.children and _COMMAS.fullmatch(said):
            yield Problem.at(
                element.place,
                "warning",
                "world-value",
                f"<{element.tag}>{said}</{element.tag}> of the world has a decimal "
                "comma: Gazebo reads the number only up to it",
                write(element.place, said, said.replace(",", ".")),
            )
        elif element.tag == "gravity":
            is_earth = abs(_up(element) - _EARTH) < _LIKE_EARTH
            follows = "all that is not static flies away"
            yield from _upwards(element, follows, {"size"} if is_earth else set())
        elif element.tag == "physics":
            yield from _long_steps(element)


def suns_from_below(around: Surroundings) -> Iterator[Problem]:
    """Report the only directional light of a world, where it shines upwards."""
    suns: dict[str, list[Element]] = {}
    for element in elements_of_worlds(around):
        if element.tag == "light" and element.get("type") == "directional":
            suns.setdefault(element.place.file, []).append(element)
    for (sun,) in (found for found in suns.values() if len(found) == 1):
        pose, direction = sun.find("pose"), sun.find("direction")
        # A turned light has a turned direction.
        is_turned = pose is not None and any(part != 0 for part in _numbers(pose)[3:])
        if direction is not None and not is_turned:
            follows = "the light comes from below, and what is seen from above is dark"
            yield from _upwards(direction, follows, {"alone"})


def _numbers(element: Element) -> list[float | None]:
    return [Fact(part, element.place).number for part in element.text.split()]


def _up(vector: Element) -> float:
    """Return z of a vector; 0 for a text that is no vector."""
    parts = _numbers(vector)
    return (parts[2] or 0.0) if len(parts) == 3 else 0.0


def _upwards(vector: Element, follows: str, clues: Clues) -> Iterator[Problem]:
    """Report a vector that points up, as a guess with one clue more: its sign."""
    said, tag = vector.text.strip(), vector.tag
    if _up(vector) > 0:
        right = f"-{said.split()[2].lstrip('+')}"
        yield guess(
            vector.place,
            "world-value",
            f"<{tag}>{said}</{tag}> points up, because z of the world does: {follows}",
            write(vector.place, said, " ".join((*said.split()[:2], right))),
            {"sign", *clues},
        )


def _long_steps(physics: Element) -> Iterator[Problem]:
    given = {each.tag: each for each in physics.children}
    step, rate, factor = (
        Fact(given[tag].text.strip(), given[tag].place).number if tag in given else None
        for tag in ("max_step_size", "real_time_update_rate", "real_time_factor")
    )
    if step is None or step < _LONG_STEP:
        return
    element = given["max_step_size"]
    said, right = element.text.strip(), step / 1000
    clues = {"size"}
    if rate and step * rate > _MUCH * (factor or 1):
        clues.add("rate")
        right = (factor or 1) / rate
    yield guess(
        element.place,
        "world-value",
        f"<max_step_size>{said}</max_step_size> is {said} s, in which a robot drives "
        "far and wheels sink in: it looks like milliseconds, but Gazebo reads seconds",
        write(element.place, said, number(right)),
        clues,
    )


def planes_that_fall(around: Surroundings) -> Iterator[Problem]:
    """Report models with a plane, such as the ground, that are not static."""
    for world in elements_of_worlds(around):
        for model in world.children if world.tag == "world" else ():
            parts = list(model.iter())
            is_held = any(
                (part.tag == "static" and _is(part, "true", "1"))
                or (part.tag == "gravity" and _is(part, "false", "0"))
                or part.tag in ("joint", "plugin")
                for part in parts
            )
            planes = [
                shape
                for shape in parts
                if shape.tag == "collision"
                and any(each.tag == "plane" for each in shape.iter())
            ]
            if model.tag == "model" and planes and not is_held:
                name = model.get("name") or "without a name"
                static = model.find("static")
                yield Problem.at(
                    (static or model).place,
                    "warning",
                    "world-value",
                    f"the model {name} is a plane and not static: it falls, and the "
                    "robot with it",
                    _made_static(model, static),
                )


def _made_static(model: Element, static: Element | None) -> Fix:
    added = "<static>true</static>"
    said = "" if static is None else static.text.strip()
    if static is None or not said:
        return Fix(f"add {added}", put_into(model.place, added))
    return write(static.place, said, "1" if said == "0" else "true")


def _is(element: Element, *texts: str) -> bool:
    return element.text.strip().lower() in texts


def models_of_classic(around: Surroundings) -> Iterator[Problem]:
    """Report models that come with Gazebo Classic in a world of Gazebo."""
    found = list(elements_of_worlds(around))
    of_gz = {
        element.place.file
        for element in found
        if element.tag == "plugin"
        and (element.get("name") or "").startswith(("gz::", "ignition::"))
    }
    for element in found:
        name = element.text.strip().removeprefix("model://").strip("/")
        if element.tag != "uri" or f"model://{name}" != element.text.strip().rstrip(
            "/"
        ):
            continue
        own = f"{name}/model.config"
        is_here = any(package.ending(own) for package in around.packages)
        if name in _OF_CLASSIC and element.place.file in of_gz and not is_here:
            right = _FUEL + _OF_CLASSIC[name]
            yield Problem.at(
                element.place,
                "warning",
                "world-model",
                f"model://{name} comes with Gazebo Classic, but the world is for "
                "Gazebo, which has no such model: it does not load the world",
                write(element.place, element.text.strip(), right),
            )
