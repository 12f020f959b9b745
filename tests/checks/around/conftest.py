"""Packages around a model, to be changed by a test."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from xacro_memory import XacroMemory

PACKAGES = Path(__file__).parents[2] / "data" / "around"

Copied = Callable[[str], Path]


@pytest.fixture(scope="session")
def xacro_memory() -> XacroMemory:
    return XacroMemory()


@pytest.fixture(autouse=True)
def _xacro_once(
    xacro_memory: XacroMemory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Expand each model once: what is checked is around it."""
    monkeypatch.setattr(
        "sambot_viz.robot.xacro.expansion._run_child",
        lambda job, limits: xacro_memory.run_child(job, limits, tmp_path),
    )


@pytest.fixture
def copied(tmp_path: Path) -> Copied:
    """Copies the correct package "gz" or "classic"; returns its folder."""

    def copy(name: str) -> Path:
        target = tmp_path / "cart_description"
        shutil.copytree(PACKAGES / name, target)
        return target

    return copy
