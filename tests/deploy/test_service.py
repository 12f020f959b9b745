"""The unit for systemd."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest


def test_the_service_is_exposed_to_little(repository: Path) -> None:
    analyze = shutil.which("systemd-analyze")
    if analyze is None:
        pytest.skip("needs systemd-analyze (Debian: apt-get install systemd)")
    unit = repository / "deploy" / "sambot-viz.service"
    words = [analyze, "security", "--offline=true", "--threshold=40", "--no-pager"]
    found = subprocess.run([*words, str(unit)], capture_output=True, text=True)
    if "Unknown" in found.stderr or "unrecognized" in found.stderr:
        pytest.skip("this systemd-analyze does not look at files")
    # 10 is exposed to everything; above 4, the status is 1.
    assert found.returncode == 0, found.stdout[-2000:] + found.stderr
