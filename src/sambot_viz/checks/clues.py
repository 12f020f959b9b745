"""Rate a guess: one clue makes it a note, two independent ones a warning.

A rule that infers a unit or an intention from numbers collects its clues by name. A
guess is never an error, because ROS accepts the numbers.
"""

from __future__ import annotations

from collections.abc import Set

from sambot_viz.errors import Fix, Place, Problem, Severity

Clues = Set[str]
"""Names of the clues for a guess, such as "size" and "density"."""


def severity(clues: Clues) -> Severity:
    """Return the severity of a guess by the number of its clues."""
    return "warning" if len(clues) > 1 else "info"


def guess(
    place: Place | None, code: str, message: str, hint: str | Fix, clues: Clues
) -> Problem:
    """Report a guess as seriously as its clues allow."""
    return Problem.at(place, severity(clues), code, message, hint)


def is_written_whole(value: float) -> bool:
    """Return whether a measured number has no fraction."""
    return is_measured(value) and abs(value - round(value)) < 1e-9


def is_measured(value: float) -> bool:
    """Return whether a number is neither 0 nor 1, 10, 0.1 or the like.

    People write powers of ten for values that they do not know.
    """
    return f"{abs(value):.9f}".replace(".", "").strip("0") not in ("", "1")
