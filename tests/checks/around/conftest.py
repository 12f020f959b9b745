"""Packages around a model, to be changed by a test."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

PACKAGES = Path(__file__).parents[2] / "data" / "around"

Copied = Callable[[str], Path]


@pytest.fixture
def copied(tmp_path: Path) -> Copied:
    """Copies the correct package "gz" or "classic"; returns its folder."""

    def copy(name: str) -> Path:
        target = tmp_path / "cart_description"
        shutil.copytree(PACKAGES / name, target)
        return target

    return copy
