"""One robot, config, joints, frames and displays, shown to one audience.

`Session` makes the parts and joins them: document, scene, robot, people, clients, undo,
problems. Each part holds only what it uses, and reports its changes by signals.
"""

from sambot_viz.session.clients.client import Client
from sambot_viz.session.scene.scene import walk
from sambot_viz.session.session import Session
from sambot_viz.session.shown_problems import Reloaded
from sambot_viz.session.signals import Audience

__all__ = ["Audience", "Client", "Reloaded", "Session", "walk"]
