"""Texts of files that are not saved, in place of what is on the disk.

While somebody writes a model, it is loaded and checked as it is in the editor. Whoever
reads a file to say where something is, or how to fix it, asks here first.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

_TEXTS: ContextVar[Mapping[str, str] | None] = ContextVar("unsaved", default=None)


@contextmanager
def unsaved(texts: Mapping[str, str]) -> Generator[None]:
    """Read these texts in place of their files, in this thread until the block ends.

    Texts of a block around it stay, unless they are of the same files.

    Args:
        texts: whole path of a file → its text.
    """
    token = _TEXTS.set({**(_TEXTS.get() or {}), **texts} or None)
    try:
        yield
    finally:
        _TEXTS.reset(token)


def unsaved_text(file: str | Path) -> str | None:
    """Return the text of a file that is not saved; None for all others."""
    texts = _TEXTS.get()
    return None if texts is None else texts.get(os.path.abspath(file))
