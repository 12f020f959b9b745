"""Rules about ros2_control: its elements, interfaces and controllers."""
