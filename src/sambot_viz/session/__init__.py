"""One robot, config, joints, frames and displays, shown to one audience.

`Session` owns the state. Its parts have modules of their own: what is drawn, the
robot's state, frames that users add, motion and driving, browsers, edits, problems.
"""

from sambot_viz.session.browser.browser import Browser
from sambot_viz.session.document.drawn_scene import walk
from sambot_viz.session.problem_list import Reloaded
from sambot_viz.session.session import Session
from sambot_viz.session.signals import Audience

__all__ = ["Audience", "Browser", "Reloaded", "Session", "walk"]
