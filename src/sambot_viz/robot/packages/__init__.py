"""Resolve package:// URLs and file names to files on this machine, without ROS."""
