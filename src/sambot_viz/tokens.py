"""The secret of a link: made, or chosen by a user."""

from __future__ import annotations

import os.path
import re
import secrets

from sambot_viz.errors import UsageError

SHORTEST = 8
"""A token that a user has chosen has at least so many characters."""
_ALLOWED = re.compile(r"[A-Za-z0-9._~-]+")


def new_token() -> str:
    """Return a token that cannot be guessed: 22 characters, 128 bits."""
    return secrets.token_urlsafe(16)


def check_token(token: str, flag: str = "--token") -> str:
    """Return the token that a user has chosen.

    Args:
        token: what stands behind the flag.
        flag: for messages.

    Raises:
        UsageError: it is too short, would not survive in an address, or is a file:
            the model that was to follow.
    """
    if os.path.exists(token):
        raise UsageError(
            f"{flag} has taken '{token}', which is a file, for its value; write the "
            f"model before {flag}"
        )
    if not _ALLOWED.fullmatch(token):
        raise UsageError(
            f"{flag} '{token}': letters, digits and . _ ~ - may be in it; leave the "
            "value out, and one is made"
        )
    if len(token) < SHORTEST:
        raise UsageError(
            f"{flag} '{token}' is too easy to guess; give at least {SHORTEST} "
            "characters, or leave the value out, and one is made"
        )
    return token
