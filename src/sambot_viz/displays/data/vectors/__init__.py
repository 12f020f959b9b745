"""Displays of two vectors at a frame: forces, velocities and accelerations."""
