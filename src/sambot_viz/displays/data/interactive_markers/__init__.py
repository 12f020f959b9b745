"""The display InteractiveMarkers."""
