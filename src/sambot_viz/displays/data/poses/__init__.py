"""Displays that draw poses: as arrows or axes, one or many, with their uncertainty."""
