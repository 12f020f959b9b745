"""This program, through its Python interface."""

from __future__ import annotations

import sys

from speak import least, model_argument, obey

from sambot_viz import Visualizer, load_robot
from sambot_viz.robot.kinematics import Kinematics

MOVABLE = ("revolute", "continuous", "prismatic")

robot, loaded = least(lambda: load_robot(model_argument()))
kinematics = Kinematics(robot)
names = [
    joint.name
    for joint in robot.joints.values()
    if joint.type in MOVABLE and joint.mimic is None
]
config = sys.argv[2] if len(sys.argv) > 2 else None
with Visualizer(model_argument(), config=config, port=0) as viz:
    obey(
        viz.url,
        names,
        lambda moved, q: viz.set_joint_positions(dict.fromkeys(moved, q)),
        lambda q: kinematics.poses(dict.fromkeys(names, q)),
        loaded,
    )
