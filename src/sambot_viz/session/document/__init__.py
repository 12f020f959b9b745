"""The .rviz document of a session, and what is drawn of it."""
