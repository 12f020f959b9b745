"""A web visualiser for URDF and xacro robots: no ROS, no X server."""
