"""Messages: from bytes to values, the only place that knows how they are written."""

from sambot_viz.messages.decoder import Decoder
from sambot_viz.messages.joint_state_decoder import JointStateTemplate
from sambot_viz.messages.kept_elements import KeptElements
from sambot_viz.messages.known_types import standard_definition, standard_hash
from sambot_viz.messages.reason import Reason
from sambot_viz.messages.rows import Rows
from sambot_viz.messages.schema import Schema
from sambot_viz.messages.shape import MessageShape
from sambot_viz.messages.transform_decoder import TransformDecoder
from sambot_viz.messages.types import MessageTypes

__all__ = [
    "Decoder",
    "JointStateTemplate",
    "KeptElements",
    "MessageShape",
    "MessageTypes",
    "Reason",
    "Rows",
    "Schema",
    "TransformDecoder",
    "standard_definition",
    "standard_hash",
]
