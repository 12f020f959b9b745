"""Print the requirements of dependency groups in pyproject.toml, one a line.

    python tests/packaging/dependency_groups.py test lint

pip knows ``--group`` only since 25.1, which Python 3.10 and 3.11 do not bring.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    # Python 3.10 has no TOML reader of its own, but every pip for it carries one.
    from pip._vendor import tomli as tomllib

PYPROJECT = Path(__file__).resolve().parents[2] / "pyproject.toml"


def requirements(names: list[str]) -> list[str]:
    """The requirements of the groups `names`, in order."""
    document: dict[str, Any] = tomllib.loads(PYPROJECT.read_text(encoding="utf-8"))
    groups: dict[str, list[str]] = document["dependency-groups"]
    return [requirement for name in names for requirement in groups[name]]


if __name__ == "__main__":
    print("\n".join(requirements(sys.argv[1:])))
