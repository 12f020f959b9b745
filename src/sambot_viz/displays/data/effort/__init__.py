"""Effort: how hard each joint turns."""
