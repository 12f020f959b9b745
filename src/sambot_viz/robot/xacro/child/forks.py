"""Forks for each order, in a process that has done its imports.

`robot/fork_server.py` is the other side. Each order brings the ends of three pipes: the
order, whose end of file is the end of the fork; the answer; the exit status of the
fork. This process reads no order, so no fork can see another's content.
"""

from __future__ import annotations

import gc
import os
import select
import signal
import socket
from contextlib import suppress
from typing import NamedTuple

_ENDS = 3
"""Number of descriptors with each order."""


class _Fork(NamedTuple):
    process: int
    status: int


def serve(seconds: float) -> None:
    """Fork for each order from standard input; return in the forks alone.

    A fork has its order as standard input and its answer as standard output. This
    process ends when no order has come for some time [s], or when none can come.
    """
    orders = socket.socket(fileno=os.dup(0))
    forks: dict[int, _Fork] = {}
    # All forks share the imported modules, so no fork should scan them for garbage.
    gc.collect()
    gc.freeze()
    news = select.poll()
    news.register(orders, select.POLLIN)
    waits = True
    while waits or forks:
        ready = dict(news.poll(None if forks else seconds * 1000))
        if not ready:
            break
        for order in forks.keys() & ready.keys():
            news.unregister(order)
            _collect(order, forks.pop(order))
        if orders.fileno() not in ready:
            continue
        data, ends, _, _ = socket.recv_fds(orders, 1, _ENDS)
        if not data:
            waits = False
            news.unregister(orders)
        if len(ends) != _ENDS:
            continue
        order, answer, status = ends
        if (process := os.fork()) == 0:
            orders.close()
            others = [end for one, fork in forks.items() for end in (one, fork.status)]
            _become_fork(order, answer, [*others, status])
            return
        os.close(answer)
        forks[order] = _Fork(process, status)
        # Zero asks only whether the other end has closed, not for data.
        news.register(order, 0)
    os._exit(0)


def _become_fork(order: int, answer: int, others: list[int]) -> None:
    os.setsid()
    os.dup2(order, 0)
    os.dup2(answer, 1)
    for end in (order, answer, *others):
        os.close(end)


def _collect(order: int, fork: _Fork) -> None:
    """End a fork with all its processes, and report its exit status."""
    os.close(order)
    for end in (os.killpg, os.kill):
        # It may have no session yet; a fork that has ended keeps its status.
        with suppress(ProcessLookupError, PermissionError):
            end(fork.process, signal.SIGKILL)
    _, status = os.waitpid(fork.process, 0)
    with suppress(OSError):
        os.write(fork.status, str(os.waitstatus_to_exitcode(status)).encode())
    os.close(fork.status)
