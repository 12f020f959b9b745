"""How much browsers may add to a session: all of it is sent to every browser."""

from __future__ import annotations

from sambot_viz.errors import UsageError


def require_room(count: int, most: int, what: str) -> None:
    """Refuse to add one more when the limit is reached.

    Files and programs may exceed the limit.

    Args:
        count: the number after the addition.
        most: the limit.
        what: the noun for the message, in the plural.

    Raises:
        UsageError: there is no room.
    """
    if count > most:
        raise UsageError(f"there can be {most} {what}; remove one first")
