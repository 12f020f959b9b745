"""mjviser: its scene, fed with poses that MuJoCo computes; no simulation runs."""

from __future__ import annotations

import os
from pathlib import Path

import mujoco
import viser
from mjviser import ViserMujocoScene
from speak import Loading, least, model_argument, obey

KEEP_VISUALS = '<mujoco><compiler discardvisual="false" strippath="false"/></mujoco>'

os.chdir(Path(model_argument()).parent)
text = Path(model_argument()).read_text("utf-8")
text = text.replace("</robot>", KEEP_VISUALS + "</robot>")
model, loaded = least(lambda: mujoco.MjModel.from_xml_string(text))
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with Loading():
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    scene = ViserMujocoScene(server, model, num_envs=1)
    scene.update_from_mjdata(data)
names = [model.joint(number).name for number in range(model.njnt)]
place = {name: model.joint(name).qposadr[0] for name in names}


def move(moved: list[str], q: float) -> None:
    """Set positions and show them."""
    for name in moved:
        data.qpos[place[name]] = q
    mujoco.mj_forward(model, data)
    scene.update_from_mjdata(data)


def poses(q: float) -> None:
    """The kinematics alone."""
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)


obey(
    f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1",
    names,
    move,
    poses,
    loaded,
    subprotocol=f"viser-v{viser.__version__}",
)
