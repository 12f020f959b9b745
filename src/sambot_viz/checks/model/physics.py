"""Report masses, inertias and wheels that KDL or a simulator refuses."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from sambot_viz.checks.around.place import where
from sambot_viz.checks.model.inertia_repair import repaired
from sambot_viz.checks.model.unused_macros import links_without_mass, unused_inertia
from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.geometry import ORIGIN, Vector3
from sambot_viz.robot.parts import Box, Cylinder, Geometry, Inertial, Link, Sphere


def inertia_on_root(subject: Subject) -> Iterator[Problem]:
    """Report an inertia of the root link, which KDL ignores.

    robot_state_publisher uses KDL.
    """
    root = subject.robot.links[subject.robot.root]
    if root.inertial is None or len(subject.robot.links) == 1:
        return
    if subject.robot.language == "sdf":
        # There every link has one, and the tutorial tells users to ignore the warning.
        return
    yield Problem.at(
        root.inertial.place or root.place,
        "info",
        "inertia-on-root",
        f"the root link {root.name} has an inertia, which KDL ignores with a warning "
        "at every start; the picture is not affected",
        "to silence it, add a link without inertia (such as base_footprint) as the "
        "new root",
    )


def missing_inertia(subject: Subject) -> Iterator[Problem]:
    """Report links with a collision shape and no mass, which a simulator drops."""
    if not any(link.inertial for link in subject.robot.links.values()):
        # Nothing shows that this model is for a simulator.
        return
    bare = links_without_mass(subject)
    if not bare:
        return
    one, macro = len(bare) == 1, unused_inertia(subject)
    uncalled, hint = "", 'add <inertial> with <mass value="…"/> and <inertia …/>'
    if macro is not None:
        name, params = macro.get("name"), (macro.get("params") or "").split()
        given = "".join(f' {p}="…"' for p in params if p.isidentifier())
        uncalled = (
            f"; the macro {name} ({where(macro.place, bare[0].place)}) is never called"
        )
        hint = f"add <xacro:{name}{given}/>"
    yield Problem.at(
        bare[0].place,
        "info" if macro is None else "warning",
        "inertia-missing",
        f"{'the link' if one else 'the links'} {listed(link.name for link in bare)} "
        f"{'has a collision shape' if one else 'have collision shapes'} but no "
        f"<inertial>: a simulator ignores links without mass{uncalled}",
        hint,
    )


def impossible_inertia(subject: Subject) -> Iterator[Problem]:
    """Report a mass or inertia that no real body has, once for calls of one macro."""
    found: dict[Place | None, list[tuple[str, Place | None]]] = {}
    reasons: dict[Place | None, tuple[str, str | Fix]] = {}
    for link in subject.robot.links.values():
        reason = None if link.inertial is None else _why_impossible(link.inertial)
        if link.inertial is not None and reason is not None:
            place = link.inertial.place or link.place
            found.setdefault(place, []).append((link.name, link.inertial.call))
            fix = repaired(link, lambda other: _why_impossible(other) is None)
            hint = reason[1] or f"take mass and inertia from the shape: {_solid(link)}"
            reasons.setdefault(place, (reason[0], fix or hint))
    for place, links in found.items():
        reason, hint = reasons[place]
        names = [f"{name}{_called_at(call, place)}" for name, call in links]
        yield Problem.at(
            place,
            "warning",
            "inertia-impossible",
            f"{'link' if len(names) == 1 else 'links'} {listed(names)}: {reason}; "
            "a simulator refuses or shakes it",
            hint,
        )


def _called_at(call: Place | None, here: Place | None) -> str:
    return "" if call is None else f" ({where(call, here)})"


_SOLIDS: dict[type[Geometry], str] = {
    Cylinder: "a cylinder of radius r and length h along z has ixx = iyy = "
    "m (3 r² + h²) / 12 and izz = m r² / 2",
    Sphere: "a sphere of radius r has ixx = iyy = izz = 2 m r² / 5",
    Box: "a box of size x y z has ixx = m (y² + z²) / 12",
}
"""Shape → its moments of inertia; a box for all others."""


def _solid(link: Link) -> str:
    """Return the formula for the shape of a link."""
    shapes = link.collisions or link.visuals
    kinds = {type(shape.geometry) for shape in shapes}
    return _SOLIDS.get(kinds.pop(), _SOLIDS[Box]) if len(kinds) == 1 else _SOLIDS[Box]


def _why_impossible(inertial: Inertial) -> tuple[str, str] | None:
    """Return why no real body has this mass and inertia, and what to do about it.

    The second is empty where only the shape helps.
    """
    if inertial.mass < 0:
        return f"the mass {number(inertial.mass)} is negative", ""
    diagonal = (inertial.ixx, inertial.iyy, inertial.izz)
    if min(diagonal) < 0:
        return "a moment of inertia (ixx, iyy, izz) is negative", ""
    reason = _why_no_tensor(inertial)
    if not reason:
        return None
    names = [name for name in ("ixy", "ixz", "iyz") if getattr(inertial, name)]
    alone = replace(inertial, ixy=0.0, ixz=0.0, iyz=0.0)
    if not names or _why_no_tensor(alone):
        return reason, ""
    products = " ".join(f'{n}="{number(getattr(inertial, n))}"' for n in names)
    moments = " ".join(
        f'{n}="{number(getattr(inertial, n))}"' for n in ("ixx", "iyy", "izz")
    )
    one = len(names) == 1
    return (
        f"{products} {'is' if one else 'are'} too large for {moments}: {reason}",
        f"write 0 for {listed(names)}, which {'is' if one else 'are'} 0 for a body "
        "whose sides are along the axes, or take all six from the shape",
    )


def _why_no_tensor(inertial: Inertial) -> str:
    """Return why no real body has these six numbers, or "" (tolerances of 1 %)."""
    diagonal = (inertial.ixx, inertial.iyy, inertial.izz)
    if not all(map(math.isfinite, (*diagonal, *_products(inertial)))):
        return "the inertia is not a finite number"
    low, middle, high = _principal_moments(inertial)
    if high > 0 and low < -0.01 * high:
        return "a principal moment of inertia would be negative"
    if high > 1.01 * (low + middle) and high > 1e-12:
        return "one principal moment of inertia is larger than the sum of the other two"
    return ""


def _products(inertial: Inertial) -> Vector3:
    return (inertial.ixy, inertial.ixz, inertial.iyz)


def _principal_moments(inertial: Inertial) -> Vector3:
    """Return the eigenvalues of the tensor, the lowest first.

    They are the roots of its characteristic polynomial, by the cosine of three angles.
    """
    diagonal, products = (inertial.ixx, inertial.iyy, inertial.izz), _products(inertial)
    # Divide by the largest: squares of very small or large numbers would be 0 or inf.
    size = max(map(abs, (*diagonal, *products)))
    if not size:
        return ORIGIN
    mean = sum(value / size for value in diagonal) / 3.0
    parts = [value / size - mean for value in diagonal]
    parts += [value / size for value in (*products, *products)]
    spread = math.hypot(*parts) / math.sqrt(6.0)
    if not spread:
        return size * mean, size * mean, size * mean
    a, b, c, d, e, f, *_ = (part / spread for part in parts)
    determinant = a * (b * c - f * f) - d * (d * c - e * f) + e * (d * f - b * e)
    turn = math.acos(min(max(determinant / 2.0, -1.0), 1.0)) / 3.0
    high = mean + 2.0 * spread * math.cos(turn)
    low = mean + 2.0 * spread * math.cos(turn + 2.0 * math.pi / 3.0)
    return size * low, size * (3.0 * mean - low - high), size * high


def zero_mass(subject: Subject) -> Iterator[Problem]:
    """Report links without mass, which a simulator leaves out or refuses."""
    zero = {
        link.name: link.inertial.place or link.place
        for link in subject.robot.links.values()
        if link.inertial is not None and link.inertial.mass == 0
    }
    if zero:
        yield Problem.at(
            next(iter(zero.values())),
            "info",
            "mass-zero",
            f"the mass of {listed(zero)} is 0: the picture is right, but a simulator "
            "leaves such a link out",
            "give it a small mass such as 0.001, or delete its <inertial>",
        )
