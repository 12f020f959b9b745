"""Try an installed sambot-viz as its user would; run by tests/run, not by pytest.

It runs with the Python of an environment into which only the wheel was installed, and
from a folder without the source code.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import urllib.request
from importlib import metadata
from pathlib import Path

ENVIRONMENT = Path(sys.prefix)
COMMAND = ENVIRONMENT / "bin" / "sambot-viz"
QUICKLY = 60.0
"""How long anything may take [s] on a busy machine."""


def main() -> None:
    """Go through the steps; the first that fails ends it with a message."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        find_what_is_bundled()
        ask_for_version()
        check_bundled_models()
        show_the_default_robot()
    print("the installed wheel works")


def find_what_is_bundled() -> None:
    """The package is the installed one, typed, with its robots and configs."""
    import sambot_viz
    from sambot_viz import bundled

    package = Path(sambot_viz.__file__).parent
    expect(package.is_relative_to(ENVIRONMENT), f"imported from {package}")
    expect((package / "py.typed").is_file(), "py.typed is missing")
    expect((package / "page/view/rviz_look.js").is_file(), "the page script is missing")
    (tile,) = metadata.entry_points(group="jupyter_serverproxy_servers")
    icon = tile.load()()["launcher_entry"]["icon_path"]
    expect(Path(icon).is_file(), "the icon of the tile in JupyterLab is missing")
    expect(len(bundled.model_names()) >= 3, "models are missing")
    expect(len(bundled.config_names()) >= 2, "configs are missing")
    manual = ENVIRONMENT / "share" / "man" / "man1" / "sambot-viz.1"
    expect(manual.is_file(), "the manual page is missing")
    for path in (
        bundled.model_path(),
        bundled.config_path(),
        bundled.problems_page(),
    ):
        expect(path.is_relative_to(package), f"{path} is not in the package")


def ask_for_version() -> None:
    """The command prints the version that the wheel has."""
    said = run("--version")
    expect(metadata.version("sambot-viz") in said, f"--version says {said!r}")


def check_bundled_models() -> None:
    """No bundled model has an error."""
    from sambot_viz import bundled

    for name in bundled.model_names():
        run("check", str(bundled.model_path(name)))


def show_the_default_robot() -> None:
    """Without arguments the bundled robot is served; Ctrl-C ends it quietly."""
    server = subprocess.Popen(
        [str(COMMAND), "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    try:
        assert server.stdout is not None
        line = server.stdout.readline()
        expect("http://127.0.0.1:" in line, f"the first line is {line!r}")
        url = next(word for word in line.split() if word.startswith("http://"))
        with urllib.request.urlopen(url, timeout=QUICKLY) as page:
            expect(page.status == 200, f"{url} answers {page.status}")
        server.send_signal(signal.SIGINT)
        rest, _ = server.communicate(timeout=QUICKLY)
        expect(rest == "", f"more on standard output: {rest!r}")
        expect(server.returncode in (0, 130), f"exit status {server.returncode}")
    finally:
        server.kill()
        server.wait()


def run(*arguments: str) -> str:
    """The standard output of the command; a failure ends the program."""
    done = subprocess.run(
        [str(COMMAND), *arguments],
        check=False,
        capture_output=True,
        text=True,
        timeout=QUICKLY,
    )
    words = " ".join(arguments)
    expect(done.returncode == 0, f"sambot-viz {words}: {done.stdout}{done.stderr}")
    return done.stdout


def expect(condition: bool, message: str) -> None:
    """End the program with `message` unless `condition` holds."""
    if not condition:
        sys.exit(f"wheel: {message}")


if __name__ == "__main__":
    main()
