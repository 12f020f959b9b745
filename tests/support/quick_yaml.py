"""Read a large YAML file: those with cases of tests are read when a run begins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml


def quick_yaml(path: Path) -> Any:
    """What is in a YAML file, read in a tenth of the time of `yaml.safe_load`."""
    quick: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return yaml.load(path.read_text("utf-8"), quick)
