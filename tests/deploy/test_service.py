"""The unit for systemd."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from sambot_viz.commands.index import of_folder


@pytest.mark.parametrize("name", ["sambot-viz.service", "sambot-viz@.service"])
def test_the_service_is_exposed_to_little(
    repository: Path, tmp_path: Path, name: str
) -> None:
    analyze = shutil.which("systemd-analyze")
    if analyze is None:
        pytest.skip("needs systemd-analyze (Debian: apt-get install systemd)")
    # It looks at one instance of a template.
    unit = tmp_path / name.replace("@", "@turtle")
    unit.write_bytes((repository / "deploy" / name).read_bytes())
    words = [analyze, "security", "--offline=true", "--threshold=40", "--no-pager"]
    found = subprocess.run([*words, str(unit)], capture_output=True, text=True)
    if "Unknown" in found.stderr or "unrecognized" in found.stderr:
        pytest.skip("this systemd-analyze does not look at files")
    # 10 is exposed to everything; above 4, the status is 1.
    assert found.returncode == 0, found.stdout[-2000:] + found.stderr


def test_each_of_several_services_is_as_closed_as_one(repository: Path) -> None:
    one, several = (
        (repository / "deploy" / name).read_text("utf-8").partition("NoNew")[2]
        for name in ("sambot-viz.service", "sambot-viz@.service")
    )
    bare = [line for line in one.splitlines() if not line.startswith("#")]
    assert [line.replace("/my_bot", "") for line in bare] == several.splitlines()


def test_the_file_of_a_robot_is_one_for_the_index_too(
    repository: Path, tmp_path: Path
) -> None:
    unit = (repository / "deploy" / "sambot-viz@.service").read_text("utf-8")
    assert "EnvironmentFile=/etc/sambot-viz/%i.conf" in unit and " $ARGS\n" in unit
    shown = re.findall(r"^#     (ARGS=.*|SAMBOT_VIZ_TOKEN=.*)$", unit, re.MULTILINE)
    assert len(shown) == 2
    (tmp_path / "turtle.conf").write_text("\n".join(shown))
    (robot,) = of_folder(tmp_path)
    assert robot.shown == "https://lab.example.org/turtle/"
    assert robot.asked == "http://127.0.0.1:8081/turtle"
