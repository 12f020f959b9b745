"""Write paths in packages, for models and for values in launch files."""

from __future__ import annotations

SHARE = "package://"
"""A path in the share folder of a package begins so, as in a model."""
