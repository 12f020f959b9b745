"""The player of a recording, as a program uses it."""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.errors import UsageError
from sambot_viz.options import LATEST
from sambot_viz.scripting.displays import first, for_all
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session
from sambot_viz.session.data.player import FASTEST, SLOWEST, Player


class PlayerControl:
    """Plays the recording in all open pages; times are from its first message [s].

    With private sessions, reading returns the values of the first browser.

    Every method raises UsageError without a recording.
    """

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions

    @property
    def time(self) -> float:
        """Where it is."""
        player = self._first()
        return (player.time_ns - player.start_ns) * 1e-9

    @property
    def duration(self) -> float:
        """How long it is."""
        player = self._first()
        return (player.end_ns - player.start_ns) * 1e-9

    @property
    def playing(self) -> bool:
        """Whether the time goes on."""
        return self._first().playback.value.playing

    def play(self, *, rate: float = 1.0, loop: bool = False) -> None:
        """Let the time go on.

        Args:
            rate: how much faster than it was recorded.
            loop: whether it begins again at the end.

        Raises:
            UsageError: a rate that cannot be.
        """
        if not SLOWEST <= rate <= FASTEST:
            raise UsageError(f"a rate is from {SLOWEST:g} to {FASTEST:g}, not {rate!r}")

        def play(player: Player) -> None:
            player.set_rate(rate)
            player.set_loop(loop)
            player.play()

        self._for_all(play)

    def pause(self) -> None:
        """Stop the time."""
        self._for_all(lambda player: player.pause())

    def jump(self, seconds: float) -> None:
        """Jump to a time, or to the nearest end; a playing recording plays on.

        Raises:
            UsageError: the number of seconds is invalid.
        """
        if not abs(seconds) <= LATEST:
            raise UsageError(f"a time is a number of seconds, not {seconds!r}")
        self._for_all(lambda p: p.jump(p.start_ns + round(seconds * 1e9)))

    def _first(self) -> Player:
        return _player(first(self._sessions))

    def _for_all(self, action: Callable[[Player], object]) -> None:
        for_all(self._sessions, lambda session: action(_player(session)))


def _player(session: Session) -> Player:
    player = None if session.data is None else session.data.player
    if player is None:
        raise UsageError("no recording is played: give one as the model or the source")
    return player
