"""Files that are not found are reported, each once and with its cause."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Problem
from sambot_viz.robot.model import load_robot

CUBE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def problems_with(folder: Path, *meshes: str) -> tuple[Problem, ...]:
    """What is reported of a robot with these meshes, one on each line from line 2."""
    shapes = "\n".join(
        f'<visual><geometry><mesh filename="{mesh}"/></geometry></visual>'
        for mesh in meshes
    )
    file = folder / "urdf" / "r.urdf"
    file.parent.mkdir(exist_ok=True)
    file.write_text(f'<robot name="r"><link name="a">\n{shapes}\n</link></robot>')
    return load_robot(file).problems


def test_each_mesh_of_a_missing_package_is_reported_once_with_its_line(
    tmp_path: Path,
) -> None:
    meshes = [f"package://arm/meshes/{n}.stl" for n in range(52)]

    found = problems_with(tmp_path, *meshes, meshes[0])

    assert [problem.line for problem in found] == list(range(2, 54))
    assert {(p.code, p.cause, p.hint) for p in found} == {
        ("mesh-not-found", "package arm", "add --package-path FOLDER-THAT-HOLDS-arm")
    }
    assert found[0].message.startswith(
        "the mesh package://arm/meshes/0.stl was not found: the package arm is not "
        "known (searched: "
    )


def test_files_of_one_folder_have_one_cause(tmp_path: Path) -> None:
    found = problems_with(
        tmp_path, "package://arm/a.stl", "b.stl", "c.stl", "../meshes/d.stl"
    )

    assert [problem.cause for problem in found] == [
        "package arm",
        "the model's folder",
        "the model's folder",
        "folder ../meshes",
    ]
    assert all(p.message.endswith("; a placeholder is drawn") for p in found)


def test_files_found_by_the_end_of_their_path_have_one_cause(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    for name in "ab":
        (tmp_path / "meshes" / f"{name}.obj").write_text(CUBE)

    found = problems_with(
        tmp_path, "package://arm/meshes/a.obj", "package://arm/meshes/b.obj"
    )

    assert {(p.code, p.cause) for p in found} == {("file-by-path-only", "package arm")}
    assert len(found) == 2


def test_three_slashes_are_explained_and_the_file_is_found(tmp_path: Path) -> None:
    folder = tmp_path / "robot"
    (folder / "meshes").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>arm</name></package>")
    (folder / "meshes" / "a.obj").write_text(CUBE)

    found = problems_with(
        folder, "package:///meshes/a.obj", "package:///arm/meshes/a.obj"
    )
    robot = load_robot(folder / "urdf" / "r.urdf")

    assert {problem.code for problem in found} == {"package-three-slashes"}
    assert "has three slashes" in found[0].message
    assert str(folder / "meshes" / "a.obj") in found[0].message
    paths = [getattr(s.geometry, "path", None) for s in robot.links["a"].visuals]
    assert paths == [folder / "meshes" / "a.obj"] * 2


def test_three_slashes_without_a_file_are_explained_too(tmp_path: Path) -> None:
    (problem,) = problems_with(tmp_path, "package:///meshes/a.obj")

    assert problem.code == "package-three-slashes"
    assert "no file was used" in problem.message


FORMS = [
    (r"package:\\arm\m\a.obj", r"it has \ in place of /"),
    (r"package://arm\m\a.obj", r"it has \ in place of /"),
    (r"package://arm/m\a.obj", r"it has \ in place of /"),
    (r"..\m\a.obj", r"it has \ in place of /"),
    (r"file:///C:\ws\arm\m\a.obj", r"it has \ in place of /"),
    (r"%USERPROFILE%\arm\m\a.obj", "only a shell"),
    ("~/ws/arm/m/a.obj", "only a shell"),
    ("file://~/ws/arm/m/a.obj", "only a shell"),
    ("$HOME/ws/arm/m/a.obj", "only a shell"),
    ("package:/arm/m/a.obj", "a colon and two slashes"),
    ("package:arm/m/a.obj", "a colon and two slashes"),
    ("package//arm/m/a.obj", "a colon and two slashes"),
    ("Package://arm/m/a.obj", "in small letters"),
    ("pkg://arm/m/a.obj", "ROS knows package://"),
    ("package://arm/m/a.obj ", "a blank"),
    ("&#10; package://arm/m/a.obj", "a blank"),
    ("'package://arm/m/a.obj'", "quotation marks"),
    ("file://../m/a.obj", "a relative path"),
    ("file:../m/a.obj", "a relative path"),
]


def arm(tmp_path: Path) -> Path:
    """Write a package with one mesh, whose model is not the file of a user's home."""
    folder = tmp_path / "elsewhere"
    (folder / "m").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>arm</name></package>")
    (folder / "m" / "a.obj").write_text(CUBE)
    return folder


@pytest.mark.parametrize(("name", "cause"), FORMS, ids=[name for name, _ in FORMS])
def test_a_form_of_names_that_ros_does_not_read_is_explained_and_the_file_is_drawn(
    tmp_path: Path, name: str, cause: str
) -> None:
    folder = arm(tmp_path)

    (found,) = problems_with(folder, name)
    (shape,) = load_robot(folder / "urdf" / "r.urdf").links["a"].visuals

    assert found.code == "file-name-form"
    assert cause in found.message
    assert getattr(shape.geometry, "path", Path()).samefile(folder / "m" / "a.obj")


@pytest.mark.parametrize("name", [name for name, _ in FORMS])
def test_the_form_is_named_also_where_there_is_no_file(
    tmp_path: Path, name: str
) -> None:
    (found,) = problems_with(tmp_path, name)

    assert found.code == "mesh-not-found"
    assert dict(FORMS)[name] in found.message
    assert found.hint.startswith(("write ", "delete "))


@pytest.mark.parametrize(
    "name",
    [
        "package://arm/m/a.obj",
        "package://arm//m/a.obj",
        "../m/a.obj",
        "{folder}/m/a.obj",
        "file://{folder}/m/a.obj",
        "file:{folder}/m/a.obj",
        "file://localhost{folder}/m/a.obj",
    ],
)
def test_forms_that_are_right_are_read_and_nothing_is_said(
    tmp_path: Path, name: str
) -> None:
    folder = arm(tmp_path)

    assert problems_with(folder, name.format(folder=folder)) == ()
    (shape,) = load_robot(folder / "urdf" / "r.urdf").links["a"].visuals
    assert getattr(shape.geometry, "path", None) is not None


@pytest.mark.parametrize("path", [r"C:\my ws", "C:/my ws", r"\\server\ws", "/home/kim"])
def test_a_path_of_another_machine_is_no_form_that_is_wrong(
    tmp_path: Path, path: str
) -> None:
    (found,) = problems_with(arm(tmp_path), f"{path}/arm/m/a.obj")

    assert found.code == "file-other-machine"


def test_what_follows_a_form_that_is_wrong_is_written_out_where_it_is_known(
    tmp_path: Path,
) -> None:
    (problem,) = problems_with(tmp_path, r"package://arm\meshes\a.stl")

    assert problem.hint == "write package://arm/meshes/a.stl"


def test_a_package_without_a_name_is_said_to_be_none(tmp_path: Path) -> None:
    (problem,) = problems_with(tmp_path, "package://")

    assert "it names no package" in problem.message
    assert problem.hint == "write package://PACKAGE/…"


def test_the_package_that_was_meant_is_named(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()  # the search for packages ends here
    (tmp_path / "package.xml").write_text("<package><name>my_robot</name></package>")
    (tmp_path / "meshes").mkdir()
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    stl = bytes(80) + struct.pack("<I", 1) + facet
    (tmp_path / "meshes/arm.stl").write_bytes(stl)
    model = tmp_path / "r.urdf"

    def hints(name: str) -> list[str]:
        mesh = f'<mesh filename="package://{name}"/>'
        visual = f"<visual><geometry>{mesh}</geometry></visual>"
        model.write_text(f'<robot name="r"><link name="a">{visual}</link></robot>')
        return [problem.hint for problem in check(model)]

    right = "my_robot/meshes/arm.stl"
    assert hints("my_robt/meshes/arm.stl") == [f"write package://{right}"]
    assert hints("my_robt/other.stl") == ["write package://my_robot/other.stl"]
    assert hints(right) == []
