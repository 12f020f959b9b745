"""One robot, config, joints, frames and displays, shown to one audience.

`Session` owns the state; what it does on the way stands beside it: the pose of the
robot, frames added by hand, motion and driving, views, tools, the checks' advice.
"""

from sambot_viz.session.session import Audience, Event, Reloaded, Session, walk

__all__ = ["Audience", "Event", "Reloaded", "Session", "walk"]
