"""How paths in packages are written, in models and in what launch files build."""

from __future__ import annotations

SHARE = "package://"
"""A path in the share folder of a package begins so, as in a model."""
