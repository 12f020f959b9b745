"""Lowers a row of the table of limits for a test."""

from __future__ import annotations

from dataclasses import replace

import pytest

from sambot_viz import limits


def lower(monkeypatch: pytest.MonkeyPatch, name: str, value: int) -> None:
    """Give a row of the table another value, until the test ends."""
    monkeypatch.setattr(limits, name, replace(getattr(limits, name), value=value))
