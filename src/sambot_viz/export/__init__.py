"""The 3D view as a picture or a page: pictures need a Chromium of this machine."""

LARGEST_SIDE = 8192
"""Longest side of a picture [pixels]: the limit of software WebGL."""
