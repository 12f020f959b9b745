"""Joint positions: what joint_state_publisher and its GUI do, without ROS."""

from sambot_viz.joints.mimic import Follower
from sambot_viz.joints.state import JointState

__all__ = ["Follower", "JointState"]
