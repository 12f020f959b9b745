"""The packages of the extras that `pyproject.toml` declares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

PACKAGES: Mapping[str, Sequence[str]] = {
    "jupyter": ("jupyter-server-proxy>=4.2", "tornado>=6.5.10"),
    "zenoh": ("eclipse-zenoh>=1.10,<2",),
    "dds": ("cyclonedds==11.0.1",),
}
"""Extra → its requirements, as `pyproject.toml` has them."""


def installation(extra: str) -> str:
    """Return the command that installs the packages of an extra.

    It names these packages, not the extra of this program, whose name an index of
    packages may have for another one, or not at all.
    """
    return " ".join(["pip install", *(f'"{one}"' for one in PACKAGES[extra])])
