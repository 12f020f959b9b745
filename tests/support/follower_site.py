"""A robot that three followers show behind nginx, each a process that can be killed.

with Site(folder, "arm.urdf") as site:
    site.robot.tell("move 600")              # its joint turns thirty times a second
    site.followers[0].kill()
    site.followers[0].start()
    site.port                                # of nginx, which shows them at /robot
"""

from __future__ import annotations

import os
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

import pytest
from live_peers import free_port
from patience import patience, until

REPOSITORY = Path(__file__).parents[2]
SUPPORT = Path(__file__).parent
JOINT, RATE = "j0", 30
NAME = "arm"
NEAR, TURN, SLOW = 0.1, 30.0, 10.0
"""Where a turn begins [rad], how long it lasts [s], and how long for 1 rad [s]."""
_START = 60.0

MODEL = (
    "<robot name='arm'><link name='base_link'/><link name='l0'><visual><geometry>"
    "<box size='.1 .1 .1'/></geometry></visual></link><joint name='j0' "
    "type='continuous'><axis xyz='0 0 1'/><parent link='base_link'/><child link='l0'/>"
    "</joint></robot>"
)

ROBOT = f"""
import select, sys, time
sys.path.insert(0, {str(SUPPORT)!r})
import foxglove, live_peers, numpy as np
from rosbags.typesys import Stores, get_typestore
store = get_typestore(Stores.ROS2_HUMBLE)
kind = "sensor_msgs/msg/JointState"
text = store.generate_msgdef(kind, ros_version=2)[0].encode()
peer = live_peers.FoxglovePeer()
schema = foxglove.Schema(name=kind, encoding="ros2msg", data=text)
channel = foxglove.Channel(
    "/joint_states", message_encoding="cdr", context=peer.context, schema=schema)
Time = store.types["builtin_interfaces/msg/Time"]
header = store.types["std_msgs/msg/Header"](Time(0, 0), "")
State, none = store.types[kind], np.zeros(0)
print(peer.uri, flush=True)
stays = None
while True:
    if select.select([sys.stdin], [], [], 1 / {RATE})[0]:
        word = sys.stdin.readline().split()
        if not word:
            break
        stays = float(word[1]) if word[0] == "stay" else None
    angle = {NEAR} + time.perf_counter() % {TURN} / {SLOW} if stays is None else stays
    state = State(header, [{JOINT!r}], np.full(1, angle), none, none)
    channel.log(bytes(store.serialize_cdr(state, kind)))
"""
"""Turns its joint as far as its clock says; "stay ANGLE" holds it, "move" goes on."""

ROUTER = """
import json, sys, zenoh
config = zenoh.Config()
for key, value in {
    "mode": "router",
    "listen/endpoints": [sys.argv[1]],
    "scouting/multicast/enabled": False,
    "timestamping/enabled": True,
}.items():
    config.insert_json5(key, json.dumps(value))
with zenoh.open(config):
    print("ready", flush=True)
    sys.stdin.read()
"""


def delay(at: float, angle: float) -> float:
    """Return how old a pose of the robot was when it came [s]."""
    return (at - (angle - NEAR) * SLOW) % TURN


class Part:
    """A process that can be killed and started again.

    Args:
        name: what it is.
        command: that starts it.
        log: what it writes to standard error is added here.
        is_ready: asked until it is; None where it prints a line when it is.

    Attributes:
        first_line: what it printed first.
        starts: how often it was started.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        log: Path,
        is_ready: Callable[[], bool] | None = None,
    ) -> None:
        self.name = name
        self._command, self._log, self._is_ready = command, log, is_ready
        self.first_line, self.starts = "", 0
        self._process: subprocess.Popen[str] | None = None

    @property
    def pid(self) -> int:
        """Its number."""
        assert self._process is not None
        return self._process.pid

    @property
    def is_running(self) -> bool:
        """Whether it has not ended."""
        return self._process is not None and self._process.poll() is None

    def start(self) -> None:
        """Start it, and wait until it is ready."""
        with self._log.open("a", encoding="utf-8") as log:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                start_new_session=True,
            )
        self.starts += 1
        if self._is_ready is not None:
            until(self._is_ready, _START, f"{self.name} is not ready", OSError)
            return
        assert self._process.stdout is not None
        stdout = self._process.stdout
        ready, _, _ = select.select([stdout], [], [], patience(_START))
        self.first_line = stdout.readline() if ready else ""
        assert self.first_line, f"{self.name} printed nothing: {self._log.read_text()}"

    def tell(self, words: str) -> None:
        """Send a line to its standard input."""
        assert self._process is not None and self._process.stdin is not None
        self._process.stdin.write(f"{words}\n")
        self._process.stdin.flush()

    def kill(self, how: int = signal.SIGKILL) -> None:
        """End it, and all that it has started."""
        process = self._process
        if process is None:
            return
        if process.poll() is None:
            os.killpg(process.pid, how)
        process.wait(patience(_START))
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                stream.close()
        self._process = None


def nginx_config(folder: Path, port: int, upstream: Sequence[int]) -> str:
    """The file of deploy/, with a balancer, without TLS and a login."""
    site = (REPOSITORY / "deploy" / "nginx.conf").read_text("utf-8")
    for before, after in (
        ("listen 80;", f"listen 127.0.0.1:{free_port()};"),
        ("listen 443 ssl;", f"listen 127.0.0.1:{port};"),
        ("lab.example.org", "localhost"),
        # All pages come from one address here.
        ("sambot_open 150", "sambot_open 5000"),
        ("rate=20r/s", "rate=5000r/s"),
        ("burst=200", "burst=5000"),
        ("proxy_pass http://127.0.0.1:8080", "proxy_pass http://robot"),
    ):
        assert before in site, before
        site = site.replace(before, after)
    site = re.sub(r"(?m)^ +(ssl_certificate|auth_basic).*\n", "", site)
    servers = " ".join(f"server 127.0.0.1:{p} fail_timeout=1s;" for p in upstream)
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    folders = "".join(f"{kind}_temp_path {folder}/{kind};" for kind in kinds)
    return (
        f"daemon off; pid {folder}/pid; user root; worker_rlimit_nofile 16384;\n"
        "events { worker_connections 8192; }\n"
        f"http {{ access_log off; {folders}\n"
        f"upstream robot {{ least_conn; {servers} }}\n{site} }}\n"
    )


class Site:
    """The robot, its origin, a router, followers, and nginx in front of them.

    Args:
        folder: for their files.
        followers: how many.

    Attributes:
        port: of nginx, which shows the followers at `path`.
        path: of the page, at nginx and at followers.
        origin_port: of the origin, which shows the robot at "/".
    """

    path = "/robot"

    def __init__(self, folder: Path, followers: int = 3) -> None:
        nginx = shutil.which("nginx", path="/usr/sbin:/usr/bin:/usr/local/bin")
        if nginx is None:
            pytest.skip("needs nginx (Debian: apt-get install nginx)")
        self.log = folder / "log"
        model, config = folder / "arm.urdf", folder / "nginx.conf"
        model.write_text(MODEL, "utf-8")
        router, self.origin_port, self.port = free_port(), free_port(), free_port()
        ports = [free_port() for _ in range(followers)]
        config.write_text(nginx_config(folder, self.port, ports), "utf-8")
        place, python = f"zenoh://127.0.0.1:{router}/{NAME}", sys.executable
        self.robot = Part("robot", (python, "-c", ROBOT), self.log)
        self.router = Part(
            "router", (python, "-c", ROUTER, f"tcp/127.0.0.1:{router}"), self.log
        )
        ours = (python, "-m", "sambot_viz")
        self._origin = (*ours, str(model), "--no-watch", "--broadcast", place)
        self._origin += ("--port", str(self.origin_port))
        follow = (*ours, "--follow", place, "--base-path", self.path, "--port")
        self.followers = [
            Part(f"follower {number}", (*follow, str(port)), self.log)
            for number, port in enumerate(ports, 1)
        ]
        command = (nginx, "-p", str(folder), "-e", "stderr", "-c", str(config))
        self.nginx = Part("nginx", command, self.log, lambda: answers(self.port))

    def __enter__(self) -> Site:
        with ExitStack() as stack:
            for part in (self.robot, self.router):
                stack.callback(part.kill)
                part.start()
            source = ("--source", self.robot.first_line.strip())
            self.origin = Part("origin", (*self._origin, *source), self.log)
            for part in (self.origin, *self.followers, self.nginx):
                stack.callback(part.kill)
                part.start()
            self._stack = stack.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()

    @property
    def parts(self) -> tuple[Part, ...]:
        """All but the robot."""
        return (*self.followers, self.router, self.nginx, self.origin)


def answers(port: int) -> bool:
    """Return whether something listens.

    Raises:
        OSError: nothing does.
    """
    socket.create_connection(("127.0.0.1", port), 1.0).close()
    return True
