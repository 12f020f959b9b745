"""From a file to what a browser receives: whatever the file, the page works."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from message_faults import faults
from protocol_client import ProtocolClient

from sambot_viz import RobotError, Visualizer
from sambot_viz.session import Session

Connect = Callable[..., ProtocolClient]
EACH = 13
"""Every 13th real robot is shown here; all of them are loaded elsewhere."""

LIMIT = '<limit lower="{0}" upper="{1}" effort="1" velocity="1"/>'
NUMBERS = ("1e308", "-1e308", "4e38", "1e-320", "0", "-1")
NAMES = (
    *("a/b", "/a", "../x", "&lt;script&gt;alert(1)&lt;/script&gt;", "&lt;b&gt;", " "),
    *("&lt;Fixed Frame&gt;", "map", "world", "Center", "Randomize", "Joints", "~1a"),
    *("__proto__", "constructor", "&#9;tab", "&#127;", "\u202eright", "\ufeffbom"),
    *("\N{GRINNING FACE}", "\N{HANGUL SYLLABLE HAN}", "{}", "%s", "\\", ".", "0"),
)


@pytest.fixture
def show(protocol: Connect) -> Iterator[Callable[..., list[str]]]:
    """Show a model, move its joints, and give what would harm a browser."""

    def show(model: Path) -> list[str]:
        with Visualizer(model, port=0) as viz:
            client = protocol(viz.viser.get_port())
            session = session_of(viz)
            client.wait_until(lambda: not reading(session), 30.0)
            session.robot.randomize(1)
            client.settle(viz.viser, 30.0)
            session.robot.center()
            client.settle(viz.viser, 30.0)
            messages = client.messages
            client.close()
        return faults(messages)

    yield show


def session_of(viz: Visualizer) -> Session:
    return viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]


def reading(session: Session) -> bool:
    with session.lock:
        rows = [
            r
            for display in session.scene.displays
            for r in display.status.rows.values()
        ]
    return any("still being read" in row.text for row in rows)


def robot(numbers: str, names: str = "b") -> str:
    """A robot with the number wherever a file can hold one."""
    n = numbers
    visual = "".join(
        f'<visual><origin xyz="{n} 0 {n}" rpy="{n} 0 0"/><geometry>{shape}</geometry>'
        "</visual>"
        for shape in (
            f'<box size="{n} 1 {n}"/>',
            f'<sphere radius="{n}"/>',
            f'<cylinder radius="{n}" length="{n}"/>',
            f'<capsule radius="{n}" length="{n}"/>',
            f'<mesh filename="tri.obj" scale="{n} {n} 1"/>',
        )
    )
    mass = f'<mass value="{n}"/><inertia ixx="{n}" ixy="0" ixz="0" iyy="{n}" iyz="0" '
    inertial = f'<inertial>{mass}izz="{n}"/></inertial>'
    joint = f'<origin xyz="{n} 0 0" rpy="0 {n} 0"/><axis xyz="{n} 1 0"/>'
    mimic = f'<mimic joint="j" multiplier="{n}" offset="{n}"/>'
    return (
        f'<robot name="{names}"><link name="base_link"/>'
        f'<link name="{names}">{inertial}{visual}</link>'
        '<link name="c"/><link name="d"/>'
        f'<joint name="j" type="prismatic"><parent link="base_link"/>'
        f'<child link="{names}"/>{joint}{LIMIT.format(n, n.lstrip("-"))}</joint>'
        f'<joint name="{names}" type="revolute"><parent link="base_link"/>'
        f'<child link="c"/>{LIMIT.format("-" + n.lstrip("-"), 1)}</joint>'
        f'<joint name="k" type="prismatic"><parent link="c"/><child link="d"/>'
        f"{LIMIT.format(-1, 1)}{mimic}</joint></robot>"
    )


@pytest.mark.parametrize("number", NUMBERS)
def test_no_number_of_a_file_harms_a_browser(
    number: str, tmp_path: Path, show: Callable[[Path], list[str]]
) -> None:
    (tmp_path / "tri.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1e30 0\nf 1 2 3\n")
    model = tmp_path / "m.urdf"
    model.write_text(robot(number))
    assert show(model) == []


def test_no_name_of_a_file_harms_a_browser(
    tmp_path: Path, show: Callable[[Path], list[str]]
) -> None:
    links = "".join(f'<link name="{name}"/>' for name in NAMES)
    joints = "".join(
        f'<joint name="{name}" type="continuous"><parent link="base_link"/>'
        f'<child link="{name}"/></joint>'
        for name in NAMES
    )
    model = tmp_path / "m.urdf"
    model.write_text(
        f'<robot name="{NAMES[3]}"><link name="base_link"/>{links}{joints}</robot>',
        "utf-8",
    )
    assert show(model) == []


def test_a_name_of_a_million_letters_harms_no_browser(
    tmp_path: Path, show: Callable[[Path], list[str]]
) -> None:
    model = tmp_path / "m.urdf"
    model.write_text(robot("1", "x" * 1_000_000))
    assert show(model) == []


def test_real_robots_are_shown_whole(
    shared: Path, show: Callable[[Path], list[str]]
) -> None:
    folder = shared / "data" / "robots"
    index = yaml.safe_load((folder / "index.yaml").read_text("utf-8"))
    entries: list[dict[str, Any]] = index["robots"]
    wanted = [e["path"] for e in entries if e["expected"].startswith("render")]
    found: dict[str, list[str]] = {}
    for path in wanted[::EACH]:
        try:
            found[path] = show(folder / path)
        except RobotError as error:
            found[path] = [str(error)]
    assert len(found) > 5
    assert {path: what for path, what in found.items() if what} == {}
