"""Why messages cannot be read, or are not read as their file says."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Reason:
    """One reason, for the list of topics.

    Attributes:
        code: stable identifier such as "type-unknown".
        text: one sentence with the remedy, without the topic's name in front.
    """

    code: str
    text: str
