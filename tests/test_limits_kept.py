"""What is just above a limit is refused with a sentence that has it, and no less is.

Each case makes what holds so much of what a row counts, and returns what is said of it.
"""

from __future__ import annotations

import re
from pathlib import Path

import data_limits
import file_limits
import pytest
from docs_parts import limits_page
from lower_limit import lower

from sambot_viz import limits

CASES = {**file_limits.CASES, **data_limits.CASES}
FEW = {"MODEL": 200, "CONFIG": 200, "MESH": 1000, "TEXTURE": 2000, "POSES_FILE": 100}
FEW |= {"JOINTS_FILE": 100, "DEFINITION": 100, "DEFINITION_RECORD": 217}
FEW |= {"BAG_HEADER": 217, "CHECKED_MESH": 284, "MESH_CUTTING": 1016, "PLY_HEADER": 217}
FEW |= {"MODEL_DEPTH": 3, "SEARCHED_DEPTH": 3}
ELSEWHERE = {
    "CHECKED_TIME": "checks/test_rules.py::"
    "test_meshes_that_take_too_long_are_named_and_not_read",
    "CONFIG_DEPTH": "rviz/yaml/test_explain_yaml.py::"
    "test_aliases_that_nest_each_other_too_deeply_are_refused",
    "FIELDS_MESSAGE": "messages/test_foreign_encodings.py::"
    "test_a_message_above_the_limit_is_not_decoded",
    "FLAT_SHARED": "messages/test_foreign_encodings.py::"
    "test_parts_that_are_shared_do_not_make_a_message_endless",
    "MARKER_POINTS": "displays/data/test_hostile_sizes.py::"
    "test_a_marker_with_too_many_points_is_not_drawn",
    "MATERIALS": "meshes/test_named_files.py::"
    "test_files_that_meshes_name_are_not_read_when_they_are_too_large",
    "MESH_DEPTH": "meshes/test_read_mesh.py::"
    "test_a_collada_file_that_is_nested_too_deep_is_refused_clearly",
    "MESH_NAMES": "meshes/test_gltf.py::"
    "test_a_thousand_equal_names_take_no_time_and_a_hostile_choice_is_refused",
    "POSE_NAME": "panels/test_poses.py::test_a_pose_needs_a_name_that_is_not_too_long",
    "SESSION_WAITING": "server/test_live_robot.py::"
    "test_what_waits_for_a_session_is_limited_in_bytes",
    "XACRO_MEMORY": "robot/xacro/test_child_process.py::"
    "test_every_limit_ends_the_child_and_collects_it",
    "XACRO_OUTPUT": "robot/xacro/test_child_process.py::"
    "test_every_limit_ends_the_child_and_collects_it",
    **dict.fromkeys(
        ("NEAR_FOLDERS", "XACRO_SOURCE", "XML_EXPLAINED", "YAML_REPAIRED"),
        "test_limits_of_advice.py::"
        "test_just_above_a_limit_of_advice_the_error_is_there_without_it",
    ),
    "XACRO_TIME": "robot/xacro/test_expand.py::"
    "test_an_expansion_that_takes_too_long_is_ended",
}
"""Rows whose test has no need to lower them."""
SAID = re.compile(r"\b(?:says?|said|error|refused|finding)\b")
AS_THEY_ARE = {"XACRO_TEXT", "XACRO_BITS", "NUMBER"}
OF_A_PROPERTY = {"PATHS", "RANGE_CONES", "STAMPED_POINTS", "VECTORS"}
"""xacro runs in a process of its own; the others are read when the program starts."""


@pytest.mark.parametrize("name", CASES)
def test_just_above_a_limit_is_said_with_it_and_just_below_is_taken(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = FEW.get(name, 20)
    if name in AS_THEY_ARE | OF_A_PROPERTY:
        most = getattr(limits, name).value
    lower(monkeypatch, name, most)
    figure = f"{most:g}" if name == "NUMBER" else f"{most:,}"
    if name in OF_A_PROPERTY:
        # As it stands in the file.
        figure = f"{most}"
    below, above = (CASES[name](most + more, tmp_path) for more in (0, 1))
    # The folder of the test has a number too.
    assert figure not in below.replace(str(tmp_path), "")
    assert figure in above.replace(str(tmp_path), "")


def test_every_row_that_is_said_has_a_case_or_a_test_that_lowers_it() -> None:
    tests = Path(__file__).parent.rglob("test_*.py")
    own = Path(__file__).name
    text = "".join(p.read_text("utf-8") for p in tests if p.name != own)
    counted = set(re.findall(r"(?:limits\.|monkeypatch, \")([A-Z_]+)\b", text))
    rows = limits_page.rows().items()
    said = {name for name, row in rows if SAID.search(row.above)}
    assert said - counted - CASES.keys() - ELSEWHERE.keys() == set()
    for name, test in ELSEWHERE.items():
        file, _, function = test.partition("::")
        path = Path(__file__).parent / file
        assert f"def {function}(" in path.read_text("utf-8"), name
