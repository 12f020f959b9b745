"""ROS 2 through a router of rmw_zenoh: no bridge on the robot."""
