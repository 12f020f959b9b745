"""The .rviz document of a session, its edits and its view."""
