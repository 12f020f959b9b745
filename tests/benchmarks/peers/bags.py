"""A large recording: opened, jumped in, and what that takes of memory.

The file has what a robot with a lidar records. It is in the cache of the system, so
that reading the disk costs none of them anything.
"""

from __future__ import annotations

import json
import os
import re
import select
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

from large_recording import MOVING as TOPICS
from tests.benchmarks.peers.driven import NotMeasured, end
from tests.benchmarks.peers.environments import Environment
from tests.benchmarks.peers.viewers import Found
from usage import family_usage

JUMP = """
import json, random, sys, time
OPEN
rng = random.Random(2)
began = time.perf_counter()
opened = open_recording(sys.argv[1])
opening = time.perf_counter() - began
first, last = ends(opened)
jumps = []
for _ in range(30):
    at = rng.randrange(first + 10**9, last - 10**9)
    began = time.perf_counter()
    jump(opened, at)
    jumps.append(time.perf_counter() - began)
# Not ru_maxrss: a child begins at the peak of the process that has started it.
status = dict(line.split(":") for line in open("/proc/self/status"))
peak = int(status["VmHWM"].split()[0]) / 1000
print(json.dumps({"opening": opening, "jumps": jumps, "peak": peak}))
"""
OURS = """
from sambot_viz.sources.bag import open_bag
open_recording = lambda path: __import__("pathlib") and open_bag(
    __import__("pathlib").Path(path))
ends = lambda bag: (bag.start_ns, bag.end_ns)
def jump(bag, at):
    for topic in TOPICS:
        assert bag.last(topic, at) is not None
"""
PACKAGE = """
from mcap.reader import make_reader
def open_recording(path):
    reader = make_reader(open(path, "rb"))
    reader.get_summary()
    return reader
def ends(reader):
    found = reader.get_summary().statistics
    return found.message_start_time, found.message_end_time
def jump(reader, at):
    for topic in TOPICS:
        next(iter(reader.iter_messages([topic], end_time=at, reverse=True)))
"""


def measure_library(ours: bool, recording: Path, found: Found) -> None:
    """Open the file, and find the last message of each topic at 30 times."""
    part = (OURS if ours else PACKAGE).replace("TOPICS", repr(TOPICS))
    script = JUMP.replace("OPEN", part)
    done = subprocess.run(
        [sys.executable, "-c", script, str(recording)], capture_output=True, text=True
    )
    if done.returncode:
        raise NotMeasured(done.stderr.strip().splitlines()[-1][:160])
    answer = json.loads(done.stdout)
    found.add("opening", answer["opening"])
    found.add("jump", *answer["jumps"])
    found.add("peak", answer["peak"])


def measure_program(
    name: str, environment: Environment, recording: Path, found: Found
) -> None:
    """From the command to the page, and the memory once nothing more is read."""
    if name == "sambot-viz":
        words = ["-m", "sambot_viz", "--port", "0", "--source", f"bag:{recording}"]
        command = [str(environment.python), *words]
    else:
        command = [str(environment.program("rerun")), str(recording), "--serve-web"]
        command += ["--bind", "127.0.0.1", "--port", "0", "--web-viewer-port", "0"]
    began = time.perf_counter()
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        bufsize=0,
        env={**os.environ, "RERUN_ANALYTICS_ENABLED": "false"},
        start_new_session=True,
    )
    try:
        _wait_for_address(process)
        found.add("page", time.perf_counter() - began)
        found.add("memory", _settled_memory(process.pid))
    finally:
        # The program is what a script in Python has started.
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        end(process)


def _wait_for_address(process: subprocess.Popen[bytes]) -> None:
    assert process.stdout is not None
    latest = time.perf_counter() + 60.0
    while time.perf_counter() < latest:
        ready, _, _ = select.select([process.stdout], [], [], 1.0)
        line = process.stdout.readline() if ready else b""
        if re.search(rb"https?://", line):
            return
        if ready and not line:
            break
    raise NotMeasured("says no address")


def _settled_memory(process: int) -> float:
    """The memory once the process has computed next to nothing for a second [MB]."""
    latest = time.perf_counter() + 90.0
    before = now = family_usage(process)
    while time.perf_counter() < latest:
        time.sleep(1.0)
        now = family_usage(process)
        if now.share_since(before) < 0.05:
            break
        before = now
    return now.memory
