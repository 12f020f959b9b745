"""Write paths in packages, for models and for values in launch files."""

from __future__ import annotations

SHARE = "package://"
"""Beginning of a path in the share folder of a package, as in a model."""
