"""Picking: displays answer which of their shapes a ray or a rectangle meets."""
