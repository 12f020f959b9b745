"""What stops colcon in package.xml and CMakeLists.txt is found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
MANIFEST = "package.xml"
CMAKE = "CMakeLists.txt"
FIND = "find_package(ament_cmake REQUIRED)\n"

Copied = Callable[[str], Path]
LICENSE = "<license>BSD-3-Clause</license>"


@pytest.mark.parametrize(
    ("code", "file", "right", "wrong", "line", "cause", "hint", "better"),
    [
        (
            "package-xml",
            MANIFEST,
            LICENSE,
            "<license>BSD-3-Clause<license>",
            7,
            "<license> is opened twice",
            f"write {LICENSE}",
            LICENSE,
        ),
        (
            "package-xml",
            MANIFEST,
            LICENSE,
            "<license>BSD-3-Clause</licence>",
            7,
            "<license> is closed by </licence>",
            f"write {LICENSE}",
            LICENSE,
        ),
        (
            "package-xml",
            MANIFEST,
            LICENSE,
            "<license>BSD-3-Clause",
            7,
            "<license> is not closed",
            f"write {LICENSE}",
            LICENSE,
        ),
        (
            "package-xml",
            MANIFEST,
            LICENSE,
            "<license>BSD-3-Clause</license",
            7,
            "</license has no >",
            "write </license>",
            LICENSE,
        ),
        (
            "package-xml",
            MANIFEST,
            "wheels for",
            "wheels & more for",
            5,
            "a bare & is not allowed",
            "write &amp;",
            "wheels &amp; more for",
        ),
        (
            "package-xml",
            MANIFEST,
            "</package>",
            "",
            11,
            "<package> is not closed",
            "add </package> at the end of the file",
            "</package>",
        ),
        (
            "package-xml",
            MANIFEST,
            "<name>cart_description</name>",
            "<name>Cart Description</name>",
            3,
            '"Cart Description" is not a name of a package',
            "write <name>cart_description</name>",
            "<name>cart_description</name>",
        ),
        (
            "package-xml",
            MANIFEST,
            "  <name>cart_description</name>\n",
            "",
            2,
            "there is no <name>",
            "write <name>cart_description</name>",
            "  <name>cart_description</name>\n",
        ),
        (
            "package-build-type",
            MANIFEST,
            "<build_type>ament_cmake",
            "<build_type>ament_python",
            10,
            "it has CMakeLists.txt",
            "write ament_cmake",
            "<build_type>ament_cmake",
        ),
        (
            "cmake-command-missing",
            CMAKE,
            "ament_package()",
            "",
            6,
            "ament_package() is missing",
            "add ament_package() at the end of the file",
            "ament_package()",
        ),
        (
            "cmake-command-missing",
            CMAKE,
            FIND,
            "",
            10,
            "CMake does not know ament_package()",
            "add find_package(ament_cmake REQUIRED) after project( … )",
            FIND,
        ),
        (
            "install-folder-as-file",
            CMAKE,
            "DIRECTORY",
            "FILES",
            7,
            "is given the folders urdf, launch, rviz, config and world",
            "write DIRECTORY for FILES",
            "DIRECTORY",
        ),
        (
            "package-xml",
            MANIFEST,
            "  <export>\n",
            "  <run_depend>xacro</run_depend>\n  <export>\n",
            9,
            "format 3 has no <run_depend>",
            "write <exec_depend>",
            "  <exec_depend>xacro</exec_depend>\n  <export>\n",
        ),
        (
            "package-xml",
            MANIFEST,
            "<version>0.0.1</version>",
            "<version>1.2</version>",
            4,
            "the version 1.2 is not three numbers",
            "write <version>1.2.0</version>",
            "<version>1.2.0</version>",
        ),
        (
            "package-xml",
            MANIFEST,
            '<maintainer email="cart@example.org">',
            "<maintainer>",
            6,
            "no <maintainer> has an email",
            'write <maintainer email="me@example.org">',
            '<maintainer email="me@example.org">',
        ),
        (
            "package-dependency",
            MANIFEST,
            "  <export>\n",
            "  <exec_depend>rviz</exec_depend>\n  <export>\n",
            9,
            "rviz is a package of ROS 1",
            "write rviz2",
            "  <exec_depend>rviz2</exec_depend>\n  <export>\n",
        ),
        (
            "package-dependency",
            CMAKE,
            "find_package(ament_cmake REQUIRED)\n",
            "find_package(ament_cmkae REQUIRED)\nfind_package(xacro)\n",
            4,
            "CMake is to find ament_cmkae, but package.xml depends on ament_cmake",
            "write ament_cmake",
            "find_package(ament_cmake REQUIRED)\n",
        ),
    ],
)
def test_what_stops_colcon(
    copied: Copied,
    code: str,
    file: str,
    right: str,
    wrong: str,
    line: int,
    cause: str,
    hint: str,
    better: str,
) -> None:
    package = copied("gz")
    text = (package / file).read_text()
    assert right in text
    (package / file).write_text(text.replace(right, wrong, 1))

    (problem,) = check(package / MODEL)

    severity = "warning" if code == "package-dependency" else "error"
    assert (problem.code, problem.severity) == (code, severity)
    assert (problem.file, problem.line) == (str(package / file), line)
    assert cause in problem.message
    assert problem.hint == hint
    (package / file).write_text(text.replace(right, better, 1))
    assert check(package / MODEL) == []


def test_an_empty_package_xml(copied: Copied) -> None:
    package = copied("gz")
    (package / MANIFEST).write_text("")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.line) == ("package-xml", 1)
    (package / MANIFEST).write_text(problem.hint.removeprefix("write "))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("file", "right", "other"),
    [
        (CMAKE, FIND, "find_package(ament_cmake_auto REQUIRED)\n"),
        (CMAKE, "ament_package()", "include(cmake/package.cmake)"),
        (
            CMAKE,
            "DIRECTORY",
            "FILES CMakeLists.txt DESTINATION share)\ninstall(DIRECTORY",
        ),
        (MANIFEST, "ament_cmake</build_type>", "cmake</build_type>"),
        (MANIFEST, "<name>cart", "<!-- <name>Cart Robot</name> --><name>cart"),
    ],
)
def test_what_colcon_reads_is_not_reported(
    copied: Copied, file: str, right: str, other: str
) -> None:
    package = copied("gz")
    text = (package / file).read_text()
    assert right in text
    (package / file).write_text(text.replace(right, other, 1))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "line",
    [
        "<version>0.0.1</version>",
        '<maintainer email="cart@example.org">cart</maintainer>',
        LICENSE,
    ],
)
def test_what_each_manifest_needs_is_told(copied: Copied, line: str) -> None:
    package = copied("gz")
    manifest = package / MANIFEST
    text = manifest.read_text()
    assert line in text
    manifest.write_text(text.replace(line, ""))
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.line) == ("package-xml", 2)
    added = problem.hint.removeprefix("add ")
    manifest.write_text(text.replace(line, added))
    assert check(package / MODEL) == []


def test_a_build_type_is_that_of_the_tool_that_the_package_needs(
    copied: Copied,
) -> None:
    folder = copied("gz")
    manifest = folder / MANIFEST
    text = manifest.read_text()
    manifest.write_text(text.replace("<build_type>ament_cmake</build_type>", ""))
    (folder / CMAKE).unlink()
    (found,) = (p for p in check(folder / MODEL) if p.code == "package-build-type")
    assert "<build_type>ament_cmake</build_type>" in found.hint


def test_a_misspelt_dependency_on_a_package_that_is_used(copied: Copied) -> None:
    package = copied("gz")
    manifest = package / MANIFEST
    text = manifest.read_text()

    def depend_on(*names: str) -> list[str]:
        lines = "".join(f"<exec_depend>{name}</exec_depend>" for name in names)
        manifest.write_text(text.replace("  <export>", f"{lines}\n  <export>"))
        return [problem.hint for problem in check(package / MODEL)]

    assert depend_on("xcaro", "rviz2") == ["write xacro"]
    assert depend_on("robot_localisation") == ["write robot_localization"]
    assert depend_on("xacro", "xcaro", "rviz_common", "cart_bringup") == []
    real = "joint_state_publisher", "robot_state_publisher_gui", "xacro_msgs"
    assert depend_on(*real) == []
