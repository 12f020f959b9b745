"""What is just above a limit is refused with a sentence that has it, and no less is.

Each case makes what holds so much of what a row counts, and returns what is said of it.
"""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import limits_page
import numpy as np
import pytest
from lower_limit import lower
from PIL import Image

from sambot_viz import limits, load_config, load_robot
from sambot_viz.displays.data.message_numbers import require_few
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.drive.driven_wheels import find_wheel_pair
from sambot_viz.errors import RobotError, SambotVizError
from sambot_viz.joints.presets import Presets
from sambot_viz.joints.value_texts import load_joint_state
from sambot_viz.meshes.read_mesh import read_mesh
from sambot_viz.meshes.textures import TextureStore
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.topics.contents.grids import map_fault
from sambot_viz.topics.contents.pictures import size_fault

Case = Callable[[int, Path], str]
LINK = '<link name="{}"/>'
LINE = "=" * 80 + "\n"


def refusal(action: Callable[[], object]) -> str:
    """What is said by the error of an action; empty without one."""
    try:
        action()
    except RobotError as error:
        return " ".join(problem.message for problem in error.problems)
    except (SambotVizError, MessageRefused) as error:
        return str(error)
    return ""


def model(inside: str, *, trusted: bool = True, prefix: str = "") -> str:
    """What is said of a robot."""
    text = f'<robot name="r" {prefix}>{LINK.format("a")}{inside}</robot>'
    robot = None

    def load() -> None:
        nonlocal robot
        robot = load_robot(text, trusted=trusted)

    return refusal(load) or " ".join(p.message for p in robot.problems)  # type: ignore[union-attr]


def of_size(size: int, path: Path, begin: str, end: str = "") -> Path:
    """A file of so many bytes; blanks fill it."""
    path.write_text(begin + " " * (size - len(begin) - len(end)) + end)
    return path


def model_file(size: int, folder: Path) -> str:
    begin, end = '<robot name="r"><link name="a"/>', "</robot>"
    path = of_size(size, folder / "r.urdf", begin, end)
    return refusal(lambda: load_robot(path))


def config_file(size: int, folder: Path) -> str:
    path = of_size(size, folder / "a.rviz", "Visualization Manager:\n  Displays: []\n")
    return refusal(lambda: load_config(path))


def elements(count: int, _: Path) -> str:
    return model("".join(LINK.format(n) for n in range(count - 2)))


def nested(count: int, _: Path) -> str:
    # The root and the innermost element are two of them.
    return model("<a>" * (count - 1) + "</a>" * (count - 1))


XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def repeated(count: int, _: Path) -> str:
    name = f"<link name=\"${{'b' * {count}}}\"/>"
    return model(name, trusted=False, prefix=XACRO)


def power(bits: int, _: Path) -> str:
    # 2 has two bits.
    name = LINK.format(f"${{(2 ** {-(-bits // 2)}) > 0}}")
    return model(name, trusted=False, prefix=XACRO)


def chain(count: int, _: Path) -> str:
    links = "".join(LINK.format(n) for n in range(count))
    names = ["a", *map(str, range(count))]
    joints = "".join(
        f'<joint name="j{n}" type="fixed"><parent link="{above}"/>'
        f'<child link="{n}"/></joint>'
        for n, above in enumerate(names[:-1])
    )
    return model(links + joints)


def wheels(count: int, _: Path) -> str:
    links = "".join(LINK.format(n) for n in range(count))
    joints = "".join(
        f'<joint name="j{n}" type="continuous"><parent link="a"/><child link="{n}"/>'
        f'<origin xyz="0 {n} 0"/><axis xyz="0 1 0"/></joint>'
        for n in range(count)
    )
    robot = load_robot(f'<robot name="r"><link name="a"/>{links}{joints}</robot>')
    return refusal(lambda: find_wheel_pair(robot))


def stl(triangles: int) -> bytes:
    corners = np.array([[0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0]] * triangles, "<f4")
    rows = b"".join(row.tobytes() + b"\0\0" for row in corners)
    return bytes(80) + struct.pack("<I", triangles) + rows


def mesh(data: bytes, folder: Path) -> str:
    path = folder / "m.stl"
    path.write_bytes(data)
    return refusal(lambda: read_mesh(path))


def triangles(count: int, folder: Path) -> str:
    obj = folder / "m.obj"
    obj.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * count)
    ply = folder / "m.ply"
    head = "ply\nformat ascii 1.0\nelement vertex 3\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    head += f"element face {count}\nproperty list uchar int vertex_indices\n"
    corners = "0 0 0\n1 0 0\n0 1 0\n"
    ply.write_text(f"{head}end_header\n{corners}" + "3 0 1 2\n" * count)
    said = [mesh(stl(count), folder)]
    said += [refusal(lambda one=path: read_mesh(one)) for path in (obj, ply)]
    # All formats, or none.
    assert len(set(said)) == 1
    return said[0]


def mesh_file(size: int, folder: Path) -> str:
    return mesh(stl(2) + bytes(size - len(stl(2))), folder) if size > 184 else ""


def texture(pixels: int, _: Path) -> str:
    data = io.BytesIO()
    Image.new("RGB", (pixels, 1)).save(data, "PNG")
    return refusal(lambda: TextureStore().from_bytes(data.getvalue()))


def texture_file(size: int, folder: Path) -> str:
    path, data = folder / "t.png", io.BytesIO()
    Image.new("RGB", (1, 1)).save(data, "PNG")
    path.write_bytes(data.getvalue() + bytes(size - len(data.getvalue())))
    return refusal(lambda: TextureStore().from_file(path))


def poses_file(size: int, folder: Path) -> str:
    path = of_size(size, folder / "p.yaml", "home: {}\n")
    return refusal(lambda: Presets(path))


def joints_file(size: int, folder: Path) -> str:
    path = of_size(size, folder / "j.yaml", "a: 1.0\n")
    return refusal(lambda: load_joint_state(path))


def definition(text: str) -> str:
    reason = MessageTypes().decoder(Schema("x/msg/A", "ros2msg", text), "cdr").reason
    return "" if reason is None else reason.text


def types(count: int, _: Path) -> str:
    parts = "".join(f"B{n} b{n}\n" for n in range(count - 1))
    rest = "".join(f"{LINE}MSG: x/B{n}\nbool b\n" for n in range(count - 1))
    return definition(parts + rest)


def fields(count: int, _: Path) -> str:
    return definition("".join(f"bool b{n}\n" for n in range(count)))


def in_types(count: int, _: Path) -> str:
    inner = "".join(f"B{n} b\n{LINE}MSG: x/B{n}\n" for n in range(count - 1))
    return definition(f"{inner}bool b\n")


def arrays(count: int, _: Path) -> str:
    return definition(f"string[{count}] b\n")


def characters(count: int, _: Path) -> str:
    return definition("bool b\n#" + "a" * (count - 8))


def cbor(depth: int, _: Path) -> str:
    data = b"\xa1\x61a" + b"\x81" * (depth - 1) + b"\x01"
    decoder = MessageTypes().decoder(Schema("lab/A"), "cbor")
    return refusal(lambda: decoder.decode(data))


def image(pixels: int, _: Path) -> str:
    return size_fault(pixels, 1)


def cells(count: int, _: Path) -> str:
    info = SimpleNamespace(width=count, height=1, resolution=0.05)
    return map_fault(SimpleNamespace(info=info, data=bytes(count)))


def poses(count: int, _: Path) -> str:
    return refusal(lambda: require_few(count))


CASES: dict[str, Case] = {
    "MODEL": model_file,
    "XML_ELEMENTS": elements,
    "XML_DEPTH": nested,
    "XACRO_TEXT": repeated,
    "XACRO_BITS": power,
    "CHAIN": chain,
    "WHEELS": wheels,
    "CONFIG": config_file,
    "POSES_FILE": poses_file,
    "JOINTS_FILE": joints_file,
    "TRIANGLES": triangles,
    "MESH": mesh_file,
    "TEXTURE": texture_file,
    "TEXTURE_PIXELS": texture,
    "DEFINITION": characters,
    "DEFINITION_TYPES": types,
    "DEFINITION_FIELDS": fields,
    "DEFINITION_DEPTH": in_types,
    "DEFINITION_ARRAYS": arrays,
    "FIELDS_DEPTH": cbor,
    "IMAGE": image,
    "MAP_CELLS": cells,
    "MESSAGE_POSES": poses,
}
FEW = {"MODEL": 200, "CONFIG": 200, "MESH": 1000, "TEXTURE": 2000, "POSES_FILE": 100}
FEW |= {"JOINTS_FILE": 100, "DEFINITION": 100}
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
    "XACRO_TIME": "robot/xacro/test_expand.py::"
    "test_an_expansion_that_takes_too_long_is_ended",
}
"""Rows whose test has no need to lower them."""
OPEN = {
    *("ASSETS", "ASSET_NAME", "BAG_HEADER", "CHECKED_MESH", "CONFIG_NAME"),
    *("CONFIG_VALUES", "CONTROLS", "CONTROL_MARKERS", "DEFINITION_EMPTY"),
    *("DEFINITION_RECORD", "DEPTH_POINTS", "INTERACTIVE_MARKERS", "MARKER_JUMP"),
    *("MESH_CUTTING", "MESH_EMPTY", "MESH_NODES", "MODEL_DEPTH", "MODEL_FOLDERS"),
    *("MOTION", "NEAR_FOLDERS", "NUMBER", "ODOMETRY_POSES", "PAGE_LIST"),
    *("PAGE_NUMBER", "PAGE_PICTURE", "PATHS", "PATTERN", "PICTURE_SIDE"),
    *("PLY_HEADER", "POINT_BYTES", "RANGE_CONES", "REPAIRED", "SEARCHED"),
    *("SEARCHED_DEPTH", "SEARCHED_FOLDERS", "STAMPED_POINTS", "VECTORS"),
    *("XACRO_SOURCE", "XML_EXPLAINED", "YAML_REPAIRED"),
}
"""Rows that are said, and that no test has counted against so far."""
SAID = re.compile(r"\b(?:says?|said|error|refused|finding)\b")
IN_A_PROCESS = {"XACRO_TEXT", "XACRO_BITS"}
"""xacro runs in a process of its own, which has the table as it is."""


@pytest.mark.parametrize("name", CASES)
def test_just_above_a_limit_is_said_with_it_and_just_below_is_taken(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = FEW.get(name, 20)
    if name in IN_A_PROCESS:
        most = getattr(limits, name).value
    lower(monkeypatch, name, most)
    assert f"{most:,}" not in CASES[name](most, tmp_path)
    said = CASES[name](most + 1, tmp_path)
    assert f"{most:,}" in said


def test_every_row_that_is_said_has_a_case_or_a_test_that_lowers_it() -> None:
    tests = Path(__file__).parent.rglob("test_*.py")
    own = Path(__file__).name
    text = "".join(p.read_text("utf-8") for p in tests if p.name != own)
    counted = set(re.findall(r"(?:limits\.|monkeypatch, \")([A-Z_]+)\b", text))
    rows = {name: row for name, row in limits_page.rows().items()}
    said = {n for n, row in rows.items() if SAID.search(row.above)}
    assert said - counted - CASES.keys() - ELSEWHERE.keys() == OPEN
    for name, test in ELSEWHERE.items():
        file, _, function = test.partition("::")
        path = Path(__file__).parent / file
        assert f"def {function}(" in path.read_text("utf-8"), name
