"""Joint positions: what joint_state_publisher and its GUI do, without ROS."""
