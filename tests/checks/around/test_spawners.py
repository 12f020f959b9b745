"""Programs that put the robot into Gazebo: which one, its options and its world."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
SPAWN = """\
            Node(
                package={package},
                executable={program},
                arguments=[{name}, "cart", "-topic", "robot_description", "-z", "-1"],
            ),
"""
EXECUTE = "    ExecuteProcess,\n    SetEnvironmentVariable,\n"
OF_GZ = {"package": "'ros_gz_sim'", "program": "'create'", "name": "'-name'"}
OF_CLASSIC = {
    "package": '"gazebo_ros"',
    "program": '"spawn_entity.py"',
    "name": '"-entity"',
}
Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """A right package, to whose launch file `spawn` adds a spawner."""
    return copied("gz")


def spawn(package: Path, words: dict[str, str]) -> str:
    """Add a spawner to the launch file, and return the text of the file."""
    path = package / LAUNCH
    text = path.read_text()
    last = "            spawn,\n"
    assert last in text
    path.write_text(text.replace(last, last + SPAWN.format(**words)))
    return path.read_text()


@pytest.mark.parametrize(
    ("words", "code", "hint"),
    [
        (
            OF_CLASSIC,
            "gazebo-both",
            "write package='ros_gz_sim', executable='create' and '-name' for '-entity'",
        ),
        (OF_GZ | {"name": "'-entity'"}, "launch-code", "write -name"),
        (OF_GZ | {"name": "'-nmae'"}, "launch-code", "write -name"),
    ],
    ids=["of Classic", "option of Classic", "misspelt option"],
)
def test_the_spawner_of_the_other_gazebo_is_exchanged(
    package: Path, tmp_path: Path, words: dict[str, str], code: str, hint: str
) -> None:
    spawn(package, words)
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.hint) == (code, hint)
    made = edited_files(problem.edits)[str(package / LAUNCH)].decode()
    assert SPAWN.format(**OF_GZ) in made
    (package / LAUNCH).write_text(made)
    assert check(package / MODEL) == []


def test_gflags_take_a_dash_for_an_underscore(package: Path) -> None:
    spawn(package, OF_GZ | {"name": "'--allow-renaming', '-name'"})
    assert check(package / MODEL) == []


def test_a_package_for_both_has_both_ways(package: Path) -> None:
    second = spawn(package, OF_CLASSIC).replace("GzServer(world_sdf_file=world),", "")
    (package / "launch/second.launch.py").write_text(second)
    both = [p for p in check(package / MODEL) if p.code == "gazebo-both"]
    assert {p.hint[:31] for p in both} == {"start gazebo.launch.py and spaw"}
    assert not any(p.edits for p in both)


def test_the_path_of_a_world_is_not_its_name(package: Path) -> None:
    path = package / LAUNCH
    right = path.read_text().replace('"room"', "'room'")
    wrong = right.replace("'room'", "world")
    path.write_text(wrong.replace('"room.sdf"', "'room.sdf'"))
    (problem,) = check(package / MODEL)
    assert "world is the path of its file" in problem.message
    assert problem.hint == "write 'room'"
    made = edited_files(problem.edits)[str(path)].decode()
    assert made == right.replace('"room.sdf"', "'room.sdf'")


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"),
        ("GZ_SIM_SYSTEM_PLUGIN_PATH", "GAZEBO_PLUGIN_PATH"),
    ],
)
@pytest.mark.parametrize(
    "line", ['os.environ["{}"] = share', 'SetEnvironmentVariable("{}", share)']
)
def test_a_variable_of_the_other_gazebo_is_exchanged(
    package: Path, right: str, wrong: str, line: str
) -> None:
    path = package / LAUNCH
    text = path.read_text().replace("    ExecuteProcess,\n", EXECUTE)
    first = "    return LaunchDescription(\n        ["
    before = f"    {line}\n{first}" if "environ" in line else f"{first}\n    {line},"
    path.write_text(text.replace(first, before.format(wrong)))
    (problem,) = check(package)
    assert (problem.code, problem.hint) == ("gazebo-both", f"write {right}")
    made = edited_files(problem.edits)[str(path)].decode()
    assert made == text.replace(first, before.format(right))
    path.write_text(made.replace("import os\n", f"import os\n\nNAMES = ['{wrong}']\n"))
    assert check(package) == []
