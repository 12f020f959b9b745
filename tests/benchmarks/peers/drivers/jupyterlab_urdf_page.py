"""JupyterLab with jupyterlab-urdf: a file in its own server; only the page moves it."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

from speak import free_port, model_argument, obey

port = free_port()
model = Path(model_argument())
with tempfile.TemporaryDirectory() as home:
    server = subprocess.Popen(
        [
            sys.executable,
            *("-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1"),
            *(f"--port={port}", "--IdentityProvider.token="),
            f"--ServerApp.root_dir={model.parent}",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "HOME": home, "JUPYTER_PREFER_ENV_PATH": "1"},
    )
    try:
        end = time.monotonic() + 60.0
        while time.monotonic() < end:
            try:
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/lab", timeout=10):
                    break
            except urllib.error.URLError:
                time.sleep(0.02)
        obey(f"http://127.0.0.1:{port}/lab/tree/{model.name}", [])
    finally:
        server.terminate()
        server.wait(10)
