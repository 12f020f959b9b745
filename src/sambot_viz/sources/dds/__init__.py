"""ROS 2 by DDS itself: no bridge on the robot."""
