"""The robot as it would be without its misspelt names."""

from __future__ import annotations

import dataclasses

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.model import Robot, shapes_of
from sambot_viz.robot.parts import MeshFile
from sambot_viz.robot.slips.follow_ups import corrected_copy
from sambot_viz.robot.slips.slip_words import SLIP_CODES
from sambot_viz.robot.urdf.read_urdf import read_urdf
from sambot_viz.robot.urdf.urdf_words import URDF
from sambot_viz.robot.xml.element import parse_xml


def corrected_robot(robot: Robot) -> Robot | None:
    """Return a robot with its misspelt names corrected; None when it has none.

    What a check finds only in the robot as it is follows from the names.
    """
    if not any(problem.code in SLIP_CODES for problem in robot.problems):
        return None
    if robot.language != "urdf":
        return None
    document = corrected_copy(parse_xml(robot.description, ""), URDF)
    files = {
        shape.geometry.filename: shape.geometry.path
        for shape in shapes_of(robot)
        if isinstance(shape.geometry, MeshFile)
    }
    read = read_urdf(
        document,
        ModelFindings(),
        lambda name, _: files.get(name),
        lambda _name, _: None,
        expanded=True,
    )
    if read is None:
        return None
    name, root, links, joints = read
    return dataclasses.replace(robot, name=name, root=root, links=links, joints=joints)
