"""``sambot-viz snapshot``: the 3D view as a PNG, without a screen."""

from __future__ import annotations

import argparse
import io
import re
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import bundled, problem_text
from sambot_viz.bundled import find
from sambot_viz.commands.options import Parser, add_model_options, parse
from sambot_viz.commands.pose_options import add_pose_options, read_setup
from sambot_viz.errors import UsageError
from sambot_viz.files import write_atomically

if TYPE_CHECKING:
    from sambot_viz.export.view_picture import Picture
    from sambot_viz.robot.model import Robot
    from sambot_viz.rviz import RvizConfig

LARGEST = 8192
"""Longest side of a picture [pixels]; software WebGL takes no larger ones."""


def run(words: list[str]) -> int:
    """Write a picture of a model; 0 when the file is there."""
    options, wanted = parse(_parser(), words, ours=("rvizconfig",))
    width, height = _size(options.size)
    setup = read_setup(options)
    output = _output(options.output)
    config = options.display_config or wanted.words.get("rvizconfig")
    found = find(wanted.model, Path(config) if config else None)
    robot = wanted.load(found.model)
    problem_text.write(robot.problems)
    # What is wrong with the joints or frames is told before a browser is started.
    setup.tree(robot)
    document = _document(found.config, options.fixed_frame, robot)

    from sambot_viz.export.chromium import Chromium
    from sambot_viz.export.view_picture import snapshot
    from sambot_viz.server.server import Server, ServerOptions
    from sambot_viz.session.start_state import SessionSetup

    with Chromium() as chromium:
        begin = SessionSetup(setup.start, setup.static_transforms)
        settings = ServerOptions(port=0, gui=False, panels=False, setup=begin)
        server = Server(
            settings, lambda: document, lambda path: wanted.load(Path(path))
        )
        try:
            server.show_robot(robot)
            camera = server.sessions()[0].views.camera
            picture = snapshot(server, chromium, width, height, camera)
        finally:
            server.stop()
    _write(output, picture)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="sambot-viz snapshot",
        description="Write a PNG of the 3D view alone, drawn by a Chromium or Chrome "
        "of this machine. Exit status: 0 written, 1 errors found, 2 usage.",
    )
    add_model_options(parser)
    add = parser.add_argument
    add("-o", "--output", required=True, metavar="FILE.png", help="where to write it")
    add("-d", "--display-config", metavar="FILE", help="a .rviz file")
    add("-f", "--fixed-frame", metavar="FRAME", help="overrides the config's")
    add("--size", default="800x600", metavar="WxH", help="default: %(default)s")
    add_pose_options(parser)
    return parser


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)[xX×](\d+)", text.strip())
    if match is None:
        raise UsageError(f"--size {text} is no size in pixels, such as 800x600")
    width, height = int(match[1]), int(match[2])
    if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
        raise UsageError(f"--size {text}: each side must be 1 to {LARGEST} pixels")
    return width, height


def _output(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() != ".png":
        raise UsageError(f"-o {text}: only PNG is written; name it FILE.png")
    if path.is_dir():
        raise UsageError(f"-o {text} is a folder; name a file in it")
    if not path.parent.is_dir():
        raise UsageError(f"-o {text}: the folder '{path.parent}' does not exist")
    return path


def _document(config: Path | None, fixed_frame: str | None, robot: Robot) -> RvizConfig:
    """The config to show; the bundled one fits any robot by taking its root."""
    from sambot_viz.open_config import load_config

    document = load_config(config or bundled.config_path())
    problem_text.write(document.problems)
    options = document.global_options
    if fixed_frame is not None:
        options.set("Fixed Frame", fixed_frame)
    elif config is None and options.get("Fixed Frame") not in robot.links:
        options.set("Fixed Frame", robot.root)
    return document


def _write(path: Path, picture: Picture) -> None:
    """Write the file, whole or not at all."""
    from PIL import Image

    encoded = io.BytesIO()
    Image.fromarray(picture).save(encoded, format="PNG")
    try:
        write_atomically(path, encoded.getvalue())
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {error.strerror}") from error
