"""Folders for models and packages that are checked."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture
def tmp_path(tmp_path: Path) -> Path:
    """A folder of the test alone, with empty ones around it.

    Packages are looked for up to three folders above that of a model: those of all
    other tests would be found too, which takes longer than the tests themselves.
    """
    inner = tmp_path / "a" / "b" / "c"
    inner.mkdir(parents=True)
    return inner
