"""The text of an .rviz file: read and written without losing anything."""
