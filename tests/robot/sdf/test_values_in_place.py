"""Values that SDF does not read where they are, or that are missing, are told.

What the finding says to write is written into the file literally; nothing is left.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import check, load_robot
from sambot_viz.errors import Problem
from sambot_viz.robot.parts import Box

MODEL = """<?xml version="1.0"?>
<sdf version="1.8">
  <model name="bot">
    <link name="base">
      <inertial><mass>1.5</mass>
        <inertia><ixx>0.01</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.02</iyy><iyz>0</iyz><izz>0.02</izz></inertia>
      </inertial>
      <visual name="v">
        <geometry>
          <box><size>0.4 0.3 0.2</size></box>
        </geometry>
        <material><ambient>0 1 1 1</ambient><diffuse>0 1 1 1</diffuse></material>
      </visual>
      <collision name="c">
        <geometry>
          <cylinder><radius>0.1</radius><length>0.04</length></cylinder>
        </geometry>
      </collision>
    </link>
    <link name="arm">
      <pose relative_to="arm_joint"/>
      <visual name="ball">
        <geometry><sphere><radius>0.05</radius></sphere></geometry>
      </visual>
    </link>
    <joint name="arm_joint" type="revolute">
      <parent>base</parent>
      <child>arm</child>
      <pose relative_to="base">0.15 0 0.1 0 0 0</pose>
      <axis>
        <xyz>0 1 0</xyz>
        <limit><lower>-1</lower><upper>1</upper></limit>
        <dynamics><damping>0.1</damping><friction>0.2</friction></dynamics>
      </axis>
    </joint>
  </model>
</sdf>
"""
SIZE = "<size>0.4 0.3 0.2</size>"
MOMENTS = (
    "<ixx>0.01</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.02</iyy><iyz>0</iyz><izz>0.02</izz>"
)
LIMIT = "<limit><lower>-1</lower><upper>1</upper></limit>"
COLOUR = "<material><ambient>0 1 1 1</ambient><diffuse>0 1 1 1</diffuse></material>"
AXIS = MODEL[MODEL.index("<axis>") : MODEL.index("</axis>") + len("</axis>")]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    return tmp_path / "bot.sdf"


def checked(model: Path, text: str) -> list[Problem]:
    model.write_text(text)
    return check(model)


def test_the_model_of_these_tests_is_good(model: Path) -> None:
    assert checked(model, MODEL) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        (f"<box>{SIZE}</box>", "<box>0.4 0.3 0.2</box>"),
        (f"<box>{SIZE}</box>", "<box>0.4, 0.3, 0.2</box>"),
        (f"<box>{SIZE}</box>", "<box>0,4 0,3 0,2</box>"),
        (f"<box>{SIZE}</box>", "<box>40cm 30cm 20cm</box>"),
        ("<sphere><radius>0.05</radius></sphere>", "<sphere>0.05</sphere>"),
        (
            "<cylinder><radius>0.1</radius><length>0.04</length></cylinder>",
            "<cylinder>0.1 0.04</cylinder>",
        ),
        (f"<inertia>{MOMENTS}</inertia>", "<inertia>0.01 0 0 0.02 0 0.02</inertia>"),
        (LIMIT, "<limit>-1 1</limit>"),
        (
            "<dynamics><damping>0.1</damping><friction>0.2</friction></dynamics>",
            "<dynamics>0.1 0.2</dynamics>",
        ),
        (COLOUR, "<material>cyan</material>"),
        (COLOUR, "<material>0 1 1</material>"),
        (
            f"<geometry>\n          <box>{SIZE}</box>\n        </geometry>",
            "<geometry>0.4 0.3 0.2</geometry>",
        ),
    ],
)
def test_text_is_put_into_the_element_it_belongs_to(
    model: Path, right: str, wrong: str
) -> None:
    text = MODEL.replace(right, wrong)

    (problem,) = checked(model, text)

    assert problem.line == text[: text.index(wrong)].count("\n") + 1
    tag = wrong[1 : wrong.index(">")]
    assert f"directly in <{tag}> of" in problem.message
    fixed = text.replace(wrong, problem.hint.removeprefix("write "))
    assert fixed.split() == MODEL.split() or "<geometry>" in wrong
    assert checked(model, fixed) == []


@pytest.mark.parametrize("written", ["0 1 0", "y"])
def test_the_text_of_an_axis_is_its_direction(model: Path, written: str) -> None:
    text = MODEL.replace("revolute", "continuous").replace(
        AXIS, f"<axis>{written}</axis>"
    )

    (problem,) = checked(model, text)

    assert problem.message.endswith("the axis becomes 0 0 1")
    assert problem.hint == "write <axis><xyz>0 1 0</xyz></axis>"


def test_a_mesh_is_not_looked_for_under_a_name_that_nobody_wrote(model: Path) -> None:
    mesh = "<mesh>package://bot/meshes/lidar.stl</mesh>"

    (problem,) = checked(model, MODEL.replace(f"<box>{SIZE}</box>", mesh))

    assert problem.code == "sdf-text-not-read"
    assert problem.hint == (
        "write <mesh><uri>package://bot/meshes/lidar.stl</uri></mesh>"
    )


@pytest.mark.parametrize(
    "before",
    [
        "<visual",
        "<axis>\n",
        "<size>",
        "<parent>",
        '<link name="arm">',
        "<model",
        "<lower>",
    ],
)
def test_text_that_means_nothing_is_told(model: Path, before: str) -> None:
    (problem,) = checked(model, MODEL.replace(before, f"oops{before}", 1))

    assert problem.code == "sdf-text-not-read"
    assert problem.message.startswith("the text oops directly in <")
    assert problem.hint.startswith("delete it")


def test_text_that_is_for_gazebo_is_no_problem(model: Path) -> None:
    plugin = '<plugin name="p" filename="f"><a>1</a>text</plugin>'
    sensor = '<sensor name="s" type="imu">text<imu>text</imu></sensor>'
    text = MODEL.replace("</link>", f"{sensor}</link>", 1)

    found = checked(model, text.replace("  </model>", f"{plugin}</model>"))

    assert {problem.code for problem in found} == {"sdf-gazebo-only"}


@pytest.mark.parametrize(
    ("there", "tag", "says"),
    [
        (SIZE, "box", "1 1 1, a cube of one metre"),
        ("<radius>0.1</radius>", "cylinder", "1 metre"),
        ("<length>0.04</length>", "cylinder", "1 metre"),
        ("<radius>0.1</radius><length>0.04</length>", "cylinder", "1 metre"),
        ("<radius>0.05</radius>", "sphere", "1 metre"),
        ("<xyz>0 1 0</xyz>", "axis", "0 0 1"),
        ("<ixx>0.01</ixx>", "inertia", "1"),
    ],
)
def test_a_value_that_is_missing_is_told_with_what_sdf_takes(
    model: Path, there: str, tag: str, says: str
) -> None:
    text = MODEL.replace(there, "")

    problem = checked(model, text)[-1]

    assert problem.code == "sdf-value-missing"
    assert problem.message.startswith(f"<{tag}> of ")
    assert problem.message.endswith(f": SDF takes {says}")
    fix = problem.hint.removeprefix("write ").partition(" into it, ")[0]
    left = checked(model, MODEL.replace(there, fix))
    # A moment of 1 is as impossible as the default; it is not guessed.
    assert [p.code for p in left] == (["sdf-inertia"] if tag == "inertia" else [])


@pytest.mark.parametrize(
    ("name", "axis"), [("wheel_joint", "0 1 0"), ("wheel_caster_joint", "0 0 1")]
)
def test_the_axis_of_a_wheel_is_not_upright(model: Path, name: str, axis: str) -> None:
    text = MODEL.replace("arm_joint", name).replace("<xyz>0 1 0</xyz>", "")

    hints = [p.hint for p in checked(model, text) if p.code == "sdf-value-missing"]

    assert hints == [f"write <xyz>{axis}</xyz> into it, or another direction"]


def test_the_default_that_is_told_is_the_one_that_is_drawn(model: Path) -> None:
    model.write_text(MODEL.replace(SIZE, ""))

    (visual,) = load_robot(model).links["base"].visuals

    assert visual.geometry == Box((1.0, 1.0, 1.0))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("<length>0.04</length>", "<height>0.04</height>"),
        ("<radius>0.1</radius>", "<diameter>0.2</diameter>"),
        ("<radius>0.05</radius>", "<diameter>0.1</diameter>"),
    ],
)
def test_height_and_diameter_are_told_by_their_names_in_sdf(
    model: Path, right: str, wrong: str
) -> None:
    text = MODEL.replace(right, wrong)

    (problem,) = checked(model, text)

    assert text.replace(wrong, problem.hint.removeprefix("write ")) == MODEL


def test_a_mesh_without_a_name_is_one_problem(model: Path) -> None:
    (problem,) = checked(model, MODEL.replace(f"<box>{SIZE}</box>", "<mesh/>"))

    assert problem.message.endswith("lacks <uri>: there is no file to draw")
