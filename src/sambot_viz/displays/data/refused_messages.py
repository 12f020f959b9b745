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
    """Refuse a message whatever is wrong with it.

    Numpy does not warn of its numbers: whoever draws them looks at them.

    Args:
        key: of the status.
        verb: what is done with the message inside.
        others: errors that say that it is broken, beside those of any message.

    Raises:
        MessageRefused: it cannot be decoded, or what was done with it has failed.
    """
    try:
        with np.errstate(all="ignore"):
            yield
    except DecodeError as error:
        why = not_decodable(1, 1, str(error), True)
        raise MessageRefused(capitalized(why.text), key, why.code) from error
    except (*_MALFORMED, *others) as error:
        raise MessageRefused(f"It cannot be {verb}: {error}", key) from error
