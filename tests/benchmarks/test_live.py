"""A live robot with 30 joints at 1 kHz: computing, and the way of a message to a page.

    python -m pytest tests/benchmarks/test_live.py -s

The robot, the server and the light browsers have processes of their own, but they share
the machine.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

from crowd import Crowd, Light
from mcap.reader import make_reader
from patience import until
from steps import delays, report
from usage import usage

RunServer = Callable[[Sequence[str]], AbstractContextManager[Any]]

JOINTS, SPEED, SECONDS = 30, 0.3, 8.0
"""How many joints, how fast they turn [rad/s] and how long [s]."""
FAST, FRAME_RATE = 1000, 30
"""Messages in a second: many more than pictures, and one for each."""
BROWSERS = 3

TALKER = f"""
import sys, time
sys.path.insert(0, {str(Path(__file__).parents[1] / "support")!r})
import foxglove, live_peers, numpy as np
from rosbags.typesys import Stores, get_typestore
store = get_typestore(Stores.ROS2_HUMBLE)
kind = "sensor_msgs/msg/JointState"
text = store.generate_msgdef(kind, ros_version=2)[0].encode()
peer = live_peers.FoxglovePeer()
schema = foxglove.Schema(name=kind, encoding="ros2msg", data=text)
channel = foxglove.Channel(
    "/joint_states", message_encoding="cdr", context=peer.context, schema=schema)
names = [f"j{{n}}" for n in range({JOINTS})]
Time = store.types["builtin_interfaces/msg/Time"]
header = store.types["std_msgs/msg/Header"](Time(0, 0), "")
State, none = store.types[kind], np.zeros(0)
print(peer.uri, flush=True)
for line in sys.stdin:
    rate, count = map(int, line.split())
    start = time.perf_counter()
    print(start, flush=True)
    for at in (n / rate for n in range(count)):
        time.sleep(max(0.0, start + at - time.perf_counter()))
        state = State(header, names, np.full({JOINTS}, at * {SPEED}), none, none)
        channel.log(bytes(store.serialize_cdr(state, kind)))
    print("said", flush=True)
"""


def model() -> str:
    """A robot whose links turn as their joints do."""
    links = "".join(
        f"<link name='l{n}'><visual><geometry><box size='.1 .1 .1'/></geometry>"
        f"</visual></link><joint name='j{n}' type='continuous'><axis xyz='0 0 1'/>"
        f"<origin xyz='{n % 6} {n // 6} 0'/><parent link='base_link'/>"
        f"<child link='l{n}'/></joint>"
        for n in range(JOINTS)
    )
    return f"<robot name='many'><link name='base_link'/>{links}</robot>"


@contextmanager
def talker() -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, "-c", TALKER],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def line(process: subprocess.Popen[str], say: str = "") -> str:
    """Say a line to the talker, and read one."""
    assert process.stdin is not None and process.stdout is not None
    if say:
        process.stdin.write(f"{say}\n")
        process.stdin.flush()
    return process.stdout.readline().strip()


def test_messages_between_two_pictures_cost_little(
    run_server: RunServer, tmp_path: Path
) -> None:
    robot, path = tmp_path / "many.urdf", tmp_path / "all.mcap"
    robot.write_text(model(), "utf-8")
    with talker() as process:
        words = ["-m", "sambot_viz", str(robot), "--port", "0", "--source"]
        words += [line(process), "--record", str(path)]
        with run_server(words) as server, Crowd(server.port, BROWSERS) as crowd:
            # Until the topic is there, nothing moves.
            until(lambda: _moves(process, crowd), 60.0, not_yet=())
            print(f"\n{JOINTS} joints, {BROWSERS} browsers, all is recorded")
            shares = [
                _one_round(process, crowd, server.process, rate)
                for rate in (FRAME_RATE, FAST)
            ]
    with path.open("rb") as stream:
        written = sum(1 for _ in make_reader(stream).iter_messages())
    print(f"  {written} messages recorded")
    assert written >= SECONDS * (FRAME_RATE + FAST)
    # As many pictures are drawn of both.
    assert shares[1] <= 2.5 * shares[0]


def _one_round(
    process: subprocess.Popen[str], crowd: Crowd, server: int, rate: int
) -> float:
    """Let the robot move; returns the share of a core that the server took."""
    crowd.look()
    before = usage(server)
    start = float(line(process, f"{rate} {round(SECONDS * rate)}"))
    assert line(process) == "said"
    share = usage(server).share_since(before)
    name = f"{rate} Hz: {share:.1%} of a core; message to browser"
    report(name, _delays(start, crowd.look(), rate))
    return share


def _moves(process: subprocess.Popen[str], crowd: Crowd) -> bool:
    line(process, "1000 50")
    assert line(process) == "said"
    return all(light.poses for light in crowd.look())


def _delays(start: float, lights: Sequence[Light], rate: int) -> list[float]:
    """How long each message took until it, or a later one, was there [s]."""
    found: list[float] = []
    for light in lights:
        seen = [(at, angle) for at, angle in light.poses if at > start]
        last = max(angle for _, angle in seen)
        times = (n / rate for n in range(round(SECONDS * rate)))
        sent = [(start + at, at * SPEED) for at in times]
        sent = [one for one in sent if 0.1 < one[1] < last - 0.01]
        found += delays(sent, seen, 1e-5)
    return found
