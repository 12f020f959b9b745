"""The files for containers: what can be said of them without Docker."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

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
    assert users[-1] == "robot" and set(users) == {"robot"}


def test_a_second_image_has_a_chromium_for_pictures(deploy: Path) -> None:
    found = instructions(deploy / "Dockerfile")
    stages = [rest.split() for name, rest in found if name == "FROM"]
    names = [words[-1] for words in stages]
    # Without --target the last stage is built: the viewer.
    assert names == ["build", "base", "snapshot", "viewer"]
    assert [words[0] for words in stages[2:]] == ["base", "base"]
    start = found.index(("FROM", "base AS snapshot"))
    end = found.index(("FROM", "base AS viewer"))
    snapshot, viewer = found[start:end], found[end:]
    assert any("chromium" in rest for name, rest in snapshot if name == "RUN")
    assert not any("chromium" in rest for name, rest in viewer if name == "RUN")
    assert ("USER", "robot") in snapshot
    assert ("ENTRYPOINT", '["sambot-viz"]') in snapshot


def test_packages_are_a_layer_of_their_own_below_the_wheel(deploy: Path) -> None:
    found = instructions(deploy / "Dockerfile")
    copied = [rest.split()[-2:] for name, rest in found if name == "COPY"]
    assert copied[1] == ["deploy/requirements.txt", "/"]
    assert all(source == "/wheels" for source, _ in copied[3:])
    installs = [rest for name, rest in found if name == "RUN" and "pip install" in rest]
    assert all("--no-deps" in rest for rest in installs) and len(installs) == 3


def pinned(deploy: Path) -> dict[str, Version]:
    return {name: version for name, version, _ in pins(deploy)}


def pins(deploy: Path) -> list[tuple[str, Version, list[str]]]:
    """Name, version and hashes of each package; nothing else is in the file."""
    text = (deploy / "requirements.txt").read_text("utf-8").replace("\\\n", " ")
    found: list[tuple[str, Version, list[str]]] = []
    for line in text.splitlines():
        if line and not line.startswith("#"):
            pin, *options = line.split()
            name, version = pin.split("==")
            found.append((canonicalize_name(name), Version(version), options))
    return found


def test_pip_installs_only_the_files_that_were_seen(
    repository: Path, deploy: Path
) -> None:
    every = pins(deploy)
    assert len(every) > 30
    for name, _, hashes in every:
        assert hashes, name
        assert all(re.fullmatch("--hash=sha256:[0-9a-f]{64}", one) for one in hashes)
    documents = (deploy / "Dockerfile", repository / "docs" / "deploy.md")
    for path in documents:
        lines = path.read_text("utf-8").split("\n")
        installs = [x for x in lines if "install" in x and "requirements.txt" in x]
        assert installs and all("--require-hashes" in x for x in installs), path


def test_the_image_has_all_packages_that_are_needed_in_one_version(
    repository: Path, deploy: Path
) -> None:
    versions = pinned(deploy)
    python = re.findall(
        r"FROM python:([\d.]+)", (deploy / "Dockerfile").read_text("utf-8")
    )
    there = {"extra": "", "python_version": python[0], "python_full_version": python[0]}
    text = (repository / "pyproject.toml").read_text("utf-8")
    block = text.partition("\ndependencies = [\n")[2].partition("\n]")[0]
    pending = [Requirement(found) for found in re.findall(r'"([^"]+)"', block)]
    known: set[str] = set()
    for needed in pending:
        name = canonicalize_name(needed.name)
        if needed.marker is not None and not needed.marker.evaluate(there):
            continue
        assert versions[name] in needed.specifier, needed
        if name not in known:
            known.add(name)
            pending += map(Requirement, metadata.requires(name) or [])
    # typing_extensions is needed by some Pythons only.
    assert versions.keys() - {"typing-extensions"} <= known
    # What yourdfpy asks for with trimesh[easy] is half of an installation.
    assert not versions.keys() & {"scipy", "embreex", "networkx", "shapely"}


def test_the_image_is_alive_when_the_program_answers(
    deploy: Path, tmp_path: Path
) -> None:
    health = last(deploy / "Dockerfile", "HEALTHCHECK")
    assert health == ["python", "/health.py"]
    entry = last(deploy / "Dockerfile", "ENTRYPOINT")
    line = tmp_path / "cmdline"

    def check(*more: str) -> int:
        line.write_text("\0".join(["python", *entry, *more, ""]), "utf-8")
        command = [sys.executable, "-I", str(deploy / "health.py"), str(line)]
        return subprocess.run(command, check=False, capture_output=True).returncode

    for options in ({}, {"token": ""}, {"base_path": "/robot"}):
        with Visualizer(**options) as viz:
            port = str(viz.viser.get_port())
            assert check("--host", "0.0.0.0", "--port", port) == 0
            assert check(f"--port={port}", "--host=127.0.0.1") == 0
        assert check("--port", port) != 0


def test_the_image_is_built_from_what_is_not_ignored(
    repository: Path, deploy: Path, tmp_path: Path
) -> None:
    listed = (deploy / "Dockerfile.dockerignore").read_text("utf-8").split("\n")
    assert "*" in listed
    for name in (line[1:] for line in listed if line.startswith("!")):
        source = repository / name
        (tmp_path / name).parent.mkdir(exist_ok=True)
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
        "share/docs/problems.md",
        "jupyter/robot_viewer.svg",
    ):
        assert f"sambot_viz/{name}" in names


def test_the_services_fit_together(deploy: Path) -> None:
    services: Any = yaml.safe_load((deploy / "compose.yaml").read_text("utf-8"))
    services = services["services"]
    robot, nginx = services["robot"], services["nginx"]
    assert (deploy / robot["build"]["context"] / robot["build"]["dockerfile"]).is_file()
    assert "ports" not in robot  # it is reached through nginx only

    # What nginx.conf names is mounted, and the port it asks is the robot's.
    mounts = dict(volume.split(":")[:2] for volume in nginx["volumes"])
    assert (deploy / "nginx.conf").is_file() and "./nginx.conf" in mounts
    site = site_of(nginx, deploy / "nginx.conf")
    for path in re.findall(r"(?:_certificate|_key|_user_file)\s+(/\S+);", site):
        assert path in mounts.values(), path
    entry = last(deploy / "Dockerfile", "ENTRYPOINT")
    options = options_of([*entry, *robot["command"]])
    assert (options.host, robot["expose"]) == ("0.0.0.0", [str(options.port)])
    assert f"set $robot robot:{options.port}; proxy_pass http://$robot;" in site
    assert f"location {options.base_path} {{" in site
    (origin,) = options.allowed_origins
    assert f"server_name {origin.removeprefix('https://')};" in site
    assert str(options.model) in [v.split(":")[1] for v in robot["volumes"]]
    assert nginx["ports"] == ["80:80", "443:443"]
    assert "listen 80;" in site and "listen 443 ssl;" in site


def site_of(nginx: Any, file: Path) -> str:
    """What the command of the service makes of nginx.conf."""
    shell, flag, command = nginx["command"]
    made, run = command.replace("$$", "$").split(" > ")
    assert (shell, flag) == ("sh", "-c")
    assert run == "/etc/nginx/conf.d/default.conf && exec nginx -g 'daemon off;'"
    made = made.replace("/nginx.conf", shlex.quote(str(file)))
    return subprocess.run(
        ["sh", "-c", made], check=True, capture_output=True, text=True
    ).stdout
