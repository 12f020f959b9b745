"""A robot on wheels whose centre of mass is beyond what it stands on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.errors import Problem
from sambot_viz.geometry import Matrix
from sambot_viz.robot.balance.balance import Balance, Tipping, balance
from sambot_viz.robot.balance.ground import axle_of
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import MeshFile

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

_SMALLEST_SHARE = 0.02
"""A centre of mass that is less beyond the edge may be right [size of the robot]."""
_CAUGHT = 0.05
"""What is lower keeps it from falling, nearly level [size of the robot]."""
_FEWEST_WHEELS = 2
_FEWEST_CONTACTS = 3


def falls_over(subject: Subject) -> Iterator[Problem]:
    """Report a robot on wheels that falls over where all its joints are at the start.

    Only where that is certain: three links stand on the ground, two of them are wheels,
    all shapes are known, and all links that collide have a mass.
    """
    robot, unknown = subject.robot, False

    def mesh_of(shape: MeshFile) -> Mesh | None:
        nonlocal unknown
        found = None if shape.path is None else subject.mesh(shape.path)
        if found is None or isinstance(found, Problem):
            unknown = True
            return None
        return found

    poses = robot.forward_kinematics()
    found = balance(robot, poses, mesh_of)
    if found is None or found.support is None or unknown:
        return
    contacts, size = found.support.links, found.support.size
    wheels = [link for link in contacts if _is_wheel(robot, link, poses)]
    if len(wheels) < _FEWEST_WHEELS or len(contacts) < _FEWEST_CONTACTS:
        return
    if any(robot.links[link].collisions for link in found.massless):
        return
    caught = balance(robot, poses, mesh_of, _CAUGHT * size)
    tipping, later = found.tipping, None if caught is None else caught.tipping
    enough = _SMALLEST_SHARE * size
    if tipping is None or later is None or -later.margin < enough:
        return
    yield _problem(robot, found, tipping)


def _is_wheel(robot: Robot, link: str, poses: Mapping[str, Matrix]) -> bool:
    joint = next((j for j in robot.joints.values() if j.child == link), None)
    return axle_of(joint, poses[link]) is not None


def _problem(robot: Robot, found: Balance, tipping: Tipping) -> Problem:
    masses = {
        link.name: link.inertial.mass
        for link in robot.links.values()
        if link.inertial is not None
    }
    heaviest = robot.links[max(masses, key=lambda name: masses[name])]
    place = heaviest.place if heaviest.inertial is None else heaviest.inertial.place
    contacts = () if found.support is None else found.support.links
    return Problem.at(
        place or heaviest.place,
        "warning",
        "falls-over",
        f"the robot falls over: its centre of mass is {number(-tipping.margin)} m "
        f"beyond what it stands on, which is {listed(contacts)}",
        f"move weight, such as that of {heaviest.name}, between the wheels, or add a "
        "caster; RobotModel > Mass Properties > Balance shows where it is",
    )
