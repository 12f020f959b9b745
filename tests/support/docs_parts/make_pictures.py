"""Makes the pictures of the README and of the tutorial: what a newcomer sees.

It needs a Chromium or Chrome on this machine, and takes some minutes.
"""

from __future__ import annotations

import base64
import io
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

from PIL import Image

from docs_parts.first_robot import PAGE, Walk, said_in, write_files
from docs_parts.quotes import closed_too_early
from sambot_viz.export.browser_page import BrowserPage
from sambot_viz.export.chromium import Chromium

ROOT = Path(__file__).resolve().parents[3]
PICTURES = ROOT / ".github"
SIZE = (1280, 720)
DRAWN = "window.sambotVizLook?.frames > 2"
TWO_FRAMES = (
    "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
)
MOTION = 8.0
"""How much of the recording the moving picture has [s]."""
PERIOD = 0.25
"""From one of its pictures to the next, at least [s]."""


@contextmanager
def opened(arguments: Sequence[str], seen: str) -> Generator[BrowserPage]:
    """Start the program, and yield its page once it shows what is wanted.

    Args:
        arguments: of the command line.
        seen: JavaScript that is true then.
    """
    command = [sys.executable, "-m", "sambot_viz", "--port", "0", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
        try:
            assert program.stdout is not None
            url = program.stdout.readline().strip()
            with Chromium(timeout=60.0) as browser:
                page = browser.open(width=SIZE[0], height=SIZE[1])
                page.goto(f"{url}/?fixedDpr=1")
                page.wait_for(f"({seen}) && {DRAWN}", timeout=60.0)
                yield page
        finally:
            program.terminate()


def shot(page: BrowserPage) -> bytes:
    """Return a PNG of the page."""
    page.evaluate(TWO_FRAMES)
    return base64.b64decode(
        page.call("Page.captureScreenshot", {"format": "png"})["data"]
    )


def take(arguments: Sequence[str], picture: Path, seen: str) -> None:
    """Start the program, open its page, and keep a picture of it.

    Args:
        arguments: of the command line.
        picture: the PNG file to write.
        seen: JavaScript that is true when the page shows what the picture is about.
    """
    with opened(arguments, seen) as page:
        before, now = b"", shot(page)
        # Names and shadows come some pictures later.
        while now != before:
            before, now = now, shot(page)
    picture.write_bytes(now)


def film(arguments: Sequence[str], picture: Path, seen: str) -> None:
    """Do the same for a page that moves: write a WebP file that plays without end."""
    pictures, times = list[Image.Image](), list[float]()
    with opened(arguments, seen) as page:
        while not times or times[-1] - times[0] < MOTION:
            taken = Image.open(io.BytesIO(shot(page))).convert("RGB")
            pictures.append(taken.resize((960, 540), Image.Resampling.LANCZOS))
            times.append(time.monotonic())
            time.sleep(PERIOD)
    lasts = [round(1000 * (b - a)) for a, b in pairwise(times)]
    first, *others = pictures
    first.save(
        picture,
        save_all=True,
        append_images=others,
        duration=[*lasts, 1000],
        loop=0,
        quality=70,
        method=6,
    )


def names() -> list[str]:
    """List the pictures by their files, without making any."""
    trials = Walk(PAGE.read_text("utf-8")).trials
    drawn = [trial.picture for trial in trials if trial.draws and trial.picture]
    tutorial = [f"first_robot_{name}" for name in ("body.png", *drawn)]
    return [*tutorial, "recording.webp", "sam_bot.png", "problem.png"]


def tutorial(walk: Walk) -> None:
    """Make the pictures of docs/first-robot.md, by its own commands.

    Each snapshot of the page becomes a picture of that name. The first command that
    opens the page gives the picture of the window.
    """
    window = next(trial for trial in walk.trials if trial.shows)
    snapshots = [t for t in walk.trials if t.draws and t.picture]
    for trial in (window, *snapshots):
        with tempfile.TemporaryDirectory() as folder:
            write_files(trial.files, Path(folder))
            if trial is window:
                model = Path(folder) / trial.commands[0].split()[-1]
                target = PICTURES / "first_robot_body.png"
                take(["--model", str(model)], target, "true")
                continue
            said_in(Path(folder), trial)
            picture = (Path(folder) / trial.picture).read_bytes()
            (PICTURES / f"first_robot_{trial.picture}").write_bytes(picture)


def main() -> None:
    """Make all pictures."""
    tutorial(Walk(PAGE.read_text("utf-8")))
    film(
        [str(ROOT / "assets" / "square.mcap")],
        PICTURES / "recording.webp",
        "window.sambotVizLook?.frames > 20",
    )
    model = ROOT / "assets" / "sam_bot.urdf.xacro"
    take(
        ["--model", str(model)],
        PICTURES / "sam_bot.png",
        "document.querySelectorAll('[role=slider], input[type=range]').length > 1",
    )
    with tempfile.TemporaryDirectory() as folder:
        wrong = Path(folder) / "my_robot.urdf.xacro"
        wrong.write_text(closed_too_early(), "utf-8")
        take(
            ["--model", str(wrong)],
            PICTURES / "problem.png",
            "document.body.innerText.includes('too early')",
        )
