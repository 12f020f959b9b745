"""What setup.py installs, imports and starts wrongly is found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

MODEL = "urdf/cart.urdf.xacro"
SETUP = "setup.py"
EDIT = tuple[str, str, str]
CONFIG = "(os.path.join('share', package_name, 'config'), glob('config/*.yaml')),"
TEXT = f"""\
import os
from glob import glob
from setuptools import find_packages, setup

package_name = 'cart_description'

setup(
    name=package_name,
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*.launch.py')),
        ('share/' + package_name + '/urdf', glob('urdf/*')),
        {CONFIG}
        (f'share/{{package_name}}/rviz', glob(os.path.join('rviz', '*.rviz'))),
        ('share/%s/world' % package_name, ['world/room.sdf']),
    ],
    entry_points={{
        'console_scripts': [
            'drive = cart_description.drive:main',
            'stop = cart_description.stop:main',
        ],
    }},
)
"""
CFG = """\
[develop]
script_dir=$base/lib/cart_description
[install]
install_scripts=$base/lib/cart_description
"""


@pytest.fixture
def package(copied: Callable[[str], Path]) -> Path:
    """A right package of Python."""
    folder = copied("gz")
    (folder / "CMakeLists.txt").unlink()
    edit(folder, ("package.xml", ">ament_cmake</build", ">ament_python</build"))
    files = {
        SETUP: TEXT,
        "setup.cfg": CFG,
        "resource/cart_description": "",
        "cart_description/__init__.py": "",
        "cart_description/drive.py": "def main():\n    pass\n",
        "cart_description/stop.py": "from cart_description.drive import main\n",
    }
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    return folder


def edit(folder: Path, *edits: EDIT) -> None:
    for file, old, new in edits:
        text = (folder / file).read_text()
        assert old in text, old
        (folder / file).write_text(text.replace(old, new))


def found(folder: Path) -> list[Problem]:
    return check(folder / MODEL)


def test_a_right_package_gives_nothing(package: Path) -> None:
    assert found(package) == []


@pytest.mark.parametrize(
    ("code", "wrong", "line", "cause", "hint", "better"),
    [
        pytest.param(
            "install-glob-empty",
            (SETUP, "glob('config/*.yaml')", "glob('params/*.yaml')"),
            15,
            "params/*.yaml fits no file, so nothing is installed into "
            "share/cart_description/config, but display.launch.py line 40 looks for "
            "config/ekf.yaml and config/bridge_config.yaml: it is not found",
            "write glob('config/*.yaml')",
            (SETUP, "glob('params/*.yaml')", "glob('config/*.yaml')"),
            id="other folder",
        ),
        pytest.param(
            "install-glob-empty",
            (SETUP, "'*.rviz'", "'*.yaml'"),
            16,
            "rviz/*.yaml fits no file",
            "write glob('rviz/*.rviz')",
            (SETUP, "glob(os.path.join('rviz', '*.yaml'))", "glob('rviz/*.rviz')"),
            id="other ending",
        ),
        pytest.param(
            "install-destination",
            (SETUP, ", package_name, 'config')", ", package_name)"),
            15,
            "config/ekf.yaml and config/bridge_config.yaml",
            "write 'share/' + package_name + '/config'",
            (
                SETUP,
                "(os.path.join('share', package_name), glob('config",
                "('share/' + package_name + '/config', glob('config",
            ),
            id="other target",
        ),
        pytest.param(
            "folder-not-installed",
            (SETUP, "['world/room.sdf']", "[]"),
            10,
            "the folder world is not installed, but display.launch.py line 23",
            "add ('share/' + package_name + '/world', glob('world/*')) to data_files",
            (
                SETUP,
                "    ],\n    entry",
                "    ('share/' + package_name + '/world', glob('world/*'))"
                "],\n    entry",
            ),
            id="nowhere",
        ),
        pytest.param(
            "folder-not-installed",
            (SETUP, f"        {CONFIG}\n", ""),
            10,
            "the folder config is not installed, but display.launch.py line 40 looks",
            "add ('share/' + package_name + '/config', glob('config/*')) to data_files",
            (
                SETUP,
                "    ],\n    entry",
                "    ('share/' + package_name + '/config', glob('config/*'))"
                "],\n    entry",
            ),
            id="no entry",
        ),
        pytest.param(
            "setup-py-code",
            (SETUP, "glob('urdf/*')),", "glob('urdf/*'))"),
            14,
            "a comma is missing at the end of this line",
            "add a comma there",
            (SETUP, "glob('urdf/*'))", "glob('urdf/*')),"),
            id="comma",
        ),
        pytest.param(
            "setup-py-code",
            (SETUP, "drive:main',", "drive:main'"),
            21,
            "two programs of console_scripts are one text",
            "add a comma before line 22",
            (SETUP, "drive:main'", "drive:main',"),
            id="comma between texts",
        ),
        pytest.param(
            "setup-py-code",
            (SETUP, "from glob import glob\n", ""),
            12,
            "glob is used here, but it is neither imported nor defined: colcon build",
            "add from glob import glob at the top of the file",
            (SETUP, "import os\n", "import os\nfrom glob import glob\n"),
            id="glob",
        ),
        pytest.param(
            "setup-py-code",
            (SETUP, "import os\n", ""),
            12,
            "os is used here",
            "add import os at the top of the file",
            (SETUP, "from glob", "import os\nfrom glob"),
            id="os",
        ),
        pytest.param(
            "setup-file-missing",
            (SETUP, "world/room.sdf", "world/rom.sdf"),
            17,
            "data_files lists world/rom.sdf, which does not exist: colcon build stops",
            "write world/room.sdf",
            (SETUP, "world/rom.sdf", "world/room.sdf"),
            id="file",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "cart_description.stop", "cart_description.stopp"),
            22,
            "but there is no cart_description/stopp.py; there is "
            "cart_description/stop.py: ros2 run stops with it",
            "write stop = cart_description.stop:main",
            (SETUP, "cart_description.stopp:", "cart_description.stop:"),
            id="module",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "= cart_description.stop", "= cart.stop"),
            22,
            "the package has no folder cart: ros2 run stops",
            "write stop = cart_description.stop:main",
            (SETUP, "= cart.stop", "= cart_description.stop"),
            id="package",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "cart_description.stop", "cart_description.stops"),
            22,
            "there is cart_description/stop.py: ros2 run stops",
            "write stop = cart_description.stop:main",
            (SETUP, "cart_description.stops", "cart_description.stop"),
            id="module",
        ),
        pytest.param(
            "entry-point-missing",
            (
                SETUP,
                "stop = cart_description.stop",
                "drive_on = cart_description.drive_on",
            ),
            22,
            "there is no cart_description/drive_on.py: ros2 run stops",
            "make that file, or delete drive_on",
            (SETUP, "cart_description.drive_on", "cart_description.drive"),
            id="module that is another",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "drive:main", "drive:mian"),
            21,
            "cart_description/drive.py has no mian; it has main",
            "write drive = cart_description.drive:main",
            (SETUP, "drive:mian", "drive:main"),
            id="function",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "find_packages(exclude=['test'])", "['cart']"),
            21,
            "packages (line 9) does not list cart_description, so it is not installed",
            "write ['cart_description']",
            (SETUP, "['cart']", "['cart_description']"),
            id="packages",
        ),
        pytest.param(
            "entry-point-missing",
            (SETUP, "find_packages(exclude=['test'])", "[]"),
            21,
            "packages (line 9) does not list cart_description, so it is not installed",
            "add 'cart_description' to packages",
            (SETUP, "=[],", "=['cart_description'],"),
            id="no packages",
        ),
        pytest.param(
            "setup-cfg-folder",
            ("setup.cfg", "lib/cart_description", "lib/cart"),
            2,
            "ros2 run does not find drive and stop (setup.py line 21)",
            "write $base/lib/cart_description here and in line 4",
            ("setup.cfg", "lib/cart", "lib/cart_description"),
            id="setup.cfg",
        ),
    ],
)
def test_a_mistake_is_found_at_its_line_and_its_fix_leaves_nothing(
    package: Path,
    code: str,
    wrong: EDIT,
    line: int,
    cause: str,
    hint: str,
    better: EDIT,
) -> None:
    edit(package, wrong)
    (problem,) = found(package)
    assert problem.code == code
    assert problem.line == line
    assert cause in problem.message
    assert problem.hint == hint
    edit(package, better)
    assert found(package) == []


@pytest.mark.parametrize(
    ("imports", "called"),
    [("import glob", "glob.glob"), ("import glob as g", "g.glob")],
)
def test_a_glob_is_written_by_the_name_that_the_file_imports(
    imports: str, called: str, package: Path
) -> None:
    text = (package / SETUP).read_text().replace(" glob(", f" {called}(")
    (package / SETUP).write_text(text.replace("from glob import glob", imports))
    assert found(package) == []
    edit(package, (SETUP, f"{called}('config/*.yaml')", f"{called}('config/*.yml')"))
    (problem,) = found(package)
    assert problem.hint == f"write {called}('config/*.yaml')"


def test_setuptools_reads_the_programs_of_a_list_in_the_list(package: Path) -> None:
    programs = (
        "'drive = cart_description.drive:main',\n"
        "            'stop = cart_description.stop:main',\n"
    )
    edit(package, (SETUP, programs, f"({programs.rstrip()}),\n"))
    assert check(package / MODEL) == []


def test_the_file_that_names_the_package_is_missing(package: Path) -> None:
    marker = package / "resource" / "cart_description"
    other = marker.rename(package / "resource" / "cart")
    (problem,) = found(package)
    assert (problem.code, problem.line) == ("setup-file-missing", 11)
    assert problem.hint == "rename resource/cart to resource/cart_description"
    other.unlink()
    (problem,) = found(package)
    assert problem.hint == "make an empty file resource/cart_description"


def test_the_slash_before_the_name_of_the_package_is_added(package: Path) -> None:
    right = "('share/' + package_name, ['package.xml'])"
    assert right in TEXT
    edit(package, (SETUP, right, right.replace("share/", "share")))
    (problem,) = found(package)
    assert (problem.code, problem.hint) == ("setup-file-missing", "write 'share/'")
    assert edited_files(problem.edits)[str(package / SETUP)].decode() == TEXT


def test_a_folder_among_the_files_stops_the_build(package: Path) -> None:
    (package / "urdf" / "parts").mkdir()
    (package / "urdf" / "parts" / "wheel.xacro").touch()
    (problem,) = found(package)
    assert (problem.code, problem.line) == ("setup-file-missing", 14)
    assert "urdf/parts, which is a folder: colcon build stops" in problem.message
    assert problem.hint == "write glob('urdf/*.xacro')"


def test_a_program_that_the_package_does_not_have_is_not_started(
    package: Path,
) -> None:
    launch = "launch/display.launch.py"
    added = 'Node(package="cart_description", executable="drvie"),\n            rviz,'
    edit(package, (launch, "            rviz,", f"            {added}"))
    (problem,) = found(package)
    assert problem.code == "launch-program-unknown"
    assert "it has drive (setup.py line 21)" in problem.message
    assert problem.hint == "write drive"
    edit(package, (launch, "drvie", "drive_on"))
    (problem,) = found(package)
    assert problem.hint == (
        "add a line drive_on = … to console_scripts in setup.py, or write drive"
    )
    assert problem.edits == ()
    edit(package, (launch, "drive_on", "drvie"))
    edit(package, (launch, "drvie", "drive"))
    assert found(package) == []


@pytest.mark.parametrize(
    "change",
    [
        (
            CONFIG,
            "*[(f'share/{package_name}/{d}', glob(f'{d}/*')) for d in ['config']],",
        ),
        (CONFIG, "*others(),"),
        ("    ],\n    entry", "    ] + others('config'),\n    entry"),
        (
            CONFIG,
            "(os.path.join('share', package_name, folder), glob('config/*.yaml')),",
        ),
        (CONFIG, "('share/' + package_name + '/config', files('config')),"),
        ("glob('config/*.yaml')", "glob('**/*.yaml', recursive=True)"),
        ("glob('config/*.yaml')", "sorted(glob('config/*.yml') + glob('config/*.y*'))"),
        ("glob('config/*.yaml')", "[os.path.join('config', f) for f in names]"),
        ("glob('launch/", "glob('./launch/"),
        ("cart_description.stop:", "other_package.go:"),
        ("package_name = ", "other = "),
    ],
)
def test_what_is_not_understood_is_not_judged(
    package: Path, change: tuple[str, str]
) -> None:
    old, new = change
    edit(package, (SETUP, old, new))
    head = "from other import files, folder, names, others, package_name\n"
    edit(package, (SETUP, "import os\n", f"import os\n{head}"))
    assert found(package) == []


def test_lists_that_grow_from_line_to_line_are_understood(package: Path) -> None:
    start = TEXT.index("    data_files=[")
    end = TEXT.index("    entry_points")
    entries = TEXT[start + len("    data_files=[") : end].rstrip().removesuffix("],")
    first = f"entries = [{entries}]\n"
    more = "entries.append(('share/' + package_name + '/maps', glob('maps/*')))\n"
    more += "entries += [('share/' + package_name + '/other', ['other.txt'])]\n\nsetup("
    text = f"{TEXT[:start]}    data_files=entries,\n{TEXT[end:]}"
    (package / SETUP).write_text(text.replace("\nsetup(", f"\n{first}{more}"))
    (problem,) = found(package)
    assert problem.code == "setup-file-missing"
    assert "other.txt" in problem.message
    (package / "other.txt").touch()
    assert found(package) == []


def test_folders_with_a_slash_are_one_finding(copied: Callable[[str], Path]) -> None:
    package = copied("gz")
    cmake = "CMakeLists.txt"
    edit(package, (cmake, "urdf launch rviz config", "urdf/ launch/ rviz config/"))
    (problem,) = found(package)
    assert (problem.code, problem.line) == ("install-destination", 7)
    assert "urdf/ and config/ end with a slash" in problem.message
    assert problem.hint == "write urdf config without the slashes"
    edit(package, (cmake, "urdf/ launch/ rviz config/", "urdf launch/ rviz config"))
    assert found(package) == []


@pytest.mark.parametrize(
    ("wrong", "right", "hint"),
    [
        ("'drive : cart_description.drive:main'", "", "write drive = cart_description"),
        ("package_name, 'luanch')", "package_name, 'launch')", "write launch"),
    ],
)
def test_what_a_letter_makes_of_setup_py_is_mended(
    wrong: str, right: str, hint: str, package: Path
) -> None:
    right = right or wrong.replace(" : ", " = ")
    edit(package, (SETUP, right, wrong))
    (problem,) = found(package)
    assert problem.hint.startswith(hint)
    text = (package / SETUP).read_text()
    assert apply_edits(problem.edits, text) == TEXT


@pytest.mark.parametrize("wrong", ["[]", "['cart']"])
def test_a_package_that_packages_lacks_is_written_into_the_list(
    wrong: str, package: Path
) -> None:
    right = "['cart_description']"
    edit(package, (SETUP, "find_packages(exclude=['test'])", wrong))
    text = (package / SETUP).read_text()
    (problem,) = found(package)
    assert apply_edits(problem.edits, text) == text.replace(wrong, right)


def test_a_folder_that_find_packages_does_not_find_is_not_installed(
    package: Path,
) -> None:
    (package / "cart_description/__init__.py").unlink()
    (problem,) = found(package)
    assert problem.code == "entry-point-missing"
    assert problem.hint == "make an empty file cart_description/__init__.py"
    edit(package, (SETUP, "find_packages(exclude=['test'])", "[package_name]"))
    assert found(package) == []


def test_without_setup_cfg_ros2_run_finds_no_program(package: Path) -> None:
    (package / "setup.cfg").unlink()
    (problem,) = found(package)
    assert (problem.code, problem.severity) == ("setup-cfg-folder", "error")
    assert "install_scripts=$base/lib/cart_description" in problem.hint


@pytest.mark.parametrize(
    ("right", "wrong", "cause"),
    [
        (
            "find_packages(exclude=['test'])",
            "find_packages('src', exclude=['test'])",
            "looks in src, but cart_description is beside setup.py",
        ),
        (
            "find_packages(exclude=['test'])",
            "find_packages(where='src', exclude=['test'])",
            "looks in src, but cart_description is beside setup.py",
        ),
        (
            "['test']",
            "['test', 'cart*']",
            "find_packages() leaves out cart_description",
        ),
        (
            "exclude=['test']",
            "include=['cart']",
            "find_packages() includes only cart: cart_description is not installed",
        ),
        (
            "resource_index/packages'",
            "resource_index/package'",
            "but ROS finds the package by share/ament_index/resource_index/packages",
        ),
    ],
)
def test_what_is_searched_or_installed_elsewhere(
    package: Path, right: str, wrong: str, cause: str
) -> None:
    edit(package, (SETUP, right, wrong))
    (problem,) = check(package / MODEL)
    assert cause in problem.message
    if problem.edits:
        text = (package / SETUP).read_text()
        assert apply_edits(problem.edits, text) == TEXT
