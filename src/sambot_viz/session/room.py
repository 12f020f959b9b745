"""How much browsers may add to a session: all of it is sent to every browser."""

from __future__ import annotations

from sambot_viz.errors import UsageError


def require_room(count: int, most: int, what: str) -> None:
    """Refuse one more when there are as many as there may be.

    A file, and a program, may have more of them.

    Args:
        count: how many there will be.
        most: how many there may be.
        what: of what, in the plural.

    Raises:
        UsageError: there is no room.
    """
    if count > most:
        raise UsageError(f"there can be {most} {what}; remove one first")
