"""Drake's ModelVisualizer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.visualization import ModelVisualizer
from speak import Loading, model_argument, obey

with Loading() as loading:
    meshcat = Meshcat(MeshcatParams(host="127.0.0.1"))
    visualizer = ModelVisualizer(meshcat=meshcat)
    package = Path(model_argument()).parent
    visualizer.package_map().PopulateFromFolder(str(package))
    visualizer.AddModels(Path(model_argument()))
    visualizer.Finalize()
with Loading():
    visualizer.Run(loop_once=True)
plant = visualizer._diagram.plant()
root = plant.CreateDefaultContext()
positions = np.array(plant.GetPositions(root))
names = []
place = {}
for index in plant.GetJointIndices():
    joint = plant.get_joint(index)
    if joint.num_positions() == 1:
        names.append(joint.name())
        place[joint.name()] = joint.position_start()
bodies = [
    plant.get_body(index)
    for instance in range(plant.num_model_instances())
    for index in plant.GetBodyIndices(ModelInstanceIndex(instance))
]


def move(moved: list[str], q: float) -> None:
    """Show a configuration; Drake sets the sliders of its page as well."""
    for name in moved:
        positions[place[name]] = q
    visualizer.Run(position=positions, loop_once=True)


def poses(q: float) -> None:
    """All bodies."""
    moved = positions.copy()
    moved[list(place.values())] = q
    plant.SetPositions(root, moved)
    for body in bodies:
        plant.EvalBodyPoseInWorld(root, body)


obey(meshcat.web_url(), names, move, poses, loading.seconds, subprotocol=None)
