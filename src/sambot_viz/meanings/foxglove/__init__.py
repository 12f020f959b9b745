"""Foxglove's schemas (foxglove.*), as its SDK writes them in every encoding."""

from sambot_viz.meanings.foxglove.table import FOXGLOVE

__all__ = ["FOXGLOVE"]
