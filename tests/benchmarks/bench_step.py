"""What one step of the joints costs the server, beside viser's own ViserUrdf.

Run it with ``pytest tests/benchmarks/bench_step.py -s``. It counts CPU time of the
whole process, the event loop included, with no browser connected.
"""

from __future__ import annotations

import io
import itertools
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import viser
import yourdfpy
from inside import session_of
from viser.extras import ViserUrdf

from sambot_viz import Visualizer

STEPS = 100
LIMITS = {("one", 6): 0.4, ("one", 50): 0.1, ("one", 300): 0.05}
"""Our time divided by ViserUrdf's, at most; for all joints 0.6."""


def robot_text(joints: int) -> str:
    """A tree of boxes, each the parent of three, with a continuous joint at each."""
    box = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    links = "".join(f'<link name="l{i}">{box}</link>' for i in range(joints + 1))
    held = "".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{(i - 1) // 3}"/>'
        f'<child link="l{i}"/><origin xyz="0.2 0 0.1" rpy="0.1 0 0"/>'
        '<axis xyz="0 0 1"/></joint>'
        for i in range(1, joints + 1)
    )
    return f'<robot name="tree">{links}{held}</robot>'


def cpu_of(step: Callable[[float], object]) -> float:
    """CPU time of one step [ms], the best of five series."""
    angles = itertools.count(1)
    best = float("inf")
    for _ in range(5):
        start = time.process_time()
        for _ in range(STEPS):
            step(0.001 * next(angles))
        best = min(best, time.process_time() - start)
    return 1000 * best / STEPS


@pytest.mark.parametrize("joints", [6, 50, 300])
@pytest.mark.parametrize("moved", ["one", "all"])
def test_a_step_costs_what_it_moves(tmp_path: Path, joints: int, moved: str) -> None:
    text = robot_text(joints)
    model = tmp_path / "tree.urdf"
    model.write_text(text, "utf-8")
    names = [f"j{i}" for i in range(1, joints + 1)]
    steps = names if moved == "all" else [names[joints // 2]]
    with Visualizer(model, port=0) as viz:
        # Every step is to be drawn, not only those at the frame rate.
        session_of(viz).robot.set_period(0.0)
        ours = cpu_of(lambda q: viz.set_joint_positions(dict.fromkeys(steps, q)))
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    urdf = ViserUrdf(server, yourdfpy.URDF.load(io.StringIO(text)))
    theirs = cpu_of(
        lambda q: urdf.update_cfg({n: q if n in steps else 0.0 for n in names})
    )
    server.stop()
    ratio = ours / theirs
    print(f"\n  {moved} of {joints} joints: {ours:.3f} ms, {theirs:.3f}, {ratio:.3f}")
    assert ratio < LIMITS.get((moved, joints), 0.6)
