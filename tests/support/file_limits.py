"""Makes files of models, meshes and definitions with so much of what a limit counts.

Each case returns what is said of it; empty for nothing.
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from PIL import Image

from sambot_viz import load_config, load_robot
from sambot_viz.bundled import find
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


def no_bytes(count: int, _: Path) -> str:
    return definition(f"B[{count - 1}] b\n{LINE}MSG: x/B\n")


def config_values(count: int, folder: Path) -> str:
    # The map, its key and the list are three of them.
    path = folder / "a.rviz"
    path.write_text("a:\n" + " - 1\n" * (count - 3))
    return refusal(lambda: load_config(path))


def gltf(document: dict[str, Any], folder: Path) -> str:
    path = folder / "m.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0"}, **document}))
    return refusal(lambda: read_mesh(path))


def nodes(count: int, folder: Path) -> str:
    numbers = [*range(count)]
    scene = {"scene": 0, "scenes": [{"nodes": numbers}], "nodes": [{}] * count}
    said = [gltf(scene, folder)]
    said.append(gltf({"bufferViews": [{"buffer": 0, "byteLength": 0}] * count}, folder))
    assert len({"more than" in one for one in said}) == 1, "both, or none"
    return " ".join(said)


def without_data(count: int, folder: Path) -> str:
    accessor = {"componentType": 5126, "count": count, "type": "SCALAR"}
    return gltf({"accessors": [accessor]}, folder)


def cut(budget: int, folder: Path) -> str:
    """Arrows of 4 corners, one of them inward, of which one takes 1016."""
    path = folder / "m.obj"
    corners = "v 0 0 0\nv 2 -1 0\nv 0 2 0\nv -2 -1 0\n"
    path.write_text(corners + "f 1 2 3 4\n" * -(-budget // 1016))
    return " ".join(problem.message for problem in read_mesh(path).problems)


def ply_header(size: int, folder: Path) -> str:
    begin = "ply\nformat ascii 1.0\ncomment "
    rest = "\nelement vertex 3\n"
    rest += "".join(f"property float {axis}\n" for axis in "xyz")
    rest += "element face 1\nproperty list uchar int vertex_indices\nend_header"
    path = folder / "m.ply"
    fill = "a" * (size - len(begin) - len(rest))
    path.write_text(f"{begin}{fill}{rest}\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    return refusal(lambda: read_mesh(path))


def model_below(folder: Path, depth: int, beside: int = 0) -> str:
    """What is said of a folder with a model in the last of its folders."""
    top = folder / f"top{depth}_{beside}"
    last = top.joinpath(*(["b"] * depth))
    last.mkdir(parents=True)
    for number in range(beside):
        (top / f"a{number}").mkdir()
    (last / "r.urdf").write_text(f'<robot name="r">{LINK.format("a")}</robot>')
    return refusal(lambda: find(top, None))


def model_depth(count: int, folder: Path) -> str:
    return model_below(folder, count)


def model_folders(count: int, folder: Path) -> str:
    # The folder itself and the last one are two of them.
    return model_below(folder, 1, count - 2)


def package_below(folder: Path, depth: int, beside: int = 0) -> str:
    """What is said of a mesh in a package that is in the last of some folders."""
    top = folder / f"top{depth}_{beside}"
    package = top.joinpath(*(["b"] * depth))
    package.mkdir(parents=True)
    for number in range(beside):
        (top / f"a{number}").mkdir()
    (package / "package.xml").write_text("<package><name>far</name></package>")
    (package / "m.stl").write_bytes(stl(1))
    shape = '<visual><geometry><mesh filename="package://far/m.stl"/></geometry>'
    text = f'<robot name="r"><link name="a">{shape}</visual></link></robot>'
    robot = load_robot(text, package_path=[top])
    return " ".join(problem.message for problem in robot.problems)


def searched_depth(count: int, folder: Path) -> str:
    return package_below(folder, count)


def searched_folders(count: int, folder: Path) -> str:
    return package_below(folder, 1, count - 2)


CASES: dict[str, Case] = {
    "CONFIG_VALUES": config_values,
    "DEFINITION_EMPTY": no_bytes,
    "MESH_CUTTING": cut,
    "MESH_EMPTY": without_data,
    "MESH_NODES": nodes,
    "MODEL_DEPTH": model_depth,
    "MODEL_FOLDERS": model_folders,
    "PLY_HEADER": ply_header,
    "SEARCHED_DEPTH": searched_depth,
    "SEARCHED_FOLDERS": searched_folders,
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
