"""viser's own ViserUrdf with its sliders, as in viser's example."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import viser
import yourdfpy
from speak import Loading, least, model_argument, obey
from viser.extras import ViserUrdf

folder = Path(model_argument()).parent
find = partial(yourdfpy.filename_handler_magic, dir=folder)
model, loaded = least(
    lambda: yourdfpy.URDF.load(model_argument(), filename_handler=find)
)
with Loading():
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    shown = ViserUrdf(server, model)
    server.scene.add_grid("/grid")
    limits = shown.get_actuated_joint_limits()
    names = list(limits)
    sliders = []
    with server.gui.add_folder("Joints"):
        for name, (low, high) in limits.items():
            low = -np.pi if low is None else low
            high = np.pi if high is None else high
            zero = min(max(0.0, low), high)
            slider = server.gui.add_slider(name, low, high, 1e-3, zero)
            slider.on_update(
                lambda _: shown.update_cfg(np.array([s.value for s in sliders]))
            )
            sliders.append(slider)
place = {name: number for number, name in enumerate(names)}
positions = np.zeros(len(names))
shown.update_cfg(positions)


def move(moved: list[str], q: float) -> None:
    """Give a new configuration, as a program does."""
    for name in moved:
        positions[place[name]] = q
    shown.update_cfg(positions)


def poses(q: float) -> None:
    """All links, which yourdfpy computes one by one."""
    model.update_cfg(np.full(len(names), q))
    for link in model.link_map:
        model.get_transform(link)


obey(
    f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1",
    names,
    move,
    poses,
    loaded,
    subprotocol=f"viser-v{viser.__version__}",
)
