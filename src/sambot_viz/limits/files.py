"""Limits of the files of robots and configs."""

from __future__ import annotations

from sambot_viz.limits.row import LimitRow

MODEL = LimitRow(
    "a URDF, SDF or xacro file",
    64_000_000,
    "bytes",
    "it is refused, with an error",
)
CONFIG = LimitRow(
    "an .rviz file",
    4_000_000,
    "bytes",
    "it is refused, with an error",
)
XML_ELEMENTS = LimitRow(
    "elements of a URDF or SDF file",
    2_000_000,
    "",
    "it is refused, with an error",
)
XML_DEPTH = LimitRow(
    "elements in elements of a URDF or SDF file",
    10_000,
    "",
    "it is refused, with an error",
)
XML_EXPLAINED = LimitRow(
    "an XML file with an error",
    1_000_000,
    "characters",
    "the error is the one of the parser, without a cause",
)
XACRO_TIME = LimitRow(
    "the expansion of a xacro file",
    20,
    "seconds",
    "it is stopped, with an error",
)
XACRO_MEMORY = LimitRow(
    "memory of the expansion of a xacro file",
    1024,
    "MB",
    "it is stopped, with an error",
)
XACRO_OUTPUT = LimitRow(
    "what a xacro file expands to",
    64_000_000,
    "characters",
    "it is refused, with an error",
)
XACRO_TEXT = LimitRow(
    "a repeated text or list of an untrusted xacro file",
    1_000_000,
    "",
    "it is refused, with an error",
)
XACRO_BITS = LimitRow(
    "a power in an untrusted xacro file",
    4096,
    "bits",
    "it is refused, with an error",
)
XACRO_SOURCE = LimitRow(
    "a xacro file in which the cause of an error is looked for",
    4_000_000,
    "bytes",
    "the error has no cause",
)
XACRO_NEIGHBOURS = LimitRow(
    "xacro files beside a model in which a missing macro is looked for",
    200,
    "",
    "the others are not read",
)
CHAIN = LimitRow(
    "links of a chain of joints",
    350,
    "",
    "the view may stay empty; Problems says so",
)
NESTED_MODELS = LimitRow(
    "models in models of an SDF file",
    100,
    "",
    "inner ones are left out, with a warning",
)
SLIPS = LimitRow(
    "misspelt words of a model",
    1000,
    "",
    "the first ones are reported",
)
WHEELS = LimitRow(
    "wheels among which the driven pair is guessed",
    40,
    "",
    "Drive says that there are too many",
)
SEARCHED_FOLDERS = LimitRow(
    "folders that are searched for packages",
    3000,
    "",
    "packages in the others are not found, with an error",
)
SEARCHED_DEPTH = LimitRow(
    "folders in folders that are searched for packages",
    6,
    "",
    "packages in deeper ones are not found, with an error",
)
NEAR_FOLDERS = LimitRow(
    "folders of a package that are searched for a file of that name",
    2000,
    "",
    "the error has no advice",
)
MODEL_FOLDERS = LimitRow(
    "folders of a package that are searched for its model",
    500,
    "",
    "models in the others are not found, with an error",
)
MODEL_DEPTH = LimitRow(
    "folders in folders of a package that are searched for its model",
    7,
    "",
    "models in deeper ones are not found, with an error",
)
WATCHED_FOLDERS = LimitRow(
    "folders of a package that are watched for a missing file",
    200,
    "",
    "after a change there, save the model to read it again",
)
PACKAGE_FILES = LimitRow(
    "files of a package that are checked with its model",
    5000,
    "",
    "less is checked",
)
PACKAGE_FOLDERS = LimitRow(
    "folders of a package that are checked with its model",
    400,
    "",
    "less is checked",
)
PACKAGE_DEPTH = LimitRow(
    "folders in folders of a package that are checked with its model",
    5,
    "",
    "less is checked",
)
PACKAGE_TEXT = LimitRow(
    "a launch file, config or source file of a package that is checked",
    400_000,
    "bytes",
    "less is checked",
)
BUILD_FILE = LimitRow(
    "a CMakeLists.txt, package.xml or footprint that is checked",
    20_000,
    "characters",
    "less is checked",
)
YAML_VALUES = LimitRow(
    "values of a parameter file",
    20_000,
    "",
    "less is checked",
)
YAML_DEPTH = LimitRow(
    "maps in maps of a parameter file",
    20,
    "",
    "less is checked",
)
YAML_REPAIRED = LimitRow(
    "a parameter file with an error",
    50_000,
    "characters",
    "the error has no repair",
)
FIXED_FILE = LimitRow(
    "a file whose text a fix replaces",
    5_000_000,
    "bytes",
    "what is wrong in it has a hint without an edit",
)
LAUNCH_VALUE = LimitRow(
    "a value that a launch file computes",
    4096,
    "characters",
    "less is checked",
)
LAUNCH_STEPS = LimitRow(
    "steps that the launch files of a check are followed",
    20_000,
    "",
    "less is checked",
)
CHECKED_MESH = LimitRow(
    "a mesh file that is checked with a model",
    60_000_000,
    "bytes",
    "a finding says that it was not checked",
)
CHECKED_TIME = LimitRow(
    "reading the meshes that are checked with a model",
    10,
    "seconds",
    "a finding says how many were not checked",
)
CONFIG_DEPTH = LimitRow(
    "maps in maps of an .rviz file",
    200,
    "",
    "it is refused, with an error",
)
CONFIG_VALUES = LimitRow(
    "names and values of an .rviz file",
    50_000,
    "",
    "it is refused, with an error",
)
PATTERN = LimitRow(
    "a regular expression of a display",
    1000,
    "characters",
    "it filters nothing; the config's problems say so, and a page does not take it",
)
POSES_FILE = LimitRow(
    "a file of poses of the joints",
    1_000_000,
    "bytes",
    "it is not read; the page says so",
)
JOINTS_FILE = LimitRow(
    "a file of positions of the joints",
    50_000_000,
    "bytes",
    "it is refused, with an error",
)
LESSON = LimitRow(
    "a lesson.yaml, and a file with the progress of a student",
    1_000_000,
    "bytes",
    "it is refused, with an error; a student begins again",
)
LESSON_PICTURE = LimitRow(
    "a picture of a lesson",
    1_000_000,
    "bytes",
    "the page shows what it is in words",
)
STUDENT_FILES = LimitRow(
    "files and folders of a student that are followed",
    2000,
    "",
    "a save of the others is seen with the button Check",
)
GRADE_TIME = LimitRow(
    "grading what a student has written",
    60,
    "seconds",
    "it is stopped; every step has failed and says so",
)
GRADE_MEMORY = LimitRow(
    "memory of grading what a student has written",
    2048,
    "MB",
    "it is stopped; every step has failed and says so",
)
NUMBER = LimitRow(
    "a number of a model, and a position of a joint",
    10**18,
    "",
    "it is drawn as this one, and Problems says so; a position is refused",
)
