"""Each mistake in the files around a model is found, named at both places, and fixed.

A small package in the style of the Nav2 guide gets one mistake at a time. The fix is
the edits of the finding, or what it says, and leaves nothing to report.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF = "config/ekf.yaml"
NAV2 = "config/nav2_params.yaml"
BRIDGE = "config/bridge_config.yaml"
CMAKE = "CMakeLists.txt"

Copied = Callable[[str], Path]

Edit = tuple[str, str, str]
"""File, text, and what is written instead; an empty text means the end of the file."""


@dataclass(frozen=True)
class Mistake:
    """One mistake.

    Attributes:
        code: of the finding.
        package: the package that gets it: "gz" or "classic".
        made: the edits that make it.
        at: the file and the text of the line of the finding, after the edits.
        other: the file and the text of the second line that the finding names, if any.
        advice: words of the hint.
        fixed: what the hint says, where the finding has no edits.
        count: so many findings of that code.
    """

    code: str
    made: tuple[Edit, ...]
    at: tuple[str, str]
    other: tuple[str, str]
    advice: str
    fixed: tuple[Edit, ...] = ()
    package: str = "gz"
    count: int = 1
    name: str = field(default="", compare=False)


def one(
    code: str,
    file: str,
    old: str,
    new: str,
    other: tuple[str, str],
    advice: str,
    better: str = "",
    package: str = "gz",
    count: int = 1,
    name: str = "",
    by_hand: bool = False,
) -> Mistake:
    """A mistake in one line; fixed by hand in the same line, `better` is not `old`."""
    at = (file, new.strip().splitlines()[-1].strip())
    fixed = ((file, new, better or old),) if by_hand else ()
    return Mistake(
        code, ((file, old, new),), at, other, advice, fixed, package, count, name
    )


SPLIT = "<wheel_separation>0.4<"
RADIUS = "<wheel_radius>${wheel_radius}<"
EKF_BASE = "base_link_frame: base_link"
MAP_FILTER = """\
map_filter:
  ros__parameters:
    two_d_mode: false
    world_frame: map
    odom0: demo/odom
"""
CONTROLLER = """\
drive:
  ros__parameters:
    left_wheel_names: ["left_wheel_joint"]
    right_wheel_names: ["right_wheel_joint"]
    wheel_separation: 0.36
    wheel_radius: 0.1
    base_frame_id: base_link
"""

MISTAKES = [
    one(
        "gazebo-joint",
        MODEL,
        "<left_joint>left_wheel_joint<",
        "<left_joint>left_whel_joint<",
        (MODEL, '<joint name="${prefix}_joint" type="continuous">'),
        "write left_wheel_joint",
    ),
    one(
        "gazebo-joint",
        MODEL,
        "<left_joint>left_wheel_joint<",
        "<left_joint>imu_joint<",
        (MODEL, '<joint name="imu_joint" type="fixed">'),
        "write left_wheel_joint",
        name="fixed",
    ),
    one(
        "gazebo-joint",
        MODEL,
        "<topic>joint_states</topic>",
        "<topic>joint_states</topic><joint_name>right_whel_joint</joint_name>",
        (MODEL, '<joint name="${prefix}_joint" type="continuous">'),
        "write right_wheel_joint",
        name="of a joint state publisher",
    ),
    one(
        "gazebo-reference",
        MODEL,
        '<gazebo reference="lidar_link">',
        '<gazebo reference="lidar_lnk">',
        (MODEL, '<link name="lidar_link"/>'),
        "write lidar_link",
    ),
    one(
        "gazebo-reference",
        MODEL,
        '<gazebo reference="lidar_link">',
        '<gazebo reference="lidar">',
        (MODEL, '<link name="lidar_link"/>'),
        "write lidar_link",
        name="without an ending",
    ),
    one(
        "gazebo-reference",
        MODEL,
        '<gazebo reference="lidar_link">',
        '<gazebo reference="scanner">',
        (MODEL, '<link name="lidar_link"/>'),
        "write lidar_link",
        name="by its frame",
    ),
    Mistake(
        "drive-sides",
        (
            (MODEL, ">left_wheel_joint</left_joint>", ">x</left_joint>"),
            (MODEL, ">right_wheel_joint<", ">left_wheel_joint<"),
            (MODEL, ">x<", ">right_wheel_joint<"),
        ),
        (MODEL, "<left_joint>right_wheel_joint<"),
        (MODEL, "<right_joint>left_wheel_joint<"),
        "exchange right_wheel_joint and left_wheel_joint",
    ),
    Mistake(
        "drive-sides",
        (
            (
                EKF,
                "",
                CONTROLLER.replace("left_wheel_joint", "x")
                .replace("right_wheel_joint", "left_wheel_joint")
                .replace('"x"', '"right_wheel_joint"'),
            ),
        ),
        (EKF, 'left_wheel_names: ["right_wheel_joint"]'),
        (EKF, 'right_wheel_names: ["left_wheel_joint"]'),
        "exchange right_wheel_joint and left_wheel_joint",
        name="of a controller",
    ),
    *(
        one(
            "gazebo-element-unknown",
            MODEL,
            f"<{right}>{value}</{right}>",
            f"<{wrong}>{value}</{wrong}>",
            (MODEL, f'<plugin filename="{plugin}'),
            f"write <{right}>",
            package=package,
            name=wrong,
        )
        for right, wrong, value, plugin, package in (
            ("wheel_separation", "wheel_seperation", 0.4, "gz-sim-diff-drive", "gz"),
            ("odom_topic", "odom_topc", "/demo/odom", "gz-sim-diff-drive", "gz"),
            (
                "wheel_diameter",
                "wheel_diametre",
                0.2,
                "libgazebo_ros_diff_drive.so",
                "classic",
            ),
        )
    ),
    one(
        "drive-wheel-separation",
        MODEL,
        SPLIT,
        "<wheel_separation>0.6<",
        (MODEL, '<joint name="${prefix}_joint" type="continuous">'),
        "write 0.36",
    ),
    one(
        "drive-wheel-radius",
        MODEL,
        RADIUS,
        "<wheel_radius>0.2<",
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.1",
    ),
    one(
        "drive-wheel-radius",
        MODEL,
        "<wheel_diameter>0.2<",
        "<wheel_diameter>0.1<",
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.2",
        package="classic",
        name="diameter",
    ),
    one(
        "frame-unknown",
        EKF,
        EKF_BASE,
        "base_link_frame: base_lnk",
        (MODEL, '<link name="base_link">'),
        "write base_link",
    ),
    one(
        "frame-unknown",
        NAV2,
        'base_frame_id: "base_footprint"',
        'base_frame_id: "base_footprnt"',
        (MODEL, '<link name="base_footprint"/>'),
        "write base_footprint",
        name="of amcl",
    ),
    one(
        "frame-unknown",
        MODEL,
        "<gz_frame_id>lidar_link<",
        "<gz_frame_id>laser_link<",
        (MODEL, '<link name="lidar_link"/>'),
        "write lidar_link",
        name="of a sensor",
        by_hand=True,
    ),
    one(
        "frame-unknown",
        MODEL,
        "<frame_name>lidar_link<",
        "<frame_name>lidar<",
        (MODEL, '<link name="lidar_link"/>'),
        "write lidar_link",
        package="classic",
        name="of a plugin",
        by_hand=True,
    ),
    one(
        "frame-unknown",
        MODEL,
        "<child_frame_id>base_link<",
        "<child_frame_id>base_lnk<",
        (MODEL, '<link name="base_link">'),
        "write base_link",
        name="of the drive",
    ),
    one(
        "frame-two-parents",
        EKF,
        EKF_BASE,
        "base_link_frame: base_footprint",
        (MODEL, '<joint name="base_joint" type="fixed">'),
        "write base_link",
    ),
    one(
        "frame-odom",
        NAV2,
        'odom_frame_id: "odom"',
        'odom_frame_id: "odometry"',
        (EKF, "odom_frame: odom"),
        "write odom",
    ),
    one(
        "ekf-world-frame",
        EKF,
        "odom_frame: odom",
        "odom_frame: odometry",
        (EKF, "world_frame: odom"),
        "write odom",
        name="of which the odom_frame is wrong",
    ),
    one(
        "frame-odom",
        NAV2,
        "      global_frame: odom",
        "      global_frame: odm",
        (EKF, "odom_frame: odom"),
        "write odom",
        name="of the local costmap",
    ),
    one(
        "frame-odom",
        MODEL,
        "<frame_id>odom<",
        "<frame_id>odometry<",
        (EKF, "odom_frame: odom"),
        "write odom",
        name="of the drive",
    ),
    one(
        "ekf-world-frame",
        EKF,
        "world_frame: odom",
        "world_frame: world",
        (EKF, "odom_frame: odom"),
        "write odom",
    ),
    Mistake(
        "ekf-two-d-mode",
        (
            (EKF, "two_d_mode: false", "two_d_mode: true"),
            (EKF, "", MAP_FILTER),
        ),
        (EKF, "two_d_mode: false"),
        (EKF, "two_d_mode: true"),
        "write two_d_mode: true",
    ),
    Mistake(
        "sensor-frame",
        ((MODEL, "      <gz_frame_id>lidar_link</gz_frame_id>\n", ""),),
        (MODEL, "<topic>scan</topic>"),
        (BRIDGE, 'gz_topic_name: "/scan"'),
        "add <gz_frame_id>lidar_link</gz_frame_id> to the sensor",
        fixed=(
            (
                MODEL,
                "<topic>scan</topic>",
                "<topic>scan</topic><gz_frame_id>lidar_link</gz_frame_id>",
            ),
        ),
    ),
    Mistake(
        "sensor-frame",
        ((MODEL, "      <gz_frame_id>imu_link</gz_frame_id>\n", ""),),
        (MODEL, "<topic>demo/imu</topic>"),
        (BRIDGE, 'gz_topic_name: "/demo/imu"'),
        "add <gz_frame_id>imu_link</gz_frame_id> to the sensor",
        fixed=(
            (
                MODEL,
                "<topic>demo/imu</topic>",
                "<topic>demo/imu</topic><gz_frame_id>imu_link</gz_frame_id>",
            ),
        ),
        name="of the imu",
    ),
    Mistake(
        "gazebo-joint",
        ((EKF, "", CONTROLLER.replace("left_wheel_joint", "left_whel_joint")),),
        (EKF, "left_wheel_names:"),
        (MODEL, '<joint name="${prefix}_joint" type="continuous">'),
        "write left_wheel_joint",
        name="of a controller",
    ),
    Mistake(
        "drive-wheel-radius",
        ((EKF, "", CONTROLLER.replace("0.1", "0.2")),),
        (EKF, "wheel_radius: 0.2"),
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.1",
        name="of a controller",
    ),
    Mistake(
        "frame-unknown",
        ((EKF, "", CONTROLLER.replace("base_link", "base_lnk")),),
        (EKF, "base_frame_id: base_lnk"),
        (MODEL, '<link name="base_link">'),
        "write base_link",
        name="of a controller",
    ),
    Mistake(
        "transform-twice",
        (
            (
                BRIDGE,
                "",
                '\n- ros_topic_name: "/tf"\n  gz_topic_name: "/tf"\n'
                '  ros_type_name: "tf2_msgs/msg/TFMessage"\n'
                '  gz_type_name: "gz.msgs.Pose_V"\n  direction: GZ_TO_ROS\n',
            ),
        ),
        (BRIDGE, '- ros_topic_name: "/tf"'),
        (EKF, "publish_tf: true"),
        "delete this entry",
    ),
    one(
        "transform-twice",
        MODEL,
        "<publish_odom_tf>false<",
        "<publish_odom_tf>true<",
        (EKF, "publish_tf: true"),
        "write false",
        package="classic",
        name="of Classic",
    ),
    one(
        "topic-unknown",
        EKF,
        "odom0: demo/odom",
        "odom0: odom",
        (BRIDGE, '- ros_topic_name: "/demo/odom"'),
        "write /demo/odom",
    ),
    one(
        "topic-unknown",
        EKF,
        "imu0: demo/imu",
        "imu0: imu/data",
        (BRIDGE, '- ros_topic_name: "/demo/imu"'),
        "write /demo/imu",
        name="below another name",
    ),
    one(
        "topic-unknown",
        EKF,
        "imu0: demo/imu",
        "imu0: demo/imu_data",
        (BRIDGE, '- ros_topic_name: "/demo/imu"'),
        "write /demo/imu",
        name="of the imu",
    ),
    one(
        "topic-unknown",
        EKF,
        "imu0: demo/imu",
        "imu0: imu",
        (MODEL, "<remapping>~/out:=imu</remapping>"),
        "write /demo/imu",
        package="classic",
        name="of Classic",
    ),
    one(
        "topic-unknown",
        NAV2,
        "odom_topic: /demo/odom",
        "odom_topic: /odom",
        (BRIDGE, '- ros_topic_name: "/demo/odom"'),
        "write /demo/odom",
        name="of Nav2",
    ),
    one(
        "topic-unknown",
        NAV2,
        "topic: /scan\n",
        "topic: /demo/scan\n",
        (MODEL, "<remapping>~/out:=scan</remapping>"),
        "write /scan",
        package="classic",
        name="of a costmap",
    ),
    one(
        "bridge-topic",
        BRIDGE,
        'gz_topic_name: "/scan"',
        'gz_topic_name: "/lidar/scan"',
        (MODEL, "<topic>scan</topic>"),
        "write /scan",
    ),
    one(
        "bridge-topic",
        BRIDGE,
        'gz_topic_name: "/demo/cmd_vel"',
        'gz_topic_name: "/cmd_vel"',
        (MODEL, "<topic>/demo/cmd_vel</topic>"),
        "write /demo/cmd_vel",
        name="of the velocity",
    ),
    one(
        "bridge-types",
        BRIDGE,
        'gz_type_name: "gz.msgs.IMU"',
        'gz_type_name: "gz.msgs.Odometry"',
        (BRIDGE, 'ros_type_name: "sensor_msgs/msg/Imu"'),
        "write gz.msgs.IMU",
    ),
    one(
        "bridge-types",
        BRIDGE,
        'ros_type_name: "sensor_msgs/msg/LaserScan"',
        'ros_type_name: "sensor_msgs/msg/PointCloud2"',
        (BRIDGE, 'gz_type_name: "gz.msgs.LaserScan"'),
        "write sensor_msgs/msg/LaserScan",
        name="of the lidar",
    ),
    Mistake(
        "bridge-types",
        (
            (BRIDGE, "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"),
            (BRIDGE, "gz.msgs.LaserScan", "gz.msgs.PointCloudPacked"),
        ),
        (BRIDGE, "gz.msgs.PointCloudPacked"),
        (MODEL, "<topic>scan</topic>"),
        "write gz.msgs.LaserScan, and sensor_msgs/msg/LaserScan in ROS",
        name="that the sensor does not send",
    ),
    Mistake(
        "bridge-types",
        (
            (BRIDGE, "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"),
            (MODEL, 'type="gpu_lidar"', 'type="custom"'),
        ),
        (BRIDGE, "sensor_msgs/msg/PointCloud2"),
        (BRIDGE, 'gz_type_name: "gz.msgs.LaserScan"'),
        "write sensor_msgs/msg/LaserScan",
        name="of the reader",
    ),
    *(
        one(
            "bridge-type-unknown",
            BRIDGE,
            right,
            wrong,
            (BRIDGE, other),
            f"write {right}",
            name=wrong,
        )
        for right, wrong, other in (
            ("gz.msgs.LaserScan", "gz.msgs.LaserScam", '- ros_topic_name: "/scan"'),
            ("gz.msgs.IMU", "gz.msgs.Imu", '- ros_topic_name: "/demo/imu"'),
            ("gz.msgs.Clock", "gz.msg.Clock", '- ros_topic_name: "/clock"'),
            (
                "sensor_msgs/msg/LaserScan",
                "sensor_msgs/LaserScan",
                '- ros_topic_name: "/scan"',
            ),
            (
                "sensor_msgs/msg/LaserScan",
                "sensor_msg/msg/LaserScan",
                '- ros_topic_name: "/scan"',
            ),
            (
                "nav_msgs/msg/Odometry",
                "nav_msgs/msg/Odometery",
                '- ros_topic_name: "/demo/odom"',
            ),
        )
    ),
    Mistake(
        "bridge-direction",
        ((BRIDGE, "direction: ROS_TO_GZ", "direction:  GZ_TO_ROS"),),
        (BRIDGE, "direction:  GZ_TO_ROS"),
        (MODEL, "<topic>/demo/cmd_vel</topic>"),
        "write direction: ROS_TO_GZ",
    ),
    one(
        "sim-time-off",
        LAUNCH,
        'os.path.join(share, "config/ekf.yaml"),\n            {"use_sim_time": '
        "use_sim_time},",
        'os.path.join(share, "config/ekf.yaml"),\n            {"use_sim_time": False},',
        (LAUNCH, 'ExecuteProcess(cmd=["gz", "sim", "-g"]),'),
        "write True",
        better='os.path.join(share, "config/ekf.yaml"),\n            '
        '{"use_sim_time": True},',
        by_hand=True,
    ),
    Mistake(
        "sim-time-off",
        ((LAUNCH, 'default_value="True"', 'default_value="False"'),),
        (LAUNCH, '{"use_sim_time": use_sim_time},'),
        (LAUNCH, 'ExecuteProcess(cmd=["gazebo", "-s", "libgazebo_ros_factory.so"]),'),
        "write True",
        fixed=((LAUNCH, 'default_value="False"', 'default_value="True"'),),
        package="classic",
        count=2,
        name="by default",
    ),
    one(
        "gazebo-element",
        MODEL,
        RADIUS + "/wheel_radius>",
        "<wheel_diameter>0.2</wheel_diameter>",
        (MODEL, '<plugin filename="gz-sim-diff-drive-system" name='),
        "write <wheel_radius>, with half of it",
        better="<wheel_radius>0.1</wheel_radius>",
        by_hand=True,
    ),
    Mistake(
        "gazebo-generation",
        (
            (
                LAUNCH,
                'cmd=["gazebo", "-s", "libgazebo_ros_factory.so"]',
                'cmd=["gz", "sim"]',
            ),
            (LAUNCH, 'package="gazebo_ros"', 'package="ros_gz_sim"'),
            (LAUNCH, 'executable="spawn_entity.py"', 'executable="create"'),
            (LAUNCH, '"-entity"', '"-name"'),
        ),
        (MODEL, '<plugin filename="libgazebo_ros_imu_sensor.so" name="imu_plugin">'),
        (LAUNCH, 'ExecuteProcess(cmd=["gz", "sim"]),'),
        'write filename="gz-sim-imu-system" name="gz::sim::systems::Imu"',
        fixed=(
            (
                MODEL,
                'filename="libgazebo_ros_imu_sensor.so" name="imu_plugin"',
                'filename="gz-sim-imu-system" name="gz::sim::systems::Imu"',
            ),
        ),
        package="classic",
    ),
    Mistake(
        "gazebo-both",
        (
            (
                LAUNCH,
                "GzServer(world_sdf_file=world),",
                'Node(package="gazebo_ros", executable="spawn_entity.py"),',
            ),
        ),
        (LAUNCH, 'Node(package="gazebo_ros", executable="spawn_entity.py"),'),
        (LAUNCH, "bridge = RosGzBridge("),
        "write package='ros_gz_sim' and executable='create'",
    ),
    one(
        "launch-xacro-py",
        LAUNCH,
        'Command(["xacro ", model])',
        'Command(["xacro.py ", model])',
        ("package.xml", "<build_type>ament_cmake</build_type>"),
        "write xacro",
        package="classic",
    ),
    one(
        "launch-file-missing",
        LAUNCH,
        'os.path.join(share, "rviz", "cart.rviz")',
        'os.path.join(share, "rviz", "urdf_config.rviz")',
        ("rviz/cart.rviz", ""),
        "write rviz/cart.rviz",
    ),
    one(
        "launch-file-missing",
        LAUNCH,
        'os.path.join(share, "config/ekf.yaml")',
        'os.path.join(share, "params/ekf.yaml")',
        (EKF, ""),
        "write config/ekf.yaml",
        package="classic",
        name="folder",
    ),
    Mistake(
        "launch-parameters-unread",
        ((LAUNCH, 'name="ekf_filter_node"', 'name="ekf_filter_node_odom"'),),
        (LAUNCH, 'os.path.join(share, "config/ekf.yaml"),'),
        (EKF, "frequency: 30.0"),
        "write name='ekf_filter_node'",
    ),
    one(
        "launch-world-name",
        LAUNCH,
        '"world": "room"',
        '"world": "my_world"',
        ("world/room.sdf", '<world name="room">'),
        "write room",
    ),
    *(
        Mistake(
            "launch-world-name",
            (
                (
                    LAUNCH,
                    "            spawn,",
                    "            spawn,\n"
                    '            Node(package="ros_gz_sim", executable="create",\n'
                    f"            {given}),",
                ),
            ),
            (LAUNCH, given),
            ("world/room.sdf", '<world name="room">'),
            "write room",
            name=name,
        )
        for name, given in (
            ("of create", 'arguments=["-world", "my_world", "-name", "cart"]'),
            ("of its parameters", 'parameters=[{"world": "my_world"}]'),
        )
    ),
    one(
        "cmake-project-name",
        "CMakeLists.txt",
        "project(cart_description)",
        "project(cart)",
        ("package.xml", "<name>cart_description</name>"),
        "write project(cart_description)",
    ),
    Mistake(
        "cmake-project-name",
        (("package.xml", "<name>cart_description<", "<name>cart<"),),
        ("package.xml", "<name>cart</name>"),
        (CMAKE, "project(cart_description)"),
        "write <name>cart_description</name>",
        name="in the manifest",
    ),
    *(
        Mistake(
            "cmake-unclosed",
            ((CMAKE, old, new),),
            (CMAKE, at),
            ("", ""),
            advice,
            name=name,
        )
        for name, old, new, at, advice, _ in (
            (
                "project",
                "project(cart_description)",
                "project(cart_description",
                "project(",
                "write project(cart_description)",
                "",
            ),
            (
                "install",
                "share/${PROJECT_NAME}\n)",
                "share/${PROJECT_NAME}\n",
                "install(",
                "write share/${PROJECT_NAME}) in line 8",
                "share/${PROJECT_NAME})\n",
            ),
            (
                "last command",
                "ament_package()",
                "ament_package(",
                "ament_package(",
                "write ament_package()",
                "",
            ),
            (
                "quotation mark",
                "DIRECTORY urdf launch",
                'DIRECTORY "urdf launch',
                "DIRECTORY",
                'write "urdf"',
                'DIRECTORY "urdf" launch',
            ),
            (
                "closed twice",
                "world\n  DESTINATION share/${PROJECT_NAME}\n)",
                "world)\n  DESTINATION share/${PROJECT_NAME}\n)  # end",
                "# end",
                "write world without the ) after it in line 7",
                "world\n  DESTINATION share/${PROJECT_NAME}\n)  # end",
            ),
            ("stray", "REQUIRED)", "REQUIRED))", "find_package", "delete it", ""),
        )
    ),
    *(
        one(
            "install-folder-missing",
            CMAKE,
            "DIRECTORY urdf launch rviz config world",
            f"DIRECTORY {folders}",
            ("", ""),
            f"write {right}",
            name=f"for {right}",
        )
        for folders, right in (
            ("urdf lanch rviz config world", "launch"),
            ("URDF launch rviz config world", "urdf"),
            ("urdf launch rviz conf world", "config"),
            ("urdf launch rviz config worlds", "world"),
        )
    ),
    one(
        "install-folder-missing",
        CMAKE,
        "config world",
        "config world plans",
        ("", ""),
        "delete plans here, or make that folder",
        name="with no near one",
        by_hand=True,
    ),
    *(
        Mistake(
            "install-destination",
            ((CMAKE, "share/${PROJECT_NAME}", target),),
            (CMAKE, f"DESTINATION {target}"),
            (LAUNCH, "import os"),
            "write share/${PROJECT_NAME}",
            name=target,
        )
        for target in (
            "share/${PROJECT_NAM}",
            "share/{PROJECT_NAME}",
            "share/$(PROJECT_NAME)",
            "share/${project_name}",
            "share",
            "lib/${PROJECT_NAME}",
            "${PROJECT_NAME}",
            "share/cart",
            "/usr/share",
        )
    ),
    Mistake(
        "install-destination",
        (
            (CMAKE, "config world", "config"),
            (
                CMAKE,
                "ament_package()",
                "install(FILES world/room.sdf\n"
                "  DESTINATION share/${PROJECT_NAME}/world)\n"
                "install(DIRECTORY config/\n  DESTINATION lib/${PROJECT_NAME}/config)\n"
                "ament_package()",
            ),
            (CMAKE, "rviz config", "rviz"),
        ),
        (CMAKE, "DESTINATION lib"),
        (LAUNCH, 'os.path.join(share, "config/ekf.yaml"),'),
        "write share/${PROJECT_NAME}/config",
        name="below the package",
    ),
    Mistake(
        "folder-not-installed",
        (("CMakeLists.txt", "launch rviz config world", "launch rviz world"),),
        ("CMakeLists.txt", "ament_package()"),
        (LAUNCH, 'os.path.join(share, "config/ekf.yaml"),'),
        "add install(DIRECTORY config DESTINATION share/${PROJECT_NAME})",
    ),
    Mistake(
        "folder-not-installed",
        (("CMakeLists.txt", "launch rviz config", "rviz config"),),
        ("CMakeLists.txt", "ament_package()"),
        (LAUNCH, "import os"),
        "add install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})",
        name="launch",
    ),
    one(
        "footprint-size",
        NAV2,
        "robot_radius: 0.3",
        "robot_radius: 0.22",
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.3",
        by_hand=True,
    ),
    one(
        "footprint-size",
        NAV2,
        '"[ [0.21, 0.195], [0.21, -0.195], [-0.21, -0.195], [-0.21, 0.195] ]"',
        '"[ [0.1, 0.1], [0.1, -0.1], [-0.1, -0.1], [-0.1, 0.1] ]"',
        (MODEL, '<link name="${prefix}_link">'),
        'write "[ [0.21, 0.2], [0.21, -0.2], [-0.22, -0.2], [-0.22, 0.2] ]"',
        name="polygon",
        by_hand=True,
    ),
    one(
        "footprint-size",
        NAV2,
        "robot_radius: 0.3",
        "robot_radius: 30.0",
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.3",
        name="in centimetres",
        by_hand=True,
    ),
    one(
        "footprint-size",
        NAV2,
        "robot_radius: 0.3",
        "robot_radius: 0.6",
        (MODEL, '<link name="${prefix}_link">'),
        "write 0.3",
        name="twice as large",
        by_hand=True,
    ),
]


def names() -> Iterator[str]:
    for mistake in MISTAKES:
        yield f"{mistake.code} {mistake.name}".strip().replace(" ", "-")


def apply(folder: Path, edits: Iterable[Edit]) -> None:
    for name, old, new in edits:
        file = folder / name
        text = file.read_text()
        assert old in text, (name, old)
        file.write_text(text.replace(old, new, 1) if old else text + new)


def line_of(file: Path, text: str) -> int:
    """The first line that ends or begins with a text; 0 when the text is empty."""
    lines = file.read_text().splitlines()
    return next((n for n, line in enumerate(lines, 1) if text and text in line), 0)


def found(folder: Path) -> list[Problem]:
    return check(folder / MODEL)


@pytest.mark.parametrize("name", ["gz", "classic"])
def test_a_correct_package_has_no_findings(name: str, copied: Copied) -> None:
    assert found(copied(name)) == []


@pytest.mark.parametrize("mistake", MISTAKES, ids=names())
def test_a_mistake_is_found_at_both_places_and_its_fix_leaves_nothing(
    mistake: Mistake, copied: Copied
) -> None:
    package = copied(mistake.package)
    apply(package, mistake.made)
    problems = found(package)
    assert [p.code for p in problems] == [mistake.code] * mistake.count
    problem = problems[0]
    file, text = mistake.at
    assert problem.file == str(package / file)
    assert problem.line == line_of(package / file, text)
    file, text = mistake.other
    line = line_of(package / file, text) if file else 0
    same = problem.file == str(package / file)
    name = f"line {line}" if same else f"{Path(file).name} line {line}"
    if line == 1 and not same:
        # A launch file uses itself as a whole.
        name = Path(file).name
    assert (name if line else file) in problem.message
    assert mistake.advice in problem.hint
    edits = [edit for problem in problems for edit in problem.edits]
    assert bool(edits) != bool(mistake.fixed)
    apply(package, mistake.fixed)
    for name, data in edited_files(edits).items():
        Path(name).write_bytes(data)
    assert found(package) == []


@pytest.mark.parametrize("odom", ["odom", "wheel_odom"])
def test_the_frame_that_odometry_moves_the_base_from_has_its_name(
    copied: Copied, odom: str
) -> None:
    folder = copied("gz")
    ekf = folder / EKF
    text = ekf.read_text().replace("_frame: odom", f"_frame: {odom}")
    ekf.write_text(text.replace(EKF_BASE, "base_link_frame: base_footprint"))

    (problem,) = (p for p in check(folder / MODEL) if p.code == "frame-two-parents")

    assert (
        f"ekf_filter_node publishes the transform from {odom} to base_footprint"
        in problem.message
    )
