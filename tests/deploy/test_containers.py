"""The files for containers: what can be said of them without Docker."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
import yaml

from sambot_viz import Visualizer
from sambot_viz.commands.command_line import parse
from sambot_viz.commands.show import parser
from sambot_viz.options import Options


@pytest.fixture
def deploy(repository: Path) -> Path:
    return repository / "deploy"


def instructions(dockerfile: Path) -> list[tuple[str, str]]:
    """The instructions of a Dockerfile: name and the rest, lines joined."""
    text = dockerfile.read_text("utf-8")
    lines = [line for line in text.split("\n") if not line.startswith("#")]
    joined = re.sub(r"\\\n\s*", "", "\n".join(lines))
    found = [line.partition(" ") for line in joined.split("\n") if line]
    return [(name, rest) for name, _, rest in found]


def last(dockerfile: Path, name: str) -> list[str]:
    """The last instruction of that name, as the words of a command."""
    rest = [rest for each, rest in instructions(dockerfile) if each == name][-1]
    return json.loads(rest[rest.index("[") :])


def options_of(words: list[str]) -> Options:
    assert words[0] == "sambot-viz"
    return parse(parser(), words[1:])[1]


def test_what_the_image_runs_is_a_command_line(deploy: Path) -> None:
    dockerfile = deploy / "Dockerfile"
    entry, usual = last(dockerfile, "ENTRYPOINT"), last(dockerfile, "CMD")
    options = options_of([*entry, *usual])
    assert (options.host, options.port, bool(options.token)) == ("0.0.0.0", 8080, True)
    assert ("EXPOSE", "8080") in instructions(dockerfile)
    users = [rest for name, rest in instructions(dockerfile) if name == "USER"]
    assert users == ["robot"]


def test_the_image_is_alive_when_the_program_answers(deploy: Path) -> None:
    words = last(deploy / "Dockerfile", "HEALTHCHECK")
    assert words[0] == "python"

    def check(port: int) -> int:
        code = words[2].replace("8080", str(port))
        command = [sys.executable, words[1], code]
        return subprocess.run(command, check=False, capture_output=True).returncode

    for options in ({}, {"token": ""}, {"base_path": "/robot"}):
        with Visualizer(**options) as viz:
            port = viz.viser.get_port()
            assert check(port) == 0
        assert check(port) != 0


def test_the_image_is_built_from_what_is_not_ignored(
    repository: Path, deploy: Path, tmp_path: Path
) -> None:
    listed = (deploy / "Dockerfile.dockerignore").read_text("utf-8").split("\n")
    assert "*" in listed
    for name in (line[1:] for line in listed if line.startswith("!")):
        source = repository / name
        copy = shutil.copytree if source.is_dir() else shutil.copy
        copy(source, tmp_path / name)
    build = ("-m", "hatchling", "build", "--target", "wheel", "--directory", "built")
    subprocess.run(
        [sys.executable, *build], cwd=tmp_path, check=True, capture_output=True
    )
    (wheel,) = (tmp_path / "built").glob("*.whl")
    with ZipFile(wheel) as archive:
        names = set(archive.namelist())
    for name in (
        "page/main.js",
        "share/assets/sam_bot.urdf.xacro",
        "share/rviz/urdf_config.rviz",
        "jupyter/robot_viewer.svg",
    ):
        assert f"sambot_viz/{name}" in names


def test_the_services_fit_together(deploy: Path) -> None:
    services: Any = yaml.safe_load((deploy / "compose.yaml").read_text("utf-8"))
    services = services["services"]
    robot, nginx = services["robot"], services["nginx"]
    assert (deploy / robot["build"]["context"] / robot["build"]["dockerfile"]).is_file()
    assert robot["network_mode"] == "service:nginx"
    assert "ports" not in robot  # it is reached through nginx only

    # What nginx.conf names is mounted, and the port it asks is the robot's.
    site = (deploy / "nginx.conf").read_text("utf-8")
    mounts = dict(volume.split(":")[:2] for volume in nginx["volumes"])
    assert (deploy / "nginx.conf").is_file() and "./nginx.conf" in mounts
    for path in re.findall(r"(?:_certificate|_key|_user_file)\s+(/\S+);", site):
        assert path in mounts.values(), path
    entry = last(deploy / "Dockerfile", "ENTRYPOINT")
    options = options_of([*entry, *robot["command"]])
    assert f"http://{options.host}:{options.port};" in site
    assert f"location {options.base_path} {{" in site
    (origin,) = options.allowed_origins
    assert f"server_name {origin.removeprefix('https://')};" in site
    assert str(options.model) in [v.split(":")[1] for v in robot["volumes"]]
    assert nginx["ports"] == ["443:443"] and "listen 443 ssl;" in site
