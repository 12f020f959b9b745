"""The obvious model of a package folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.bundled import find
from sambot_viz.errors import UsageError

XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
LINKS = XACRO.format('<link name="base_link"/>')
MACRO = XACRO.format(
    '<xacro:macro name="arm" params="p"><link name="${p}base"/></xacro:macro>'
)
CALLS = XACRO.format('<xacro:include filename="r_macro.xacro"/><xacro:arm p="x"/>')


def package(tmp_path: Path, **files: str) -> Path:
    """A package my_bot with these files; "__" in a name is a folder."""
    folder = tmp_path / "my_bot"
    contents = {"package.xml": "<package><name>my_bot</name></package>", **files}
    for name, text in contents.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def model_in(folder: Path) -> str:
    return find(folder).model.relative_to(folder).as_posix()


@pytest.mark.parametrize(
    "place", ["urdf", "description/urdf", "urdf/arms", "robots", "xacro", "models", "."]
)
def test_a_model_is_found_wherever_packages_have_it(tmp_path: Path, place: str) -> None:
    folder = package(tmp_path, **{f"{place}/r.urdf.xacro": LINKS})
    assert model_in(folder).endswith("r.urdf.xacro")


SDF = '<sdf version="1.8"><model name="r"><link name="base_link"/></model></sdf>'
WORLD = SDF.replace("<model", '<world name="w"><model').replace(
    "l></s", "l></world></s"
)
LAUNCH = "path = os.path.join(share, 'src', 'description', '{}')"


@pytest.mark.parametrize("name", ["r.sdf", "r.sdf.xacro"])
def test_an_sdf_file_is_a_model_and_a_world_is_none(tmp_path: Path, name: str) -> None:
    files = {f"src/description/{name}": SDF, "world/r_world.sdf": WORLD}
    assert model_in(package(tmp_path, **files)) == f"src/description/{name}"


def test_a_file_in_a_folder_of_worlds_is_no_robot(tmp_path: Path) -> None:
    folder = package(tmp_path, **{"worlds/contest/task.sdf": WORLD})
    with pytest.raises(UsageError, match="no model in the folder"):
        find(folder)


@pytest.mark.parametrize("name", ["my_bot.sdf", "my_bot.urdf"])
def test_of_urdf_and_sdf_the_one_of_the_launch_file_is_the_model(
    tmp_path: Path, name: str
) -> None:
    files = {
        "src/description/my_bot.sdf": SDF,
        "src/description/my_bot.urdf": LINKS,
        "launch/display.launch.py": LAUNCH.format(name),
    }
    assert model_in(package(tmp_path, **files)) == f"src/description/{name}"


def test_a_config_in_the_rviz_folder_opens_with_the_sdf_file(tmp_path: Path) -> None:
    files = {"src/description/my_bot.sdf": SDF, "rviz/config.rviz": "Panels: []"}
    folder = package(tmp_path, **files)
    assert find(folder).config == folder / "rviz" / "config.rviz"


def test_an_sdf_file_that_is_misspelt_on_the_command_line_is_offered(
    tmp_path: Path,
) -> None:
    folder = package(tmp_path, **{"my_bot.sdf": SDF})
    with pytest.raises(UsageError, match=r"did you mean 'my_bot.sdf'\?"):
        find(folder / "my_bto.sdf")


NESTED = XACRO.format(
    '<xacro:macro name="arm" params="p"><xacro:include filename="r.xacro"/>'
    '<xacro:macro name="part"><link name="a"/></xacro:macro>'
    '<link name="b"/></xacro:macro>'
)


@pytest.mark.parametrize("macros", [MACRO, NESTED])
def test_a_file_with_only_macros_is_not_the_model(tmp_path: Path, macros: str) -> None:
    files = {"urdf/common.urdf.xacro": macros, "robots/r.urdf.xacro": LINKS}
    assert model_in(package(tmp_path, **files)) == "robots/r.urdf.xacro"


def test_a_file_that_calls_an_included_macro_is_the_model(tmp_path: Path) -> None:
    files = {"urdf/r.xacro": CALLS, "urdf/r_macro.xacro": MACRO}
    assert model_in(package(tmp_path, **files)) == "urdf/r.xacro"


def test_an_included_file_with_links_is_not_the_model(tmp_path: Path) -> None:
    top = XACRO.format('<xacro:include filename="$(find my_bot)/urdf/core.xacro"/>')
    files = {"urdf/core.xacro": LINKS, "urdf/top.xacro": top}
    assert model_in(package(tmp_path, **files)) == "urdf/top.xacro"


def test_links_in_a_comment_do_not_count(tmp_path: Path) -> None:
    files = {"urdf/a.urdf": f"<!-- {LINKS} --><robot/>", "urdf/b.urdf": LINKS}
    assert model_in(package(tmp_path, **files)) == "urdf/b.urdf"


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["my_bot.urdf", "other.urdf"], "my_bot.urdf"),
        (["robot.urdf", "other.urdf"], "robot.urdf"),
        (["arm.xacro", "arm_gazebo.xacro", "arm_sim.xacro"], "arm.xacro"),
        (["x.urdf", "x.urdf.xacro"], "x.urdf.xacro"),
        (["x.urdf", "y.urdf.xacro"], "y.urdf.xacro"),
    ],
)
def test_the_obvious_one_of_several_models_is_chosen(
    tmp_path: Path, names: list[str], expected: str
) -> None:
    folder = package(tmp_path, **{f"urdf/{name}": LINKS for name in names})
    assert model_in(folder) == f"urdf/{expected}"


def test_the_model_that_a_launch_file_names_is_chosen(tmp_path: Path) -> None:
    files = {"urdf/a.urdf": LINKS, "urdf/b.urdf": LINKS, "launch/x.launch.py": "b.urdf"}
    assert model_in(package(tmp_path, **files)) == "urdf/b.urdf"


def test_a_model_with_a_mistake_in_it_is_found_too(tmp_path: Path) -> None:
    folder = package(tmp_path, **{"urdf/r.urdf": LINKS.replace("</robot>", "")})
    assert model_in(folder) == "urdf/r.urdf"


def test_models_for_tests_count_only_when_there_are_no_others(tmp_path: Path) -> None:
    folder = package(tmp_path, **{"test/rig.urdf": LINKS})
    assert model_in(folder) == "test/rig.urdf"
    (folder / "arm.urdf").write_text(LINKS)
    assert model_in(folder) == "arm.urdf"


def test_other_packages_inside_the_folder_are_left_out(tmp_path: Path) -> None:
    files = {
        "urdf/a.urdf": LINKS,
        "sub__package.xml": "<package/>",
        "sub/b.urdf": LINKS,
    }
    assert model_in(package(tmp_path, **files)) == "urdf/a.urdf"


def test_several_models_without_an_obvious_one_are_listed(tmp_path: Path) -> None:
    folder = package(tmp_path, **{f"urdf/{n}.urdf": LINKS for n in "ab"})
    with pytest.raises(UsageError, match=r"\(urdf/a\.urdf, urdf/b\.urdf\); give the"):
        find(folder)


def test_a_folder_without_a_model_says_what_was_looked_for(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no \*\.urdf\.xacro, \*\.urdf, \*\.xacro"):
        find(package(tmp_path, **{"urdf/common.xacro": MACRO}))
