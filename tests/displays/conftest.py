"""A session with a robot and a config, without a browser."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest
import viser
from patience import patience

from sambot_viz import load_robot
from sambot_viz.inputs import declarations
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.server import Server
from sambot_viz.session import Session

ARM = """
<robot name="arm">
  <material name="blue"><color rgba="0 0 1 0.5"/></material>
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry><material name="blue"/></visual>
    <inertial>
      <origin xyz="0 0 0.5"/><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
  </link>
  <link name="upper">
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.2"/></geometry></collision>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 1" rpy="1.5707963 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="wrist" type="fixed">
    <parent link="upper"/><child link="tool"/><origin xyz="1 0 0"/>
  </joint>
</robot>
"""
CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: Robot
{body}
  Global Options:
    Fixed Frame: {fixed}
"""
Show = Callable[..., Session]


@pytest.fixture
def arm() -> Robot:
    """A base, an upper arm on a revolute joint, and a tool without geometry."""
    return load_robot(ARM)


@pytest.fixture
def show(arm: Robot) -> Iterator[Show]:
    """``show(body="      Alpha: 0.5")``: a session with one RobotModel of the arm.

    Further arguments: ``fixed``, the fixed frame; ``config``, a whole config instead;
    ``files``, path → robot for "Description File".
    """
    servers: list[Server] = []

    def open_session(
        body: str = "",
        *,
        fixed: str = "base",
        config: str | None = None,
        files: Mapping[str, Robot] | None = None,
        robot: Robot | None = arm,
    ) -> Session:
        text = CONFIG.format(body=body, fixed=fixed) if config is None else config
        document = RvizConfig.parse(text, declarations())
        options = Options(port=0, panels=False)
        robots = {Path(name).name: robot for name, robot in (files or {}).items()}
        models = ModelThread(lambda path, trusted: robots[path.name])
        server = Server(options, lambda: document, models)
        servers.append(server)
        if robot is not None:
            server.sessions.show_robot(robot)
        server.sessions.wait_for_meshes(patience(20))
        assert server.sessions.shared is not None
        return server.sessions.shared

    yield open_session
    for server in servers:
        server.stop()


@pytest.fixture
def nodes() -> Callable[[Session], dict[str, viser.SceneNodeHandle]]:
    """Below a session's frames: last part of a node's name → its handle."""

    def handles(session: Session) -> dict[str, viser.SceneNodeHandle]:
        # viser has no public list of a scene's nodes.
        found = session.audience.scene._handle_from_node_name
        return {name: handle for name, handle in found.items() if "~" in name}

    return handles
