"""What decodes messages for the tests of meanings."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from foreign_messages import Channel, recorded

from sambot_viz.messages import MessageTypes
from sambot_viz.topics.decoding import Decoding


@pytest.fixture(scope="session")
def decode() -> Callable[[Channel], Any]:
    """Returns a message in the look of its meaning."""
    decoding = Decoding(MessageTypes())
    return lambda channel: decoding.decode(recorded(channel))
