"""Masses and inertias: what KDL and a simulator will say about them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sambot_viz.checks.rule import Finding, Rule, Subject, listed, number
from sambot_viz.robot.model import Inertial


def _on_root(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    root = subject.robot.links[subject.robot.root]
    if root.inertial is None or len(subject.robot.links) == 1:
        return
    yield Finding(
        f"the root link {root.name} has an inertia, which KDL ignores with a warning "
        "at every start; the picture is not affected",
        "to silence it, add a link without inertia (such as base_footprint) as the "
        "new root",
        subject.inside(root.place, "inertial"),
    )


def _missing(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    links = subject.robot.links
    if not any(link.inertial for link in links.values()):
        # Nothing says that this model is meant for a simulator.
        return
    bare = [
        link
        for link in links.values()
        if link.collisions and link.inertial is None and link.name != subject.robot.root
    ]
    if not bare:
        return
    one = len(bare) == 1
    yield Finding(
        f"{'the link' if one else 'the links'} {listed(link.name for link in bare)} "
        f"{'has a collision shape' if one else 'have collision shapes'} but no "
        "<inertial>: a simulator leaves out what has no mass",
        'add <inertial> with <mass value="…"/> and <inertia …/>',
        bare[0].place,
    )


def _impossible(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    for link in subject.robot.links.values():
        if link.inertial is None:
            continue
        reason = _why_impossible(link.inertial)
        if reason:
            yield Finding(
                f"link {link.name}: {reason}; a simulator refuses it or shakes",
                "take mass and inertia from the shape: a box of size x y z has "
                "ixx = m (y² + z²) / 12",
                subject.inside(link.place, "inertial"),
            )


def _why_impossible(inertial: Inertial) -> str:
    """Why no real body has this mass and inertia, or "" (tolerances of 1 %)."""
    if inertial.mass < 0:
        return f"the mass {number(inertial.mass)} is negative"
    diagonal = (inertial.ixx, inertial.iyy, inertial.izz)
    if min(diagonal) < 0:
        return "a moment of inertia (ixx, iyy, izz) is negative"
    tensor = np.array(
        [
            [inertial.ixx, inertial.ixy, inertial.ixz],
            [inertial.ixy, inertial.iyy, inertial.iyz],
            [inertial.ixz, inertial.iyz, inertial.izz],
        ]
    )
    if not np.isfinite(tensor).all():
        return "the inertia is not a finite number"
    low, middle, high = (float(v) for v in np.linalg.eigvalsh(tensor))
    if high > 0 and low < -0.01 * high:
        return "ixy, ixz or iyz are too large for ixx, iyy, izz"
    if high > 1.01 * (low + middle) and high > 1e-12:
        return "one principal moment of inertia is larger than the sum of the other two"
    return ""


def _massless(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    zero = [
        link
        for link in subject.robot.links.values()
        if link.inertial is not None and link.inertial.mass == 0
    ]
    if zero:
        yield Finding(
            f"the mass of {listed(link.name for link in zero)} is 0: fine to look at, "
            "but a simulator leaves such a link out",
            "give it a small mass such as 0.001, or delete its <inertial>",
            subject.inside(zero[0].place, "inertial"),
        )


_BODY = """\
    <inertial>
      <mass value="{mass}"/>
      <inertia ixx="{ixx}" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    </inertial>
"""

_JOINT = """\
  <joint name="j" type="fixed">
    <parent link="a"/>
    <child link="b"/>
  </joint>
"""


def _example(mass: str, ixx: str) -> str:
    return (
        '<robot name="r">\n  <link name="a"/>\n  <link name="b">\n'
        + _BODY.format(mass=mass, ixx=ixx)
        + f"  </link>\n{_JOINT}</robot>\n"
    )


INERTIA_ON_ROOT = Rule(
    code="inertia-on-root",
    severity="info",
    title="Inertia on the root link",
    why="KDL, which robot_state_publisher uses, cannot give the root link an inertia "
    "and says so at every start. An empty root link above it is the usual way.",
    example='<robot name="r">\n  <link name="a">\n'
    + _BODY.format(mass="1", ixx="0.01")
    + f'  </link>\n  <link name="b"/>\n{_JOINT}</robot>\n',
    find=_on_root,
)

INERTIA_MISSING = Rule(
    code="inertia-missing",
    severity="info",
    title="No inertia on a link that a simulator needs",
    why="When some links have an <inertial>, the model is meant for a simulator, and "
    "the simulator drops links that can be hit but have no mass.",
    example='<robot name="r">\n  <link name="a"/>\n  <link name="b">\n'
    + _BODY.format(mass="1", ixx="0.01")
    + '  </link>\n  <link name="c">\n    <collision>\n      <geometry>'
    '<box size="1 1 1"/></geometry>\n    </collision>\n  </link>\n'
    + _JOINT
    + _JOINT.replace('"j"', '"k"').replace('child link="b"', 'child link="c"')
    + "</robot>\n",
    find=_missing,
)

INERTIA_IMPOSSIBLE = Rule(
    code="inertia-impossible",
    severity="warning",
    title="A mass or inertia that no body can have",
    why="ROS's parser takes any number here. A simulator refuses a negative mass, and "
    "an inertia that is no real body's makes it shake or explode.",
    example=_example("1", "0.5"),
    find=_impossible,
)

MASS_ZERO = Rule(
    code="mass-zero",
    severity="info",
    title="A mass of zero",
    why="It makes no difference to the picture, but a simulator leaves out or refuses "
    "a link without mass.",
    example=_example("0", "0.01"),
    find=_massless,
)
