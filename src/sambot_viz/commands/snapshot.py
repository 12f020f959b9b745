"""``sambot-viz snapshot``: the 3D view as a PNG, without a screen."""

from __future__ import annotations

import re
import signal
import sys
import threading
from collections.abc import Generator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import limits
from sambot_viz.commands.command_line import (
    Parser,
    output_path,
    parse,
    start_state,
    warn,
)
from sambot_viz.errors import UsageError
from sambot_viz.files import write_atomically
from sambot_viz.inputs import Inputs
from sambot_viz.problems import write_problems

if TYPE_CHECKING:
    from sambot_viz.export.view_picture import Picture
    from sambot_viz.session.scene.scene import Scene


def run(words: list[str]) -> int:
    """Write a picture of a model; 0 when the file is written."""
    given, options = parse(parser(), words, panels=False)
    width, height = _size(given.size)
    output = output_path(given.output, "PNG files", ".png")
    with Inputs(options, listen=given.listen) as inputs:
        write_problems(inputs.problems(), model=options.model)
        start_state(inputs.robot(), options)
        picture = _picture(inputs, (width, height), given.fit)
    _write(output, picture)
    return 0


def _picture(inputs: Inputs, size: tuple[int, int], fit: bool) -> Picture:
    """Draw the page's 3D view into a picture."""
    from sambot_viz.export.chromium import Chromium
    from sambot_viz.export.view_picture import LONGEST_WAIT, snapshot
    from sambot_viz.session.shown_problems import problems_of_topics
    from sambot_viz.visualizer import Visualizer

    options, (width, height) = inputs.options, size
    with ExitStack() as stack:
        stack.enter_context(_exit_on_sigterm())
        viz = stack.enter_context(Visualizer.of_inputs(inputs))
        session = viz.server.sessions.all()[0]
        # Set before a page is opened: the camera then fits everything that is drawn.
        stack.enter_context(session.looked_at())
        if inputs.moved_by is not None and inputs.moved_by.can("seek"):
            # Without this the page would play the recording.
            viz.player.pause()
            viz.player.jump(viz.player.duration if options.at is None else options.at)
        write_problems(session.document.config.problems)
        write_problems([*problems_of_topics(session.scene.displays)])
        _report_fixed_frame(session.scene)
        # A browser takes seconds to start, so problems were reported before it.
        with Chromium() as chromium:
            camera = session.document_view.camera
            config = session.document.config
            if fit or config.fits_scene:
                viz.server.sessions.wait_for_meshes(LONGEST_WAIT)
                camera = session.document_view.camera_on_robot(width, height)
            return snapshot(viz.server, chromium, width, height, camera)


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz snapshot",
        groups=("model", "source", "config", "view", "compare", "pose"),
        description="Write a PNG of the 3D view alone, drawn by a Chromium or Chrome "
        "of this machine. Exit status: 0 written, 1 errors found, 2 usage.",
    )
    made.add_listen()
    add = made.add_argument
    add("-o", "--output", required=True, metavar="FILE.png", help="file to write")
    add(
        "--size",
        default="800x600",
        metavar="WxH",
        help="size [pixels] (default: %(default)s)",
    )
    add(
        "--fit",
        action="store_true",
        help="show the whole robot, whatever distance the config says (RViz's default "
        "is 10 m); so does a robot or a recording without a config",
    )
    return made


@contextmanager
def _exit_on_sigterm() -> Generator[None]:
    """Let SIGTERM, which `timeout` sends, leave the block, so that it cleans up."""

    def leave(number: int, frame: object) -> None:
        del frame
        sys.exit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _report_fixed_frame(scene: Scene) -> None:
    """Warn when the fixed frame does not exist, because the picture is empty then."""
    status = scene.global_status()
    if status.level != "Ok":
        frames = ", ".join(scene.context.tree.frames) or "none"
        warn(f"Fixed Frame: {status.text}; existing frames: {frames}")


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)[xX×](\d+)", text.strip())
    if match is None:
        raise UsageError(f"--size {text} is not a size in pixels, such as 800x600")
    width, height = int(match[1]), int(match[2])
    if not (
        1 <= width <= limits.PICTURE_SIDE.value
        and 1 <= height <= limits.PICTURE_SIDE.value
    ):
        most = limits.PICTURE_SIDE.value
        raise UsageError(f"--size {text}: each side must be 1 to {most:,} pixels")
    return width, height


def _write(path: Path, picture: Picture) -> None:
    """Write the file, whole or not at all."""
    from sambot_viz.export.view_picture import png

    try:
        write_atomically(path, png(picture))
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {error.strerror}") from error
