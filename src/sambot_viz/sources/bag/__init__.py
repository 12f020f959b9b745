"""Recordings: MCAP, rosbag2's sqlite3 and ROS 1 bags, whole or damaged.

Nothing is decoded here, no thread is started, and a file is never read whole.
"""

from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.bag.opening import open_bag, open_recording
from sambot_viz.sources.bag.recording import Recording

__all__ = ["Bag", "Recording", "open_bag", "open_recording"]
