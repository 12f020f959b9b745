"""The packages of the extras that `pyproject.toml` declares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.util import find_spec

from sambot_viz.errors import UsageError

PACKAGES: Mapping[str, Sequence[str]] = {
    "jupyter": ("jupyter-server-proxy>=4.2", "tornado>=6.5.10"),
    "zenoh": ("eclipse-zenoh>=1.10,<2",),
    "metrics": ("prometheus-client>=0.22",),
    "dds": ("cyclonedds==11.0.1",),
}
"""Extra → its requirements, as `pyproject.toml` has them."""


def installation(extra: str) -> str:
    """Return the command that installs the packages of an extra.

    It names these packages, not the extra of this program, whose name an index of
    packages may have for another one, or not at all.
    """
    return " ".join(["pip install", *(f'"{one}"' for one in PACKAGES[extra])])


def require(extra: str, module: str, words: str) -> None:
    """Refuse what needs a package of an extra that is not installed.

    Args:
        extra: its name.
        module: of the package.
        words: what needs it, and that it does.

    Raises:
        UsageError: these words, with the command that installs it.
    """
    if find_spec(module) is None:
        raise UsageError(f"{words}: {installation(extra)}")
