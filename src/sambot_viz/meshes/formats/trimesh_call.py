"""trimesh, which reads glTF and PLY: called quietly, its errors as one class.

Importing it takes half a second, so only the first such file does it.
"""

from __future__ import annotations

import logging
from contextvars import ContextVar
from importlib import import_module
from typing import Any

_reading: ContextVar[bool] = ContextVar("reading", default=False)


class TrimeshError(ValueError):
    """trimesh cannot read a file; the text is its reason, in one line."""


def call_trimesh(module: str, function: str, *args: Any, **kwargs: Any) -> Any:
    """Return the result of a function of `trimesh.exchange`: arrays by name.

    Args:
        module: the part of `trimesh.exchange`, such as "stl".
        function: its function.
        *args: its arguments.
        **kwargs: its options.

    Raises:
        TrimeshError: the function raised an exception, of whatever kind.
    """
    import trimesh

    trimesh.util.log.addFilter(_is_not_ours)  # a filter is added only once
    token = _reading.set(True)
    try:
        reader = getattr(import_module(f"trimesh.exchange.{module}"), function)
        return reader(*args, **kwargs)
    except (MemoryError, RecursionError):
        raise
    except Exception as error:
        reason = " ".join(str(error).split())[:120]
        raise TrimeshError(
            f"trimesh cannot read it ({type(error).__name__}: {reason})"
        ) from error
    finally:
        _reading.reset(token)


def _is_not_ours(record: logging.LogRecord) -> bool:
    """Keep the log of those who call trimesh themselves."""
    return not _reading.get()
