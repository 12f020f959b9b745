"""The commands of README's first screen."""

from __future__ import annotations

import re
from pathlib import Path


def commands(readme: Path) -> tuple[str, str]:
    """The two that a fresh machine needs: to show the robot, and to pass the tests.

    Raises:
        ValueError: there are not exactly two before the first heading below the title.
    """
    first = readme.read_text("utf-8").partition("\n## ")[0]
    blocks = re.findall(r"```sh\n(.*?)\n```", first, re.DOTALL)
    show, test = blocks[:2]
    return show, test
