"""rerun's web viewer, served by its own program."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

from speak import free_port, least, model_argument, obey

os.environ["RERUN_ANALYTICS_ENABLED"] = "false"
grpc, web = free_port(), free_port()
program = Path(sys.executable).with_name("rerun")
server = subprocess.Popen(
    [
        program,
        *("--serve-web", "--bind", "127.0.0.1", "--port", str(grpc)),
        *("--web-viewer-port", str(web)),
    ],
    stdout=subprocess.DEVNULL,
    stderr=subprocess.DEVNULL,
)
try:
    import rerun
    from rerun.urdf import UrdfTree

    end = time.monotonic() + 30.0
    for port in (grpc, web):
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.005)
    rerun.init("robot")
    address = f"rerun+http://127.0.0.1:{grpc}/proxy"
    rerun.connect_grpc(address)
    tree, loaded = least(lambda: UrdfTree.from_file_path(model_argument()))
    tree.log_urdf_to_recording()
    joints = {
        joint.name: joint
        for joint in tree.joints()
        if joint.joint_type in ("revolute", "continuous", "prismatic")
    }

    def move(moved: list[str], q: float) -> None:
        """Log the joints that move, at a time of its own."""
        rerun.set_time("step", duration=time.time())
        for name in moved:
            rerun.log("transforms", joints[name].compute_transform(q))

    def poses(q: float) -> None:
        """The transform of every joint; those of links are left to the page."""
        for joint in joints.values():
            joint.compute_transform(q)

    obey(
        f"http://127.0.0.1:{web}/?url={address.replace('+', '%2B')}",
        list(joints),
        move,
        poses,
        loaded,
    )
finally:
    server.terminate()
    server.wait(10)
