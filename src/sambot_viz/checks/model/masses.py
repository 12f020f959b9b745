"""Report links that are heavier than any metal: their mass is in grams."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.clues import Clues, guess, is_written_whole
from sambot_viz.checks.model.lengths import written_lengths
from sambot_viz.checks.model.volumes import volume_of
from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Problem
from sambot_viz.robot.parts import Link

_DENSEST = 25_000.0
"""More than osmium, 22,600 kg/m³, the densest metal."""
_TIMES = 2.0
"""Factor over the mass of all other links; small shapes may represent large parts."""
_TINY = 0.02
"""Size of a placeholder shape for an unmeasured part [m]."""
_WHOLE = 50.0
"""Mass from which the masses of parts are seldom whole numbers [kg]."""
_GRAMS = 1000.0
_LIGHT = 1.0
"""Mass below which a value may be intended [kg]."""


def masses_in_grams(subject: Subject) -> Iterator[Problem]:
    """Report the links that make the robot heavy, and are too small for their mass."""
    masses = {
        link.name: link.inertial.mass
        for link in subject.robot.links.values()
        if link.inertial is not None
    }
    dense = {
        name: mass
        for name, mass in masses.items()
        if mass > _LIGHT and mass > _DENSEST * volume_of(subject.robot.links[name])
    }
    if sum(dense.values()) <= _TIMES * (sum(masses.values()) - sum(dense.values())):
        return
    # The reader drops the unit of a mass, and another rule reports that.
    cut = [p.message for p in subject.robot.problems if p.code == "sdf-number-cut-off"]
    for name, mass in dense.items():
        if any(f"of link {name}:" in message for message in cut):
            continue
        link = subject.robot.links[name]
        yield guess(
            link.inertial.place if link.inertial else None,
            "mass-in-grams",
            f"link {name} has a mass of {number(mass)} kg and is too small for it, "
            "even of metal: it is probably given in grams",
            f"write {number(mass / _GRAMS)}, and the moments of inertia of that mass",
            _clues(link, mass, bool(masses.keys() - dense.keys())),
        )


def _clues(link: Link, mass: float, others: bool) -> Clues:
    """Return the clues for grams; a placeholder has any shape and any mass."""
    clues = {"density"}
    sides = [
        abs(value)
        for shape in link.collisions or link.visuals
        for value in written_lengths(shape.geometry)[1]
    ]
    whole = is_written_whole(mass)
    if others and whole and max(sides, default=0.0) > _TINY:
        clues.add("other masses")
    if whole and mass >= _WHOLE:
        clues.add("whole number")
    inertial = link.inertial
    if inertial is not None and sides:
        most = max(inertial.ixx, inertial.iyy, inertial.izz)
        if 0 < most < mass / _GRAMS * max(sides) ** 2:
            clues.add("inertia")
    return clues
