"""What is not certain is not reported, and no file can do harm."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF = "config/ekf.yaml"
NAV2 = "config/nav2_params.yaml"
BRIDGE = "config/bridge_config.yaml"
CONFIG = "rviz/beside.rviz"

Copied = Callable[[str], Path]


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def codes(package: Path, trusted: bool = True) -> list[str]:
    return [p.code for p in check(package / MODEL, trusted=trusted)]


def test_a_frame_that_a_launch_file_publishes_is_known(copied: Copied) -> None:
    package = copied("gz")
    edit(package / NAV2, "robot_base_frame: base_link", "robot_base_frame: cart_base")
    assert codes(package) == ["frame-unknown"] * 3
    edit(
        package / LAUNCH,
        "            spawn,",
        '            spawn,\n            Node(package="tf2_ros", '
        'executable="static_transform_publisher", '
        'arguments=["0", "0", "0", "0", "0", "0", "base_link", "cart_base"]),',
    )
    assert codes(package) == []


def test_a_topic_that_a_program_of_the_package_publishes_is_known(
    copied: Copied,
) -> None:
    package = copied("gz")
    edit(package / EKF, "odom0: demo/odom", "odom0: wheel/odom")
    assert codes(package) == ["topic-unknown"]
    (package / "src").mkdir()
    (package / "src" / "driver.cpp").write_text('advertise("wheel/odom");\n')
    assert codes(package) == []


def test_another_model_of_the_robot_hides_no_topic(copied: Copied) -> None:
    """The guide's package has the robot in URDF and in SDF."""
    package = copied("gz")
    edit(package / EKF, "odom0: demo/odom", "odom0: odom")
    other = package / "urdf" / "cart.sdf"
    other.write_text(
        "<odom_topic>/demo/odom</odom_topic><frame_id>odom</frame_id>"
        "<odometry_frame>odom</odometry_frame>"
    )
    assert codes(package) == ["topic-unknown"]
    other.write_text("<odom_topic>/odom</odom_topic>")
    assert codes(package) == []


def test_the_topic_of_a_controller_with_parameters_is_known(copied: Copied) -> None:
    package = copied("gz")
    edit(package / EKF, "odom0: demo/odom", "odom0: diff_cont/odom")
    (package / "config" / "controllers.yaml").write_text(
        "diff_cont:\n  ros__parameters:\n    publish_rate: 50.0\n"
    )
    assert codes(package) == []


def test_below_a_namespace_names_are_not_the_final_ones(copied: Copied) -> None:
    package = copied("gz")
    edit(package / EKF, "base_link_frame: base_link", "base_link_frame: cart1/base")
    edit(package / EKF, "imu0: demo/imu", "imu0: imu")
    assert codes(package) == ["topic-unknown"]
    edit(
        package / LAUNCH,
        'executable="ekf_node",',
        'executable="ekf_node",\n        namespace=LaunchConfiguration("name"),',
    )
    declared = '            DeclareLaunchArgument("use_sim_time"'
    edit(
        package / LAUNCH,
        declared,
        f'            DeclareLaunchArgument("name"),\n{declared}',
    )
    assert codes(package) == []


CONDITIONS = "\nfrom launch.conditions import IfCondition"


def test_what_is_under_a_condition_is_not_certain(copied: Copied) -> None:
    package = copied("gz")
    classic = 'Node(package="gazebo_ros", executable="spawn_entity.py"'
    edit(package / LAUNCH, "            spawn,", f"            spawn,\n    {classic}),")
    edit(package / LAUNCH, "import os", "import os\nfrom launch.conditions import *")
    assert codes(package) == ["gazebo-both"]
    edit(
        package / LAUNCH,
        classic,
        f'{classic}, condition=IfCondition(LaunchConfiguration("classic"))',
    )
    edit(package / LAUNCH, "\nfrom launch_ros", f"{CONDITIONS}\nfrom launch_ros")
    declared = '            DeclareLaunchArgument("use_sim_time"'
    edit(
        package / LAUNCH,
        declared,
        f'            DeclareLaunchArgument("classic"),\n{declared}',
    )
    assert codes(package) == []


@pytest.mark.parametrize(
    ("declared", "found"), [(True, ["sim-time-off"] * 2), (False, [])]
)
def test_the_default_of_an_argument_that_is_not_declared_is_not_certain(
    copied: Copied, declared: bool, found: list[str]
) -> None:
    package = copied("gz")
    used = 'LaunchConfiguration("use_sim_time"'
    edit(package / LAUNCH, used, f'{used}, default="false"')
    line = 'DeclareLaunchArgument("use_sim_time", default_value="True"),'
    edit(package / LAUNCH, line, line.replace("True", "False") if declared else "")
    assert codes(package) == found


ARGUMENTS = """
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    os.path.join(gz_share, "launch", "gz_sim.launch.py")
                ),
                launch_arguments={"gz_args": GIVEN}.items(),
            ),
            ExecuteProcess(cmd=["gz", "sim", world, "-r"]),
            Node(package="ros_gz_sim", executable="gzserver", arguments=[world, "-r"]),
"""


@pytest.mark.parametrize(
    "given",
    [
        'world + " -r"',
        '"-r " + world',
        'f"-r -v4 {world}"',
        '[world, " -r -v 4"]',
        '["-s -r --headless-rendering ", world]',
    ],
)
def test_the_options_beside_a_world_are_not_of_its_name(
    copied: Copied, given: str
) -> None:
    package = copied("gz")
    start = "GzServer(world_sdf_file=world),"
    edit(package / LAUNCH, start, ARGUMENTS.replace("GIVEN", given))
    assert codes(package) == []
    edit(package / LAUNCH, '"room.sdf"', '"rom.sdf"')
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.hint) == (
        "launch-file-missing",
        "write world/room.sdf",
    )


@pytest.mark.parametrize("tool", ["catkin", "ament_cmake"])
def test_a_package_of_ros_1_has_the_plugins_of_ros_1(copied: Copied, tool: str) -> None:
    package = copied("classic")
    for name in ("separation", "diameter"):
        new = f"wheel{name.capitalize()}"
        for end in ("<", "</"):
            edit(package / MODEL, f"{end}wheel_{name}>", f"{end}{new}>")
    for part in ("buildtool_depend", "build_type"):
        edit(package / "package.xml", f"<{part}>ament_cmake", f"<{part}>{tool}")
    edit(package / "CMakeLists.txt", "find_package(ament_cmake", "find_package(catkin")
    found = codes(package)
    assert (found == []) == (tool == "catkin")
    # What is wrong in either ROS is said.
    edit(package / MODEL, "<wheelSeparation>0.4", "<wheelSeparation>0.1")
    assert "drive-wheel-separation" in codes(package)


@pytest.mark.parametrize(
    ("frame", "found"),
    [("world", []), ("map", []), ("/odom", []), ("lidar_lnk", ["frame-unknown"])],
)
def test_a_sensor_may_report_in_the_world(
    copied: Copied, frame: str, found: list[str]
) -> None:
    package = copied("classic")
    own = "<frame_name>lidar_link<"
    edit(package / MODEL, own, f"<frame_name>{frame}<")
    assert codes(package) == found


@pytest.mark.parametrize(
    ("found", "known"),
    [
        ("", False),
        ("find_package(Eigen3 REQUIRED)\nfind_package(Threads)", False),
        ("find_package(geometry_msgs REQUIRED)", True),
        ("find_package(Eigen3)\nfind_package(rclcpp REQUIRED)", True),
        ("foreach(one ${ALL})\nfind_package(${one})\nendforeach()", True),
    ],
)
def test_any_package_of_ros_brings_the_commands_of_ament(
    copied: Copied, found: str, known: bool
) -> None:
    package = copied("gz")
    edit(package / "CMakeLists.txt", "find_package(ament_cmake REQUIRED)", found)
    assert codes(package) == ([] if known else ["cmake-command-missing"])


def test_a_build_file_with_two_projects_has_no_certain_name(copied: Copied) -> None:
    package = copied("gz")
    found = "find_package(ament_cmake REQUIRED)"
    edit(package / "CMakeLists.txt", found, f"{found}\nproject(SUPERBUILD NONE)")
    assert codes(package) == []


def test_a_node_that_gets_its_parameters_from_the_launch_file_needs_no_other(
    copied: Copied,
) -> None:
    package = copied("gz")
    edit(package / LAUNCH, 'os.path.join(share, "config/ekf.yaml"),', "")
    assert codes(package) == ["launch-parameters-missing"]
    edit(package / LAUNCH, '{"use_sim_time": use', '{"odom0": "o", "use_sim_time": use')
    assert codes(package) == []


def test_a_node_that_is_defined_and_not_started_is_not_judged(copied: Copied) -> None:
    package = copied("gz")
    edit(package / LAUNCH, 'name="ekf_filter_node"', 'name="ekf"')
    assert codes(package) == ["launch-parameters-unread"]
    edit(package / LAUNCH, "            robot_localization,\n", "")
    assert codes(package) == ["launch-node-unused"]


def test_launch_files_of_tests_and_examples_need_not_be_installed(
    copied: Copied,
) -> None:
    package = copied("gz")
    for folder in ("test", "examples"):
        (package / folder).mkdir()
        text = (package / LAUNCH).read_text()
        (package / folder / "other.launch.py").write_text(text)
    assert codes(package) == []


def test_an_image_may_have_a_bridge_of_its_own(copied: Copied) -> None:
    package = copied("gz")
    edit(
        package / MODEL,
        '<sensor name="lidar"',
        '<sensor name="camera" type="camera"><topic>camera/image</topic></sensor>\n'
        '<sensor name="lidar"',
    )
    bridge = package / BRIDGE
    bridge.write_text(
        bridge.read_text()
        + '- topic_name: "/camera/depth_image"\n'
        + '  ros_type_name: "sensor_msgs/msg/Image"\n  gz_type_name: "gz.msgs.Image"\n'
    )
    assert codes(package) == ["bridge-topic"]
    edit(
        package / LAUNCH,
        "            spawn,",
        '            spawn,\n    Node(package="ros_gz_image", '
        'executable="image_bridge", arguments=["/camera/image"]),',
    )
    assert codes(package) == []


def test_a_bridge_in_the_arguments_of_a_node_is_read_too(copied: Copied) -> None:
    package = copied("gz")
    (package / BRIDGE).unlink()
    topics = [
        "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
        "/demo/imu@sensor_msgs/msg/Imu[gz.msgs.IMU",
        "/demo/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry",
        "/demo/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
        "/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    ]
    launch = (package / LAUNCH).read_text()
    start = launch.index("    bridge = RosGzBridge(")
    end = launch.index("    spawn = ")
    bridge = (
        '    bridge = Node(package="ros_gz_bridge", executable="parameter_bridge",\n'
        f"        arguments={topics})\n"
    )
    (package / LAUNCH).write_text(launch[:start] + bridge + launch[end:])
    assert codes(package) == []
    edit(package / LAUNCH, "/scan@", "/laser/scan@")
    # That nothing comes on /scan follows from this.
    assert codes(package) == ["bridge-topic"]
    edit(package / LAUNCH, "/laser/scan@", "/scan@")
    edit(package / LAUNCH, "'/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock', ", "")
    found = check(package / MODEL)
    assert [p.code for p in found] == ["clock-not-bridged"]
    assert found[0].hint == f"add '{topics[0]}' to the arguments of parameter_bridge"


@pytest.mark.parametrize(
    "text",
    [
        "foreach(d urdf launch)\ninstall(DIRECTORY ${d} DESTINATION share/x)\n"
        "endforeach()",
        "install(DIRECTORY . DESTINATION share/${PROJECT_NAME})",
        "ament_auto_package(INSTALL_TO_SHARE urdf launch rviz config world)",
        '#[[ install( ]]\nset(text [=[ " ( ]=])\nmessage(STATUS "a ( \\" # b\\n")\n'
        "install(DIRECTORY urdf launch rviz config world # (\n  DESTINATION "
        "${CMAKE_INSTALL_DATADIR}/${CMAKE_PROJECT_NAME}\n)\n"
        "if((A AND B) OR NOT C)\n  install(DIRECTORY nowhere DESTINATION share/x)\n"
        "endif()",
        "install(DIRECTORY urdf launch rviz config world DESTINATION\n"
        "  share/${PROJECT_NAME})\ninstall(DIRECTORY include/ DESTINATION include)\n"
        "install(DIRECTORY later OPTIONAL DESTINATION share/${PROJECT_NAME})\n"
        "install(PROGRAMS launch/display.launch.py DESTINATION lib/${PROJECT_NAME})",
        "install(DIRECTORY urdf launch rviz config world\n  DESTINATION "
        "share/cart_description\n"
        '  PATTERN "*.orig" EXCLUDE)',
        "install(DIRECTORY urdf launch rviz DESTINATION share/cart_description)\n"
        "install(FILES config/ekf.yaml config/bridge_config.yaml\n"
        "  DESTINATION share/${PROJECT_NAME}/config)\n"
        'install(DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/world" DESTINATION\n'
        "  ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})",
    ],
)
def test_a_folder_may_be_installed_in_many_ways(text: str, copied: Copied) -> None:
    package = copied("gz")
    (package / "include").mkdir()
    ending = "" if "ament_auto" in text else "ament_package()\n"
    (package / "CMakeLists.txt").write_text(
        "project(cart_description)\nfind_package(ament_cmake_auto REQUIRED)\n"
        f"{text}\n{ending}"
    )
    assert codes(package) == []


def test_a_python_package_installs_with_setup_py(copied: Copied) -> None:
    package = copied("classic")
    (package / "CMakeLists.txt").unlink()
    edit(package / "package.xml", ">ament_cmake</build", ">ament_python</build")
    (package / "setup.py").write_text(
        "import os\nfrom glob import glob\nfrom setuptools import setup\n"
        "package_name = 'cart_description'\n"
        "setup(\n"
        "    name=package_name,\n"
        "    data_files=[\n"
        "        (os.path.join('share', package_name, 'launch'), glob('launch/*')),\n"
        "        (os.path.join('share', package_name, 'urdf'), glob('urdf/*')),\n"
        "        (os.path.join('share', package_name, 'rviz'), glob('rviz/*')),\n"
        "        (os.path.join('share', package_name), ['package.xml']),\n"
        "        ('share/ament_index/resource_index/packages',\n"
        "         ['resource/' + package_name]),\n"
        "    ],\n)\n"
    )
    (package / "resource").mkdir()
    (package / "resource" / "cart_description").touch()
    found = check(package / MODEL)
    assert [p.code for p in found] == ["folder-not-installed"]
    assert found[0].file == str(package / "setup.py")
    assert found[0].line == 7
    added = found[0].hint.removeprefix("add ").removesuffix(" to data_files")
    edit(package / "setup.py", "    ],\n)", f"        {added},\n    ],\n)")
    assert codes(package) == []


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe\x00a",
        b"a: [",
        b"[" * 100_000,
        b"- " * 100_000,
        b"ekf: &e {ros__parameters: &p {odom0: *e, x: *p}}",
        b"a0: &a0 {x: 1}\n"
        + b"".join(
            b"a%d: &a%d {p: *a%d, q: *a%d, r: *a%d}\n" % (n, n, n - 1, n - 1, n - 1)
            for n in range(1, 40)
        )
        + b"n: {ros__parameters: *a39}\n",
        b"n:\n  ros__parameters:\n    footprint: '[[nan, inf], [1, 2], [1e999, 3]]'\n",
        b"x" * 1_000_000,
    ],
    ids=["empty", "utf16", "open", "deep", "deeper", "ring", "bomb", "nan", "large"],
)
@pytest.mark.parametrize("name", [EKF, NAV2, BRIDGE, CONFIG])
def test_a_yaml_file_that_is_none_does_no_harm(
    name: str, data: bytes, copied: Copied
) -> None:
    package = copied("gz")
    (package / name).write_bytes(data)
    begin = time.process_time()
    of_config = {
        *("config-empty", "config-encoding", "config-not-rviz", "config-yaml"),
        "setup-no-robot-model",
    }
    assert set(codes(package)) <= (of_config if name == CONFIG else set()) | {
        "clock-not-bridged",
        "launch-parameters-unread",
        "parameters-empty",
        "parameters-key",
        "parameters-yaml",
    }
    assert time.process_time() - begin < 3


@pytest.mark.parametrize(
    "text",
    [
        "\0",
        "def f(:",
        "x = " + "(" * 5000,
        "\n".join(f"a{n} = [a{n + 1}, a{n + 1}]" for n in range(200)) + "\na200 = 'x'",
        "a = b\nb = a\nos.path.join(a, b)",
        "Node(package=1, parameters=[*x, **y], arguments=f())",
    ],
    ids=["nul", "syntax", "deep", "bomb", "ring", "odd"],
)
@pytest.mark.parametrize("name", [LAUNCH, "setup.py"])
def test_a_python_file_that_is_none_does_no_harm(
    name: str, text: str, copied: Copied
) -> None:
    package = copied("classic")
    (package / name).write_text(text)
    begin = time.process_time()
    assert set(codes(package)) <= {"launch-code", "python-syntax", "setup-py-code"}
    assert time.process_time() - begin < 3


@pytest.mark.parametrize(
    "text",
    [
        "\0",
        "(" * 400_000,
        "[[ " * 130_000,
        "[[ " * 6_600,
        "#[[ \n" * 3_900,
        'a"' * 9_999,
    ],
    ids=["nul", "deep", "large", "brackets", "comments", "quotes"],
)
def test_a_cmake_file_that_is_none_does_no_harm(text: str, copied: Copied) -> None:
    package = copied("gz")
    (package / "CMakeLists.txt").write_text(text)
    begin = time.process_time()
    assert set(codes(package)) <= {"cmake-unclosed"}
    assert time.process_time() - begin < 3


@pytest.mark.parametrize(
    ("ros_type", "gz_type"),
    [
        ("geometry_msgs/msg/Vector3", "gz.msgs.Vector3d"),
        ("geometry_msgs/msg/AccelWithCovarianceStamped", "gz.msgs.Accel"),
        ("sensor_msgs/msg/CompressedImage", "gz.msgs.Image"),
        ("std_msgs/msg/Float32", "ignition.msgs.Float"),
        ("our_msgs/msg/Imus", "our.msgs.LaserScam"),
    ],
)
def test_a_type_that_is_no_misspelt_one_is_not_judged(
    copied: Copied, ros_type: str, gz_type: str
) -> None:
    package = copied("gz")
    with (package / BRIDGE).open("a") as file:
        file.write(f"- topic_name: /more\n  ros_type_name: {ros_type}\n")
        file.write(f"  gz_type_name: {gz_type}\n  direction: GZ_TO_ROS\n")
    assert codes(package) == []


def test_links_out_of_the_package_are_not_followed_for_an_untrusted_model(
    copied: Copied, tmp_path: Path
) -> None:
    package = copied("gz")
    outside = tmp_path / "outside.yaml"
    edit(package / NAV2, 'base_frame_id: "base_footprint"', "base_frame_id: secret")
    (package / NAV2).rename(outside)
    (package / NAV2).symlink_to(outside)
    assert codes(package) == ["frame-unknown"]
    assert codes(package, trusted=False) == []


def test_another_package_in_a_folder_of_this_one_is_not_read(copied: Copied) -> None:
    package = copied("gz")
    inner = package / "other"
    inner.mkdir()
    (inner / "package.xml").write_text("<package><name>other</name></package>")
    (inner / "nav2_params.yaml").write_text(
        "amcl:\n  ros__parameters:\n    base_frame_id: nowhere\n"
    )
    assert codes(package) == []


def test_a_file_that_others_include_is_compared_with_nothing(copied: Copied) -> None:
    package = copied("gz")
    part = package / "urdf" / "part.xacro"
    part.write_text(
        '<robot xmlns:xacro="http://ros.org/wiki/xacro"><link name="rod"/></robot>'
    )
    assert [p.code for p in check(part)] == ["robot-without-name"]


def test_a_model_outside_of_any_package_is_compared_with_nothing(
    copied: Copied, tmp_path: Path
) -> None:
    package = copied("gz")
    edit(package / EKF, "base_link_frame: base_link", "base_link_frame: nowhere")
    assert codes(package) == ["frame-unknown"]
    (package / "package.xml").unlink()
    assert codes(package) == []


def test_the_left_of_a_robot_that_drives_backwards_is_the_other(copied: Copied) -> None:
    package = copied("gz")
    edit(package / MODEL, ">left_wheel_joint<", ">x<")
    edit(package / MODEL, ">right_wheel_joint<", ">left_wheel_joint<")
    edit(package / MODEL, ">x<", ">right_wheel_joint<")
    assert codes(package) == ["drive-sides"]
    edit(package / MODEL, '<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>')
    assert codes(package) == []


def test_a_footprint_may_keep_a_distance(copied: Copied) -> None:
    package = copied("gz")
    edit(package / NAV2, "robot_radius: 0.3", "robot_radius: 0.5")
    assert codes(package) == []
    edit(package / NAV2, "robot_radius: 0.5", "robot_radius: 1.2")
    assert codes(package) == ["footprint-size"]
    bumper = '<visual><geometry><box size="1.4 0.1 0.1"/></geometry></visual>'
    edit(package / MODEL, '<link name="base_link">', f'<link name="base_link">{bumper}')
    assert codes(package) == []


def test_files_with_other_footprints_may_be_for_several_robots(copied: Copied) -> None:
    package = copied("gz")
    other = package / "config" / "slow_params.yaml"
    other.write_text((package / NAV2).read_text().replace("robot_radius: 0.3", "r: 0"))
    edit(package / NAV2, "robot_radius: 0.3", "robot_radius: 0.05")
    severities = {p.severity for p in check(package / MODEL)}
    assert severities == {"warning"}
    edit(other, "r: 0", "robot_radius: 0.1")
    severities = {p.severity for p in check(package / MODEL)}
    assert severities == {"info"}


@pytest.mark.parametrize("done", ["os.path.exists(model)", "open(model, 'w')"])
def test_a_file_that_a_launch_file_makes_or_looks_for_may_be_missing(
    copied: Copied, done: str
) -> None:
    package = copied("gz")
    edit(package / LAUNCH, "config/ekf.yaml", "config/my_ekf.yaml")
    assert codes(package) == ["launch-file-missing"]
    edit(package / LAUNCH, "    rviz =", f"    {done}\n    rviz =")
    assert codes(package) == []


@pytest.mark.parametrize(
    "source", ["from other import made\n", "made = getattr(module, 'made')\n"]
)
def test_a_function_of_another_module_may_make_the_file(
    copied: Copied, source: str
) -> None:
    package = copied("gz")
    path = 'os.path.join(share, "config/{}ekf.yaml")'
    edit(package / LAUNCH, path.format(""), path.format("my_"))
    assert codes(package) == ["launch-file-missing"]
    edit(package / LAUNCH, path.format("my_"), f"made({path.format('my_')})")
    edit(package / LAUNCH, "import os\n", f"import os\n{source}")
    assert "launch-file-missing" not in codes(package)


def test_a_launch_file_may_have_another_folder_once_it_is_installed(
    copied: Copied,
) -> None:
    package = copied("gz")
    include = '<include file="$(find-pkg-share cart_description)/launch/x.launch.xml"/>'
    (package / "launch" / "inner").mkdir()
    (package / "launch" / "inner" / "x.launch.xml").write_text("<launch/>")
    (package / "launch" / "all.launch.xml").write_text(f"<launch>{include}</launch>")
    assert codes(package) == ["launch-file-missing"]
    line = "install(FILES launch/inner/x.launch.xml DESTINATION share/x/launch)\n"
    edit(package / "CMakeLists.txt", "ament_package()", f"{line}ament_package()")
    assert "launch-file-missing" not in codes(package)


def test_the_shape_of_an_arm_does_not_count_for_the_footprint(copied: Copied) -> None:
    package = copied("gz")
    arm = (
        '<link name="arm"><collision><origin xyz="0.5 0 0"/><geometry>'
        '<box size="1 0.1 0.1"/></geometry></collision><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>\n'
        '<joint name="arm_joint" type="{}"><parent link="base_link"/>'
        '<child link="arm"/>{}</joint>\n</robot>'
    )
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    edit(package / MODEL, "</robot>", arm.format("revolute", limit))
    assert codes(package) == []
    edit(package / MODEL, 'type="revolute"', 'type="fixed"')
    (problem,) = check(package)
    assert problem.code == "footprint-size"
    assert problem.file == str(package / MODEL)
    assert "the rest of the robot fits" in problem.message


def test_wheels_that_skid_may_have_a_larger_separation(copied: Copied) -> None:
    package = copied("gz")
    edit(package / MODEL, "separation>0.4<", "separation>0.6<")
    assert codes(package) == ["drive-wheel-separation"]
    edit(
        package / MODEL,
        "      <left_joint>left_wheel_joint</left_joint>",
        "      <left_joint>left_wheel_joint</left_joint>\n"
        "      <left_joint>left_wheel_joint</left_joint>\n"
        "      <right_joint>right_wheel_joint</right_joint>",
    )
    assert codes(package) == []


def test_the_robots_of_others_have_only_the_findings_that_are_true(
    shared: Path,
) -> None:
    models = [
        path
        for path in sorted((shared / "data" / "robots").rglob("*"))
        if path.suffix in (".urdf", ".xacro", ".URDF")
        and b"<plugin" in path.read_bytes()
    ]
    assert len(models) > 20
    wrong = {
        (path.parent.name, problem.code)
        for path in models
        for problem in check(path)
        if problem.code in NAMES_THAT_MUST_MEET
    }
    # Its drive still has the sizes of another robot.
    assert wrong == {
        ("alphabot2", "drive-wheel-separation"),
        ("alphabot2", "drive-wheel-radius"),
    }


NAMES_THAT_MUST_MEET = frozenset(
    "gazebo-joint gazebo-reference gazebo-generation gazebo-element gazebo-both "
    "drive-wheel-separation drive-wheel-radius frame-unknown frame-two-parents "
    "frame-odom ekf-world-frame transform-twice topic-unknown bridge-topic "
    "bridge-types bridge-direction clock-not-bridged sim-time-off launch-xacro-py "
    "launch-file-missing launch-parameters-unread launch-world-name "
    "folder-not-installed footprint-size sensor-frame ekf-two-d-mode cmake-unclosed "
    "cmake-project-name install-folder-missing install-destination".split()
)


OTHER = """<robot name="truck"><link name="cab"/><link name="bed"/>
<joint name="j" type="fixed"><parent link="cab"/><child link="bed"/></joint></robot>
"""


@pytest.mark.parametrize(
    ("model", "config", "found"),
    [
        ("", "truck/nav2.yaml", ["footprint-size"]),
        ("urdf/truck.urdf", "truck/nav2.yaml", []),
        ("urdf/truck.urdf", "nav2_truck/nav2.yaml", []),
        ("robots/truck/robot.urdf", "truck/nav2.yaml", []),
        ("urdf/cart.sdf", "truck/nav2.yaml", ["footprint-size"]),
    ],
)
def test_parameters_may_be_for_another_robot_of_the_package(
    copied: Copied, model: str, config: str, found: list[str]
) -> None:
    package = copied("gz")
    edit(package / NAV2, "robot_radius: 0.3", "robot_radius: 0.05")
    other = package / "config" / config
    other.parent.mkdir()
    (package / NAV2).rename(other)
    if model:
        (package / model).parent.mkdir(parents=True, exist_ok=True)
        (package / model).write_text(OTHER)
    assert codes(package) == found


def test_of_two_robots_each_has_the_parameters_that_fit(copied: Copied) -> None:
    package = copied("gz")
    second = package / "config" / "other_params.yaml"
    second.write_text((package / NAV2).read_text().replace("0.3", "0.05"))
    assert "footprint-size" in codes(package)
    (package / "urdf" / "truck.urdf").write_text(OTHER)
    assert "footprint-size" not in codes(package)


DECLARED = 'DeclareLaunchArgument("use_sim_time", default_value="True")'
LET = '<let name="own_flag" value="-s" if="$(var flag)"/>'


def test_another_module_may_declare_the_arguments(copied: Copied) -> None:
    package = copied("gz")
    edit(package / LAUNCH, DECLARED, "Arguments.sim_time()")
    assert "launch-argument-unknown" in codes(package)
    edit(package / LAUNCH, "import os\n", "import os\nfrom arm import Arguments\n")
    assert codes(package) == []


def test_a_variable_does_not_stand_for_an_argument_in_its_own_value(
    copied: Copied,
) -> None:
    package = copied("gz")
    launch = f'<launch><arg name="map" default="a"/>{LET}</launch>'
    (package / "launch" / "gz.launch.xml").write_text(launch)
    (found,) = check(package / MODEL)
    assert (found.code, found.severity) == ("launch-argument-unknown", "warning")
    assert "own_flag" not in found.message + found.hint


def test_files_of_an_installed_folder_lie_beside_the_manifest(copied: Copied) -> None:
    package = copied("gz")
    include = '<include file="$(find-pkg-share cart_description)/inner/x.launch.xml"/>'
    (package / "launch" / "inner").mkdir()
    (package / "launch" / "inner" / "x.launch.xml").write_text("<launch/>")
    (package / "launch" / "all.launch.xml").write_text(f"<launch>{include}</launch>")
    assert codes(package) == ["launch-file-missing"]
    edit(package / "CMakeLists.txt", "urdf launch", "launch/ urdf launch")
    assert codes(package) == []


def test_the_joint_state_publisher_takes_any_rate(copied: Copied) -> None:
    package = copied("gz")
    node = (
        'Node(package="joint_state_publisher", executable="joint_state_publisher", '
        'parameters=[{"rate": 30.0}])'
    )
    edit(
        package / LAUNCH,
        "            spawn,",
        f"            spawn,\n            {node},",
    )
    assert "parameter-type" not in codes(package)


@pytest.mark.parametrize(
    ("installs", "found"),
    [("DIRECTORY parts/meshes", False), ("DIRECTORY parts", True)],
)
def test_a_mesh_lies_where_the_build_installs_it(
    copied: Copied, installs: str, found: bool
) -> None:
    package = copied("gz")
    folder = package / "parts" / "meshes"
    folder.mkdir(parents=True)
    (folder / "lid.stl").write_bytes(bytes(84))
    mesh = '<mesh filename="package://cart_description/meshes/lid.stl"/>'
    edit(
        package / MODEL,
        "</robot>",
        f'<link name="lid"><visual><geometry>{mesh}</geometry></visual></link><joint '
        'name="lid_joint" type="fixed"><parent link="base_link"/><child link="lid"/>'
        "</joint></robot>",
    )
    edit(package / "CMakeLists.txt", "DIRECTORY urdf", f"{installs} urdf")
    assert ("file-by-path-only" in codes(package)) is found
