"""Speed-ups for the xacro child process."""

from __future__ import annotations

import functools
import importlib.util
import sys
from collections.abc import Callable
from typing import Any


def import_lazily(name: str) -> None:
    """Install a module that is imported only at its first use.

    xacro imports yaml at the first ``$(arg …)``, for a conversion that never comes;
    that would be a third of the child's time.
    """
    spec = importlib.util.find_spec(name)
    if spec is None or spec.loader is None:
        return
    spec.loader = importlib.util.LazyLoader(spec.loader)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)


def skipping_plain_text(original: Callable[..., Any]) -> Callable[..., Any]:
    """Skip the lexer for text without a dollar sign, which it would not change."""

    @functools.wraps(original)
    def wrapper(text: Any, symbols: Any) -> Any:
        if isinstance(text, str) and "$" not in text:
            return text
        return original(text, symbols)

    return wrapper
