"""A child process that imports once, and forks for each order.

Starting Python and importing take most of the time of a small task; a fork takes a few
milliseconds. `xacro/child/forks.py` is the other side.
"""

from __future__ import annotations

import os
import selectors
import socket
import subprocess
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from sambot_viz.robot.child_process import ChildTimeoutError, framed, python

CAN_FORK = hasattr(os, "fork") and hasattr(socket, "send_fds")
"""Whether this system supports it; Windows does not."""
_PIECE = 2**16
_LONGEST_END = 5.0
"""Longest wait for the exit status of a fork [s]."""


class _ServerEnded(Exception):
    """The forking process ended before it carried out the order."""


class ForkServer:
    """A started script that forks for each order.

    Forks run in parallel, each in a separate process session, and end with this
    process. The script ends by itself after some time without an order; the next order
    starts it again.

    Args:
        script: the script.
        arguments: its command line.
    """

    def __init__(self, script: Path, arguments: Sequence[str] = ()) -> None:
        self._command = python(script, *arguments)
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._orders: socket.socket | None = None

    def ask(self, order: bytes, seconds: float) -> tuple[bytes, int | None]:
        """Send an order to a fork, and return its standard output.

        Args:
            order: the order.
            seconds: time limit [s], after which the fork and its processes end.

        Returns:
            The output, and the exit status; None when that is not known.

        Raises:
            ChildTimeoutError: the fork took longer.
        """
        try:
            return self._ask(order, seconds)
        except _ServerEnded:
            # The script may have stopped waiting just before, or have been killed.
            with suppress(_ServerEnded):
                return self._ask(order, seconds)
        return b"", None

    def end(self) -> None:
        """End the script, and collect it."""
        with self._lock:
            self._end()

    def _ask(self, order: bytes, seconds: float) -> tuple[bytes, int | None]:
        pipes = [os.pipe() for _ in range(3)]
        (order_end, lifeline), (output, output_end), (status, status_end) = pipes
        ours, theirs = [lifeline, output, status], [order_end, output_end, status_end]
        try:
            try:
                server = self._send(theirs)
            finally:
                _close(theirs)
            try:
                found = _exchange(lifeline, output, framed(order), seconds)
            finally:
                # Closing this end kills the fork's session; then it is collected.
                _close([ours.pop(0)])
                ended = _exchange(None, status, b"", _LONGEST_END)
        finally:
            _close(ours)
        if not found and not ended:
            with self._lock:
                if self._process is server:
                    self._end()
            raise _ServerEnded
        return found, int(ended) if ended else None

    def _send(self, descriptors: Sequence[int]) -> subprocess.Popen[bytes]:
        """Send an order's pipe ends, and return the process that receives them."""
        with self._lock:
            if self._process is not None and self._process.poll() is not None:
                self._end()
            if self._process is None or self._orders is None:
                self._process, self._orders = self._started()
            try:
                socket.send_fds(self._orders, [b"."], descriptors)
            except OSError as error:
                self._end()
                raise _ServerEnded from error
            return self._process

    def _started(self) -> tuple[subprocess.Popen[bytes], socket.socket]:
        orders, given = socket.socketpair()
        with given:
            try:
                process = subprocess.Popen(
                    self._command,
                    stdin=given.fileno(),
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    env={},
                    start_new_session=True,
                )
            except BaseException:
                orders.close()
                raise
        return process, orders

    def _end(self) -> None:
        if self._orders is not None:
            self._orders.close()
        if self._process is not None:
            # Its forks, if any, continue for their callers.
            self._process.kill()
            self._process.wait()
        self._orders = self._process = None


def _exchange(to: int | None, answer: int, data: bytes, seconds: float) -> bytes:
    """Write to one pipe while reading another to its end.

    Raises:
        ChildTimeoutError: that took longer than the limit [s].
    """
    end, pieces = time.monotonic() + seconds, list[bytes]()
    left = memoryview(data)
    with selectors.DefaultSelector() as waiting:
        waiting.register(answer, selectors.EVENT_READ)
        if to is not None:
            os.set_blocking(to, False)
            waiting.register(to, selectors.EVENT_WRITE)
        while (remaining := end - time.monotonic()) > 0:
            for key, _ in waiting.select(remaining):
                if key.fd == answer:
                    if not (piece := os.read(answer, _PIECE)):
                        return b"".join(pieces)
                    pieces.append(piece)
                    continue
                with suppress(BrokenPipeError):
                    left = left[os.write(key.fd, left[:_PIECE]) :]
                    if left:
                        continue
                # All data are sent, or the reader is gone: the answer shows which.
                waiting.unregister(key.fd)
    raise ChildTimeoutError(f"it took longer than {seconds:g} s")


def _close(descriptors: Sequence[int]) -> None:
    for one in descriptors:
        os.close(one)
