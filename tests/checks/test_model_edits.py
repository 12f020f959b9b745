"""One mistake in a model is told once, and its edit brings the model back."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

URDF = """\
<robot name="cart">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base_footprint"/>
  <joint name="base_joint" type="fixed">
    <parent link="base_footprint"/>
    <child link="base_link"/>
    <origin xyz="0 0 0.15" rpy="0 0 0"/>
  </joint>
  <link name="base_link">
    <visual>
      <geometry>
        <box size="0.4 0.3 0.2"/>
      </geometry>
      <material name="grey"/>
    </visual>
    <collision>
      <geometry>
        <box size="0.4 0.3 0.2"/>
      </geometry>
    </collision>
    <inertial>
      <mass value="12"/>
      <inertia ixx="0.13" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/>
    </inertial>
  </link>
  <joint name="left_wheel_joint" type="continuous">
    <parent link="base_link"/>
    <child link="left_wheel"/>
    <origin xyz="-0.1 0.2 -0.05" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
  </joint>
  <link name="left_wheel">
    <visual>
      <origin xyz="0 0 0" rpy="1.5708 0 0"/>
      <geometry><cylinder radius="0.1" length="0.04"/></geometry>
    </visual>
  </link>
  <joint name="right_wheel_joint" type="continuous">
    <parent link="base_link"/>
    <child link="right_wheel"/>
    <origin xyz="-0.1 -0.2 -0.05" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
  </joint>
  <link name="right_wheel">
    <visual>
      <origin xyz="0 0 0" rpy="1.5708 0 0"/>
      <geometry><cylinder radius="0.1" length="0.04"/></geometry>
    </visual>
  </link>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar">
      <always_on>true</always_on>
      <update_rate>10.5</update_rate>
      <topic>scan</topic>
      <lidar>
        <scan><horizontal><samples>360</samples></horizontal></scan>
      </lidar>
    </sensor>
  </gazebo>
</robot>
"""
SDF = """\
<sdf version="1.8">
  <model name="cart" canonical_link="base_link">
    <link name="base_link">
      <visual name="body">
        <geometry>
          <box><size>0.4 0.3 0.2</size></box>
        </geometry>
      </visual>
    </link>
    <joint name="wheel_joint" type="continuous">
      <pose relative_to="base_link">0.1 0.2 0 0 0 0</pose>
      <parent>base_link</parent>
      <child>wheel</child>
      <axis>
        <xyz>0 1 0</xyz>
      </axis>
    </joint>
    <link name="wheel">
      <pose relative_to="wheel_joint"/>
      <visual name="tyre">
        <pose>0 0 0 1.5708 0 0</pose>
        <geometry>
          <cylinder><radius>0.1</radius><length>0.04</length></cylinder>
        </geometry>
      </visual>
    </link>
  </model>
</sdf>
"""
ENDS = """    <parent link="base_footprint"/>
    <child link="base_link"/>
"""
EXCHANGED = """    <parent link="base_link"/>
    <child link="base_footprint"/>
"""
INERTIAL = URDF[URDF.index("    <inertial>") : URDF.index("    </inertial>") + 16]
CASES = [
    (URDF, 'name="right_wheel_joint"', 'name="left_wheel_joint"', "joint-duplicate"),
    (URDF, '<link name="right_wheel"', '<link name="left_wheel"', "link-duplicate"),
    (URDF, 'name="base_joint"', 'name="left_wheel_joint"', "joint-duplicate"),
    (URDF, '"0 0 0.15"', '"0 0 -0.15"', "wheel-not-on-ground"),
    (URDF, '<axis xyz="0 1 0"', '<axis xyz="0 0 0"', "axis-zero"),
    (URDF, 'value="12"', 'value="-12"', "inertia-impossible"),
    (URDF, 'izz="0.25"', 'izz="2.5"', "inertia-impossible"),
    (URDF, 'ixx="0.13" ixy="0"', 'ixx="0" ixy="0.13"', "inertia-impossible"),
    (URDF, 'rpy="0 0 0"', 'rpy="0 0"', "number-malformed"),
    (URDF, '<material name="grey"/>', '<material name="Grey"/>', "material-undefined"),
    (URDF, ">true<", ">tru<", "sdf-value"),
    (URDF, ">10.5<", ">10,5<", "sdf-value"),
    (URDF, "topic>scan</topic", "ttopic>scan</ttopic", "element-misspelt"),
    (
        SDF,
        '"base_link">\n    <link',
        '"base_lnk">\n    <link',
        "sdf-canonical-link-unknown",
    ),
    (SDF, "<xyz>0 1 0</xyz>", "<xyz>0 0 0</xyz>", "axis-zero"),
    (SDF, "0.1 0.2 0 0 0 0", "0.1 0.2 0 0 0", "sdf-value"),
    (SDF, "0 0 0 1.5708 0 0", "0 0 0 1.5708 0", "sdf-value"),
]


@pytest.mark.parametrize(("text", "right", "wrong", "code"), CASES)
def test_the_edit_brings_the_model_back(
    tmp_path: Path, text: str, right: str, wrong: str, code: str
) -> None:
    assert right in text
    path = tmp_path / ("cart.sdf" if text is SDF else "cart.urdf")
    path.write_text(text)
    told = {(p.code, p.message) for p in check(path)}
    path.write_text(text.replace(right, wrong, 1))
    problems = [p for p in check(path) if (p.code, p.message) not in told]

    assert [p.code for p in problems] == [code]
    path.write_bytes(edited_files(problems[0].edits)[str(path)])
    assert {(p.code, p.message) for p in check(path)} == told
    for one, other in zip(path.read_text().split(), text.split(), strict=True):
        assert one == other or "izz" in one


@pytest.mark.parametrize("text", [URDF, SDF])
def test_the_models_have_no_problem(tmp_path: Path, text: str) -> None:
    path = tmp_path / ("cart.sdf" if text is SDF else "cart.urdf")
    path.write_text(text)
    assert [p for p in check(path) if p.severity != "info"] == []


def test_a_shape_without_geometry_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    shape = '<cylinder radius="0.1" length="0.04"/>'
    bare = URDF.replace(f"<geometry>{shape}</geometry>", shape, 1)
    path.write_text(bare)
    (problem,) = (p for p in check(path) if p.code == "element-misplaced")
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text().split() == URDF.split()


def test_a_part_beside_its_link_is_moved_into_it(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    beside = INERTIAL.replace("    <", "  <")
    path.write_text(URDF.replace(f"{INERTIAL}  </link>\n", f"  </link>\n{beside}"))
    (problem,) = (p for p in check(path) if p.code == "element-misplaced")
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text().split() == URDF.split()


def test_base_footprint_and_base_link_are_exchanged_back(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    drive = (
        '<gazebo><plugin filename="gz-sim-diff-drive-system" name="x">'
        "<child_frame_id>base_footprint</child_frame_id></plugin></gazebo></robot>"
    )
    text = URDF.replace("</robot>", drive)
    path.write_text(text.replace(ENDS, EXCHANGED))
    (problem,) = (p for p in check(path) if p.code == "wheel-not-on-ground")
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == text


def test_base_footprint_between_the_wheels_is_only_noted(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    path.write_text(URDF.replace('"0 0 0.15"', '"0 0 0.05"'))
    (problem,) = (p for p in check(path) if p.code == "wheel-not-on-ground")
    assert problem.severity == "info"


CONTROL = """\
  <ros2_control name="sim" type="system">
    <hardware>
      <plugin>gz_ros2_control/GazeboSimSystem</plugin>
    </hardware>
    <joint name="left_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <joint name="right_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
CLASSIC = """\
  <gazebo reference="base_link">
    <sensor name="laser" type="ray">
      <plugin name="laser" filename="libgazebo_ros_ray_sensor.so">
        <output_type>sensor_msgs/LaserScan</output_type>
        <frame_name>base_link</frame_name>
      </plugin>
    </sensor>
  </gazebo>
</robot>
"""
INTERFACE, PLUGIN = "control-interface", "gazebo-plugin"
AS_TEXT = (
    "<plugin>gz_ros2_control/GazeboSimSystem</plugin>",
    '<plugin name="gz_ros2_control/GazeboSimSystem"/>',
)


@pytest.mark.parametrize(
    ("part", "right", "wrong", "code"),
    [
        (CONTROL, "velocity", "velosity", INTERFACE),
        (CONTROL, "GazeboSim", "GazebboSim", INTERFACE),
        (CONTROL, 'type="system"', 'type="sytem"', INTERFACE),
        (CONTROL, *AS_TEXT, INTERFACE),
        (CONTROL, AS_TEXT[0], AS_TEXT[1].replace("/>", "></plugin>"), INTERFACE),
        (CONTROL, '"right_wheel_joint">', '"left_wheel_joint">', INTERFACE),
        (CONTROL, "state_interface name", "stat_interface name", "element-misspelt"),
        (CONTROL, "state_interface name", "state_interface nAme", "attribute-misspelt"),
        (CLASSIC, "_ray_sensor.so", "_raysensor.so", PLUGIN),
        (CLASSIC, "sensor_msgs/", "sensor_msgs/msg/", PLUGIN),
        (CLASSIC, "frame_name>", "frame_nme>", "gazebo-element-unknown"),
    ],
)
def test_the_edit_brings_parts_for_the_simulator_back(
    tmp_path: Path, part: str, right: str, wrong: str, code: str
) -> None:
    path = tmp_path / "cart.urdf"
    text = URDF[: URDF.index("  <gazebo")] + part
    path.write_text(text)
    assert [p for p in check(path) if p.severity != "info"] == []
    path.write_text(text.replace(right, wrong, 2 if right == "frame_name>" else 1))
    (problem,) = (p for p in check(path) if p.severity != "info")
    assert problem.code == code
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == text


def test_only_a_lidar_chooses_its_message(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    part = CLASSIC.replace('"ray"', '"imu"').replace("ray_sensor", "imu_sensor")
    part = part.replace("sensor_msgs/LaserScan", "sensor_msgs/msg/Imu")
    path.write_text(URDF[: URDF.index("  <gazebo")] + part)
    assert [p for p in check(path) if p.code == PLUGIN] == []


@pytest.mark.parametrize("around", ["gazebo", "link"])
def test_a_part_for_controllers_is_moved_into_the_robot(
    tmp_path: Path, around: str
) -> None:
    path = tmp_path / "cart.urdf"
    text = URDF[: URDF.index("  <gazebo")] + CONTROL
    part = CONTROL.removesuffix("</robot>\n")
    inside = f'  <{around} name="x">\n{part}  </{around}>\n'
    path.write_text(text.replace(part, inside))
    (problem,) = (p for p in check(path) if "ros2_control" in p.message)
    assert problem.code == "element-misplaced"
    path.write_bytes(edited_files(problem.edits)[str(path)])
    moved = f'{part}  <{around} name="x">\n  </{around}>\n'
    assert path.read_text() == text.replace(part, moved)


def test_a_part_that_nothing_reads_has_to_be_xml(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>cart</name></package>")
    (tmp_path / "cart.urdf").write_text(URDF)
    (tmp_path / "arm.xacro").write_text("<robot><link></robot>")
    found = [p for p in check(tmp_path) if p.code == "xml-tag-not-closed"]
    assert [p.file for p in found] == [str(tmp_path / "arm.xacro")]
