"""Messages: from bytes to values, the only place that knows how they are written."""

from sambot_viz.messages.schema import Schema

__all__ = ["Schema"]
