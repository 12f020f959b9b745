"""Picking in a browser's picture, and the boxes around the selection."""
