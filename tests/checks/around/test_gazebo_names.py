"""Names of Gazebo's plugins and sensors, and what a world has to have."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
WORLD = "world/room.sdf"
SYSTEMS = """\
    <plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
    <plugin filename="gz-sim-user-commands-system"
      name="gz::sim::systems::UserCommands"/>
    <plugin filename="gz-sim-scene-broadcaster-system" name="SceneBroadcaster"/>
    <plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
    <plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
"""
Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """A right package whose world lists its systems."""
    folder = copied("gz")
    text = f'<sdf version="1.8">\n  <world name="room">\n{SYSTEMS}  </world>\n</sdf>\n'
    (folder / WORLD).write_text(text)
    return folder


@pytest.mark.parametrize(
    ("file", "name"),
    [("gz-sim-imu-system", "Sensors"), ("gz-sim-sensors-system", "Imu")],
)
def test_of_two_systems_in_one_plugin_the_missing_one_is_meant(
    package: Path, file: str, name: str
) -> None:
    right = (package / WORLD).read_text()
    lines = right.splitlines(keepends=True)
    space = "gz::sim::systems"
    wrong = f'    <plugin filename="{file}" name="{space}::{name}"/>\n'
    text = "".join(wrong if "::Imu" in line else line for line in lines)
    (package / WORLD).write_text(text)
    (problem,) = check(package / MODEL)
    assert problem.code == "gazebo-plugin"
    edited = edited_files(problem.edits)[str(package / WORLD)]
    assert edited.decode() == right


def edit(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text()
    assert old in text, old
    (folder / file).write_text(text.replace(old, new, 1))


def test_a_right_world_gives_nothing(package: Path) -> None:
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("system", "says"),
    [
        ("physics", "needs: it does not move"),
        ("user-commands", "the spawner needs (display.launch.py line 54): the robot"),
        ("imu", "needs (cart.urdf.xacro line 51): it sends nothing"),
    ],
)
def test_a_world_needs_its_systems(package: Path, system: str, says: str) -> None:
    plugins = SYSTEMS.split("    <plugin ")
    plugin = next(plugin for plugin in plugins if f"sim-{system}-" in plugin)
    edit(package, WORLD, f"    <plugin {plugin}", "")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.line) == ("world-system", 2)
    assert says in problem.message
    added = problem.hint.removeprefix("add ").removesuffix(" to the world")
    edit(package, WORLD, "  </world>", f"{added}\n  </world>")
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "change",
    [
        ("<plugin", "<was"),
        ("gz-sim-physics-system", "libignition-gazebo6-physics-system.so"),
        ("gz-sim-physics-system", "libgz-sim8-physics-system.so"),
    ],
)
def test_a_world_without_systems_gets_those_of_gazebo(
    package: Path, change: tuple[str, str]
) -> None:
    text = (package / WORLD).read_text()
    (package / WORLD).write_text(text.replace(*change))
    assert check(package / MODEL) == []


def test_a_system_of_another_package_may_have_a_word_more(package: Path) -> None:
    own = '<plugin filename="gz-sim-yarp-forcetorque-system" name="x::Y"/>'
    edit(package, WORLD, "  </world>", f"    {own}\n  </world>")
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("code", "file", "right", "wrong", "line", "hint"),
    [
        (
            "gazebo-plugin",
            MODEL,
            'filename="gz-sim-diff-drive-system"',
            'filename="gz-sim-difdrive-system"',
            63,
            'write filename="gz-sim-diff-drive-system"',
        ),
        (
            "gazebo-plugin",
            MODEL,
            'filename="gz-sim-joint-state-publisher-system"',
            'filename="gz-sim-joint-state-publisher"',
            74,
            'write filename="gz-sim-joint-state-publisher-system"',
        ),
        (
            "gazebo-plugin",
            WORLD,
            'filename="gz-sim-physics-system"',
            'filename="gz-sim-phisics-system"',
            3,
            'write filename="gz-sim-physics-system"',
        ),
        (
            "gazebo-sensor",
            MODEL,
            'type="gpu_lidar"',
            'type="gpu_laser"',
            57,
            'write type="gpu_lidar"',
        ),
        (
            "world-xml",
            WORLD,
            "  </world>\n",
            "",
            9,
            "correct this line or the one above it: each <tag> needs its </tag>",
        ),
        (
            "launch-world-name",
            WORLD,
            'name="room"',
            'name="my room"',
            2,
            'write name="room"',
        ),
    ],
)
def test_a_wrong_name_is_found_and_its_fix_leaves_nothing(
    package: Path, code: str, file: str, right: str, wrong: str, line: int, hint: str
) -> None:
    edit(package, file, right, wrong)
    problems = check(package / MODEL)
    assert [(p.code, p.line, p.hint) for p in problems] == [(code, line, hint)]
    assert problems[0].file == str(package / file)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("gz-sim-diff-drive-system", "libmy_drive.so"),
        ("gz-sim-diff-drive-system", "gz-sim-our-own-system"),
        ('type="gpu_lidar"', 'type="radar"'),
    ],
)
def test_what_others_bring_is_not_judged(package: Path, right: str, wrong: str) -> None:
    edit(package, MODEL, right, wrong)
    codes = {problem.code for problem in check(package / MODEL)}
    assert codes.isdisjoint({"gazebo-plugin", "gazebo-sensor"})
