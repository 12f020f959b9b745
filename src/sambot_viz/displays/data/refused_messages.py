"""Messages that cannot be drawn, and the sentence that the status has for each."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

import numpy as np

from sambot_viz.errors import DecodeError
from sambot_viz.text import capitalized
from sambot_viz.topics.reasons import not_decodable

MESSAGE = "Message"
"""The status that says so, where a display has no other one for it."""
INVALID_FLOATS = "Message contained invalid floating point values (nans or infs)"
_MALFORMED = (AttributeError, TypeError, ValueError, IndexError, OverflowError)
"""What comes of a message that is defined otherwise than ROS's own of its type."""


class MessageRefused(Exception):
    """A message that cannot be drawn.

    Args:
        text: the sentence of the status, RViz's where it has one.
        key: of the status.
        code: of the reason.
    """

    def __init__(self, text: str, key: str = MESSAGE, code: str = "not-drawn") -> None:
        super().__init__(text)
        self.text, self.key, self.code = text, key, code


@contextmanager
def refusing(
    key: str = MESSAGE, verb: str = "drawn", *others: type[Exception]
) -> Generator[None]:
    """Turn any error of the block into a refusal of the message.

    Numpy's warnings about its numbers are off: the drawing code checks them.

    Args:
        key: key of the status.
        verb: verb for the work in the block.
        others: errors that mean a broken message, in addition to the usual ones.

    Raises:
        MessageRefused: the message cannot be decoded, or the work has failed.
    """
    try:
        with np.errstate(all="ignore"):
            yield
    except DecodeError as error:
        why = not_decodable(1, 1, str(error), True)
        raise MessageRefused(capitalized(why.text), key, why.code) from error
    except (*_MALFORMED, *others) as error:
        raise MessageRefused(f"It cannot be {verb}: {error}", key) from error
