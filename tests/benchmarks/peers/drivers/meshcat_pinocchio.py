"""MeshCat with Pinocchio."""

from __future__ import annotations

import os
from pathlib import Path

import meshcat
import numpy as np
import pinocchio
from pinocchio.visualize import MeshcatVisualizer
from speak import Loading, least, model_argument, obey

folder = Path(model_argument()).parent
os.chdir(folder)
packages = [str(folder), str(folder.parent)]
(model, collision, visual), loaded = least(
    lambda: pinocchio.buildModelsFromUrdf(model_argument(), package_dirs=packages)
)
data = model.createData()
with Loading():
    viewer = meshcat.Visualizer()
    shown = MeshcatVisualizer(model, collision, visual)
    shown.initViewer(viewer=viewer)
    shown.loadViewerModel()
    neutral = pinocchio.neutral(model)
    shown.display(neutral)
names = list(model.names)[1:]
place = {name: model.joints[model.getJointId(name)].idx_v for name in names}
velocity = np.zeros(model.nv)


def move(moved: list[str], q: float) -> None:
    """Show a configuration."""
    for name in moved:
        velocity[place[name]] = q
    shown.display(pinocchio.integrate(model, neutral, velocity))


def poses(q: float) -> None:
    """All joints and frames."""
    configuration = pinocchio.integrate(model, neutral, np.full(model.nv, q))
    pinocchio.framesForwardKinematics(model, data, configuration)


obey(viewer.url(), names, move, poses, loaded, subprotocol=None)
