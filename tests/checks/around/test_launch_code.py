"""A launch file that Python reads and ros2 launch stops with is found and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
ENTRY = "generate_launch_description"

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("right", "wrong", "line", "cause", "hint", "fixed"),
    [
        (
            "from launch_ros.actions import Node\n",
            "",
            26,
            "Node is used here, but it is neither imported nor defined",
            "add from launch_ros.actions import Node at the top of the file",
            ("import os\n", "import os\nfrom launch_ros.actions import Node\n"),
        ),
        (
            "import os\n",
            "",
            20,
            "os is used here",
            "add import os at the top of the file",
            ("from launch import L", "import os\nfrom launch import L"),
        ),
        (
            "            bridge,",
            "            brigde,",
            64,
            "brigde is used here",
            "write bridge",
            ("brigde", "bridge"),
        ),
        (
            ENTRY,
            f"{ENTRY}s",
            18,
            f"this one is called {ENTRY}s",
            f"write {ENTRY}",
            (f"{ENTRY}s", ENTRY),
        ),
        (
            "    return LaunchDescription(",
            "    LaunchDescription(",
            59,
            f"{ENTRY} (line 18) returns nothing",
            "write return LaunchDescription(",
            ("    LaunchDescription(", "    return LaunchDescription("),
        ),
        (
            "    return LaunchDescription(",
            "    started = LaunchDescription(",
            18,
            "returns nothing",
            "add return started at its end",
            ("        ]\n    )\n", "        ]\n    )\n    return started\n"),
        ),
    ],
)
def test_what_stops_ros2_launch(
    copied: Copied,
    right: str,
    wrong: str,
    line: int,
    cause: str,
    hint: str,
    fixed: tuple[str, str],
) -> None:
    package = copied("gz")
    launch = package / LAUNCH
    text = launch.read_text()
    assert right in text
    text = text.replace(right, wrong, 1)
    launch.write_text(text)

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.severity) == ("launch-code", "error")
    assert (problem.file, problem.line) == (str(launch), line)
    assert cause in problem.message
    assert problem.hint == hint
    old, new = fixed
    at = text.rindex(old)
    launch.write_text(text[:at] + new + text[at + len(old) :])
    assert check(package / MODEL) == []


def test_a_module_with_such_a_name_is_no_launch_file(copied: Copied) -> None:
    package = copied("gz")
    text = (package / LAUNCH).read_text().replace(ENTRY, "gen_launch")
    module = package / "cart_bringup" / "gen_launch.py"
    module.parent.mkdir()
    module.write_text(text)
    assert "launch-code" in {p.code for p in check(package / MODEL)}
    (module.parent / "__init__.py").touch()
    assert "launch-code" not in {p.code for p in check(package / MODEL)}


def test_an_empty_launch_file(copied: Copied) -> None:
    package = copied("gz")
    empty = package / "launch" / "empty.launch.py"
    empty.write_text("\n")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.file) == ("launch-code", str(empty))
    assert problem.severity == "warning"
    assert problem.hint.startswith("delete the file")
    empty.unlink()
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "other",
    [
        "from helpers import *\nprint(anything)\n",
        "def helper(item, *more, key=None, **rest):\n    return [i for i in more]\n",
        "try:\n    import yaml\nexcept ImportError as error:\n    print(error)\n",
        "print(__file__, __name__, max(1, 2))\n",
        "with open(__file__) as file:\n    first = file.readline()\n",
        "import launch.actions\nprint(launch.actions.LogInfo)\n",
        "if (found := os.environ.get('A')):\n    print(found)\n",
        "exec('a = 1')\nprint(a)\n",
    ],
)
def test_names_that_have_a_value_are_not_reported(copied: Copied, other: str) -> None:
    package = copied("gz")
    launch = package / LAUNCH
    launch.write_text(launch.read_text().replace("import os\n", f"import os\n{other}"))
    assert check(package / MODEL) == []


def test_a_function_from_elsewhere_and_one_that_only_raises(copied: Copied) -> None:
    package = copied("gz")
    (package / "launch" / "a.launch.py").write_text(
        f"from helpers import {ENTRY}\n\ndef {ENTRY}s():\n    return []\n"
    )
    (package / "launch" / "b.launch.py").write_text(
        f"def {ENTRY}():\n    raise RuntimeError('use a.launch.py')\n"
    )
    assert check(package / MODEL) == []
