"""Coordinate frames: the tree, look-ups, static transforms, and their texts."""
