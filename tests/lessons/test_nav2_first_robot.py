"""The lesson that ships: hidden solutions, right and wrong, in both tracks."""

from __future__ import annotations

import fnmatch
import shutil
from pathlib import Path

import pytest
from lesson_files import record_run
from problem_samples import all_samples

import sambot_viz
from sambot_viz.lessons.conditions.files import NoProblemCondition
from sambot_viz.lessons.evaluation import faults_of, messages
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.read_lesson import lesson_names, open_lesson
from sambot_viz.lessons.student_files import handed_in
from sambot_viz.lessons.work import Work

SOLUTION = Path(__file__).parents[1] / "data" / "lessons" / "nav2-first-robot"
MODEL = "src/description/sam_bot_description"

WRONG = [
    ("transform", "launch/laser.launch.py", '"0.2"', '"0.02"', "at 0.1 0 0.02"),
    (
        "transform",
        "launch/laser.launch.py",
        '"base_link", "base_laser"',
        '"base_laser", "base_link"',
        "the transform is from base_laser to base_link",
    ),
    ("transform", "launch/laser.launch.py", '"0.2", "0"', '"0.2", "90"', "degrees"),
    ("file", MODEL, 'name="sam_bot"', 'name="sambot"', "the robot is called 'sambot'"),
    (
        "body",
        MODEL,
        "${base_length} ${base_width} ${base_height}",
        "${base_width} ${base_length} ${base_height}",
        "is a box of 0.31 0.42 0.18; expected: a box of 0.42 0.31 0.18",
    ),
    (
        "body",
        MODEL,
        "${base_length}",
        "0.42",
        "the property base_length is not used",
    ),
    ("footprint-link", MODEL, 'value="-0.15"', 'value="0.15"', "300 mm off"),
    ("wheels", MODEL, 'y_reflect="-1"', 'y_reflect="1"', "360 mm off"),
    ("wheels", MODEL, 'prefix="drivewhl_r"', 'prefix="drivewhl_l"', "must be unique"),
    ("wheel-shape", MODEL, "${pi/2} 0 0", "0 0 0", "is along 0 0 1"),
    ("ground", MODEL, "${caster_z-ground}", "0.05", "ends 10 mm above base_footprint"),
    ("package", "package.xml", "sam_bot_description", "sam_bot", "sam_bot_description"),
    ("package", "launch/display.launch.py", '"rviz"', '"rvis"', "rvis"),
    ("package", "CMakeLists.txt", "src launch", "launch", "src"),
    ("see-it", "rviz/config.rviz", "Frame: base_link", "Frame: base_lnk", "base_lnk"),
    ("inertia", MODEL, "2/5*m", "2/3*m", "the moments of inertia are"),
    (
        "inertia",
        MODEL,
        'm="15"',
        'm="1.5"',
        "is 1.5 kg; expected: 15 kg at base_footprint",
    ),
    ("imu", MODEL, "0 0 0.01", "0 0 0.1", "90 mm off"),
    ("imu", MODEL, "<update_rate>100<", "<update_rate>10<", "the rate of the sensor"),
    ("drive", MODEL, ">drivewhl_l_joint<", ">drivewhl_joint<", "is drivewhl_joint"),
    (
        "bridge",
        "config/bridge_config.yaml",
        "/msg/Odometry",
        "/msg/Odom",
        "is nav_msgs",
    ),
    ("bridge", "config/bridge_config.yaml", "ROS_TO_GZ", "GZ_TO_ROS", "direction"),
    ("filter", "config/ekf.yaml", "odom0: demo/odom", "odom0: odm", "odom0 of"),
    (
        "filter",
        "config/ekf.yaml",
        "publish_tf: true",
        "publish_tf: false",
        "publish_tf",
    ),
    ("lidar", MODEL, "<samples>360<", "<samples>36<", "is 36; expected: 360"),
    (
        "lidar",
        "config/bridge_config.yaml",
        "ros_topic_name: /scan",
        "ros_topic_name: /s",
        "/scan",
    ),
    (
        "camera",
        MODEL,
        "0.215 0 0.05",
        "0.05 0 0.215",
        "camera_link, seen from base_link",
    ),
    (
        "costmaps",
        "config/nav2_params.yaml",
        "resolution: 0.05",
        "resolution: 0.5",
        "0.5",
    ),
    ("costmaps", "config/nav2_params.yaml", "topic: /scan", "topic: /lidar", "/lidar"),
    (
        "footprint",
        "config/nav2_params.yaml",
        "radius: 0.3",
        "radius: 0.2",
        "at least 0.29",
    ),
    (
        "planner",
        "config/nav2_params.yaml",
        "dwb_core::",
        "dwb::",
        "dwb::DWBLocalPlanner",
    ),
    ("planner", "config/nav2_params.yaml", '["GridBased"]', '["Grid"]', "is Grid"),
]
"""Step, file, a text in it, what a student writes, and words of the verdict."""


@pytest.fixture(scope="session")
def lesson() -> Lesson:
    return open_lesson("nav2-first-robot")


@pytest.fixture(scope="session")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recordings")
    record_run(folder)
    return folder


@pytest.fixture(params=["urdf", "sdf"])
def package(request: pytest.FixtureRequest, tmp_path: Path, recordings: Path) -> Path:
    """The solution as a student of one track has it."""
    folder = tmp_path / "sam_bot_description"
    shutil.copytree(SOLUTION / "sam_bot_description", folder)
    other = "sdf" if request.param == "urdf" else "urdf"
    (folder / f"{MODEL}.{other}").unlink()
    launch = folder / "launch" / "display.launch.py"
    launch.write_text(
        launch.read_text().replace("description.urdf", f"description.{request.param}")
    )
    shutil.copytree(recordings, folder / "recordings")
    return folder


def verdict(lesson: Lesson, package: Path, step: str) -> list[str]:
    given = handed_in(lesson, package)
    work = Work(given.model, given.folder, trusted=False)
    return [f.message for f in faults_of(lesson.step(step), work, given.track)]


def test_the_solution_passes_every_step(lesson: Lesson, package: Path) -> None:
    assert {
        step.name: verdict(lesson, package, step.name) for step in lesson.steps
    } == {step.name: [] for step in lesson.steps}


def test_an_empty_folder_fails_every_step(lesson: Lesson, tmp_path: Path) -> None:
    passed = [s.name for s in lesson.steps if not verdict(lesson, tmp_path, s.name)]
    assert passed == []


@pytest.mark.parametrize(("step", "file", "right", "wrong", "said"), WRONG)
def test_a_wrong_solution_is_found_in_its_step(
    lesson: Lesson,
    package: Path,
    step: str,
    file: str,
    right: str,
    wrong: str,
    said: str,
) -> None:
    path = package / file
    if file == MODEL:
        path = next(path.parent.glob(f"{path.name}.*"))
    text = path.read_text("utf-8")
    assert right in text
    path.write_text(text.replace(right, wrong), "utf-8")

    assert said in "\n".join(verdict(lesson, package, step))


def test_a_file_without_the_namespace_of_xacro_is_no_begin(
    lesson: Lesson, tmp_path: Path
) -> None:
    model = tmp_path / f"{MODEL}.urdf"
    model.parent.mkdir(parents=True)
    text = '<robot name="sam_bot"{}><link name="base_link"/></robot>'
    model.write_text(text.format(""))
    (said,) = verdict(lesson, tmp_path, "file")
    assert said.endswith("expected: the namespace of xacro")
    model.write_text(text.format(' xmlns:xacro="http://ros.org/wiki/xacro"'))
    assert verdict(lesson, tmp_path, "file") == []


def test_every_code_that_a_condition_names_exists() -> None:
    known = {sample.code for sample in all_samples()}
    asked = {
        code
        for name in lesson_names()
        for step in open_lesson(name).steps
        for demand in step.conditions
        for condition in demand.conditions
        if isinstance(condition, NoProblemCondition)
        for code in condition.code
    }
    assert asked
    assert {code for code in asked if not fnmatch.filter(known, code)} == set()


@pytest.mark.parametrize("name", ["sam_bot_repository.sdf", "sam_bot_all_chapters.sdf"])
def test_the_robots_of_the_guide_pass_the_steps_about_the_model(
    lesson: Lesson, shared: Path, name: str
) -> None:
    model = shared / "data" / "sdf" / "tutorial" / name
    steps = "body footprint-link wheels wheel-shape ground collision inertia imu drive"
    work = Work(model, trusted=False)
    faults = {s: faults_of(lesson.step(s), work, "sdf") for s in steps.split()}
    assert {step for step, found in faults.items() if found} == set()


@pytest.mark.parametrize("name", ["base-cmake", "base-python"])
def test_a_package_of_the_guide_passes_all_that_files_show(
    lesson: Lesson, shared: Path, name: str
) -> None:
    package = shared / "data" / "mistakes" / name
    said, _ = messages(lesson, handed_in(lesson, package), lesson.steps)
    pairs = zip(lesson.steps, said, strict=True)
    failed = [step.name for step, message in pairs if message]
    assert failed == ["transform", "odometry", "go"]


def test_the_public_name_grades_this_lesson(package: Path) -> None:
    found = sambot_viz.grade(package)
    assert found.passed
    assert (found.lesson, found.score) == ("nav2-first-robot", found.max_score)


def test_a_slow_robot_and_a_goal_that_is_not_reached_are_found(
    lesson: Lesson, package: Path
) -> None:
    record_run(package / "recordings", rate=5, codes=(2, 6))
    assert (
        "/demo/odom comes 5 times a second" in verdict(lesson, package, "odometry")[0]
    )
    assert "a goal was reached: none" in verdict(lesson, package, "go")[0]
