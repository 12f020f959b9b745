"""What messages mean, whatever their encoding and schema: a display asks for that."""

from sambot_viz.meanings.meaning import Meaning
from sambot_viz.meanings.reading import reader_of
from sambot_viz.meanings.schemas import has_ros_look, meaning_of

__all__ = ["Meaning", "has_ros_look", "meaning_of", "reader_of"]
