"""Run README's first command as it stands; called by tests/run, not by pytest.

    python tests/packaging/try_readme.py FOLDER

FOLDER is an unpacked source archive. The command makes an environment there, and shows
the robot: its page is asked for, and Ctrl-C ends it quietly.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from readme import commands

END = 60.0
"""How long Ctrl-C may take [s] on a busy machine."""


def main(folder: Path) -> None:
    """Run it; a failure ends the program with a message."""
    command, _ = commands(folder / "README.md")
    print(f"$ {command}", flush=True)
    # The group of processes gets Ctrl-C, as in a terminal.
    shown = subprocess.Popen(
        ["bash", "-c", command],
        cwd=folder,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={k: v for k, v in os.environ.items() if k != "VIRTUAL_ENV"},
    )
    assert shown.stdout is not None
    try:
        said: list[str] = []
        while not (addresses := [w for w in " ".join(said).split() if "http://" in w]):
            if not (line := shown.stdout.readline()):
                sys.exit(f"the command ended with {shown.wait()}: {''.join(said)}")
            said.append(line)
        with urllib.request.urlopen(addresses[-1], timeout=60.0) as page:
            assert page.status == 200 and b"sambot" in page.read()
        os.killpg(shown.pid, signal.SIGINT)
        rest, _ = shown.communicate(timeout=END)
        assert rest == "", f"more on standard output: {rest!r}"
    finally:
        if shown.poll() is None:
            os.killpg(shown.pid, signal.SIGKILL)
            shown.wait()
    print("README's first command sets up and shows the robot")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
