"""Rules about Gazebo: worlds, sensors and plugins."""
