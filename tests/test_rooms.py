"""The rooms of the house and who may know whom (DESIGN §3)."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PURE = ("robot", "checks", "rviz", "frames", "joints")
ABOVE = {
    "robot": ("checks", "rviz", "frames", "joints", "displays", "views", "tools"),
    "checks": ("displays", "views", "tools", "panels", "session", "server"),
    "rviz": ("robot", "displays", "views", "tools", "panels", "session", "server"),
    "frames": ("displays", "views", "tools", "panels", "session", "server"),
    "joints": ("displays", "views", "tools", "panels", "session", "server"),
    "displays": ("panels", "session", "server"),
    "views": ("panels", "session", "server"),
}
"""Room → rooms it must not know: the flow of DESIGN §2 has one direction."""


def modules(repository: Path, room: str) -> list[Path]:
    found = sorted((repository / "src" / "sambot_viz" / room).rglob("*.py"))
    assert found
    return found


def imports(path: Path) -> set[str]:
    """Every module a file imports, wherever in the file."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    return names


@pytest.mark.parametrize("room", PURE)
def test_a_pure_room_imports_no_viewer_opens_no_socket_and_starts_no_thread(
    repository: Path, room: str
) -> None:
    forbidden = ("viser", "socket", "asyncio", "websockets", "http", "socketserver")
    for path in modules(repository, room):
        bad = {n for n in imports(path) if n.split(".")[0] in forbidden}
        assert not bad, f"{path.name} imports {bad}"
        assert "threading.Thread" not in path.read_text("utf-8"), path.name


@pytest.mark.parametrize("room", sorted(ABOVE))
def test_a_room_does_not_know_the_rooms_above_it(repository: Path, room: str) -> None:
    for path in modules(repository, room):
        for name in imports(path):
            parts = name.split(".")
            if parts[0] == "sambot_viz" and len(parts) > 1:
                assert parts[1] not in ABOVE[room], f"{room}/{path.name} knows {name}"


@pytest.mark.parametrize(
    "words",
    [
        ["--help"],
        ["--version"],
        ["check", "--help"],
        ["check", "MODEL"],
        ["expand", "MODEL"],
        ["echo", "MODEL", "base_link", "front_caster"],
        ["frames", "MODEL"],
    ],
)
def test_a_light_command_imports_neither_viser_nor_a_mesh_library(
    repository: Path, words: list[str]
) -> None:
    model = str(repository / "assets" / "sam_bot.urdf.xacro")
    words = [model if word == "MODEL" else word for word in words]
    script = (
        "import sys\n"
        "from sambot_viz.cli import main\n"
        "try:\n"
        f"    main({words!r})\n"
        "except SystemExit:\n"
        "    pass\n"
        "heavy = {'viser', 'trimesh', 'yourdfpy', 'scipy', 'PIL'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, capture_output=True)


def test_the_public_names_are_those_of_the_design() -> None:
    import sambot_viz

    assert sambot_viz.__all__ == sorted(sambot_viz.__all__)
    for name in sambot_viz.__all__:
        assert getattr(sambot_viz, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'Robto'"):
        _ = sambot_viz.Robto
