from pathlib import Path

import pytest

from sambot_viz.robot.packages.package_index import PackageIndex, package_name
from sambot_viz.robot.packages.resolve import (
    FileResolver,
    inside_package,
    other_letter_case,
)


def make_package(folder: Path, name: str | None = None) -> Path:
    folder.mkdir(parents=True)
    text = f"<package><!-- <name>no</name> --><name>{name or folder.name}</name>"
    (folder / "package.xml").write_text(f"{text}</package>", "utf-8")
    return folder


def write(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("x", "utf-8")
    return path


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace with two packages; the model lies in robot_description/urdf."""
    source = tmp_path / "나의 작업" / "src"
    make_package(source / "arm-main", "arm_description")
    (make_package(source / "robot_description") / "urdf").mkdir()
    return source


def index(workspace: Path, **options: object) -> PackageIndex:
    folder = workspace / "robot_description" / "urdf"
    return PackageIndex(folder, environment={}, **options)  # type: ignore[arg-type]


def test_the_name_in_package_xml_counts_not_the_folder(workspace: Path):
    assert package_name(workspace / "arm-main") == "arm_description"
    assert index(workspace).find("arm_description").path == workspace / "arm-main"


def test_the_models_own_package_is_found_by_walking_up(workspace: Path):
    own = workspace / "robot_description"
    assert index(workspace).find("robot_description").path == own


def test_a_missing_package_is_reported_with_the_searched_and_known_ones(
    workspace: Path,
):
    lookup = index(workspace).find("gripper")

    assert lookup.path is None
    assert str(workspace) in lookup.searched
    assert {"arm_description", "robot_description"} <= set(lookup.known)


def test_a_folder_with_colcon_ignore_is_skipped(workspace: Path):
    write(workspace / "arm-main" / "COLCON_IGNORE")
    assert index(workspace).find("arm_description").path is None


def test_what_the_user_gives_comes_first(workspace: Path, tmp_path: Path):
    other = make_package(tmp_path / "elsewhere" / "arm", "arm_description")

    by_folder = index(workspace, package_path=[other.parent])
    by_name = index(workspace, package_path=[f"gripper={other}"])

    assert by_folder.find("arm_description").path == other
    assert by_name.find("gripper").path == other


def test_ros_path_variables_are_searched(tmp_path: Path):
    old = make_package(tmp_path / "ros1" / "stacks" / "old_description")
    new = tmp_path / "install" / "share" / "new_description"
    new.mkdir(parents=True)
    found = PackageIndex(
        None,
        environment={
            "ROS_PACKAGE_PATH": str(tmp_path / "ros1"),
            "AMENT_PREFIX_PATH": str(tmp_path / "install"),
        },
    )

    assert found.find("old_description").path == old
    assert found.find("new_description").path == new


def test_a_folder_named_like_the_package_is_the_last_choice(tmp_path: Path):
    folder = tmp_path / "share" / "wheel_description" / "urdf"
    folder.mkdir(parents=True)
    packages = PackageIndex(folder, environment={})
    assert packages.find("wheel_description").path == folder.parent


def test_mesh_names_of_every_kind_are_resolved(workspace: Path):
    mesh = write(workspace / "arm-main" / "meshes" / "아래 팔.stl")
    near = write(workspace / "robot_description" / "urdf" / "near.stl")
    files = FileResolver(index(workspace), near.parent)

    for name in (
        "package://arm_description/meshes/아래 팔.stl",
        "model://arm_description/meshes/아래 팔.stl",
        "../../arm-main/meshes/아래 팔.stl",
        str(mesh),
        f"file://{mesh}",
        f"file://{mesh}".replace(" ", "%20"),
    ):
        found = files.resolve(name)
        assert found.path is not None, name
        assert found.path.resolve() == mesh
        assert found.doubt == ("model-scheme" if name.startswith("model:") else None)
    assert files.resolve("near.stl").path == near


def test_doubtful_results_are_marked(workspace: Path):
    mesh = write(workspace / "arm-main" / "description" / "meshes" / "Arm.stl")
    files = FileResolver(index(workspace), workspace / "robot_description" / "urdf")
    package = "package://arm_description"

    cased = files.resolve(f"{package}/description/meshes/arm.STL")
    moved = files.resolve(f"{package}/meshes/Arm.stl")
    foreign = files.resolve(
        "file:///home/kim/ws/install/share/arm_description/description/meshes/Arm.stl"
    )

    assert (cased.path, cased.doubt) == (mesh, "letter-case")
    assert (moved.path, moved.doubt) == (mesh, "other-layout")
    assert (foreign.path, foreign.doubt) == (mesh, "other-machine")


def test_the_tail_of_a_path_is_the_last_resort(workspace: Path):
    mesh = write(workspace / "robot_description" / "meshes" / "base.stl")
    files = FileResolver(index(workspace), workspace / "robot_description" / "urdf")

    found = files.resolve("package://unknown/meshes/base.stl")

    assert (found.path, found.doubt) == (mesh, "path-only")
    assert found.missing_package == "unknown"


def test_the_package_name_counts_before_the_tail(workspace: Path):
    write(workspace / "robot_description" / "meshes" / "same.stl")
    right = write(workspace / "arm-main" / "meshes" / "same.stl")
    files = FileResolver(index(workspace), workspace / "robot_description" / "urdf")
    assert files.resolve("package://arm_description/meshes/same.stl").path == right


def test_web_addresses_are_never_fetched(workspace: Path):
    files = FileResolver(index(workspace), workspace)
    found = files.resolve("http://localhost/base.stl")
    assert found.path is None
    assert found.searched == ("http addresses are not fetched",)


def test_a_file_being_included_is_not_an_answer(tmp_path: Path):
    own = write(tmp_path / "description" / "ros2_control" / "x.xacro")
    relative = Path("ros2_control/x.xacro")
    assert inside_package(tmp_path, relative, ()) == own
    assert inside_package(tmp_path, relative, {str(own)}) is None


def test_two_files_that_differ_only_in_case_are_not_an_answer(tmp_path: Path):
    write(tmp_path / "arm.stl")
    write(tmp_path / "ARM.stl")
    assert other_letter_case(tmp_path / "Arm.stl") is None
