"""Makes recordings, messages and wishes of pages with so much of what a limit counts.

Each case returns what is said of it; empty for nothing.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import numpy as np
from any_recording import Given, write_any
from file_limits import refusal
from interactive_messages import control, cube, marker
from made_recording import store_of_all
from mcap_pieces import mcap_file, message, string

from sambot_viz import Visualizer, load_config, load_robot
from sambot_viz.checks import check_robot
from sambot_viz.displays.data.interactive_markers.controls import require_valid
from sambot_viz.errors import Problem, SourceError
from sambot_viz.joints.state import JointState
from sambot_viz.meanings.foxglove.packed import cloud
from sambot_viz.panels import validation
from sambot_viz.panels.command import LIST, NUMBER, Command
from sambot_viz.panels.rows.row import Row
from sambot_viz.sources.bag import open_bag
from sambot_viz.sources.live.assets import AssetStore
from sambot_viz.topics.live_files import fetch_files

MESH = '<link name="{0}"><visual><geometry><mesh filename="{1}"/></geometry></visual>'


def _said(problems: Iterable[Problem]) -> str:
    return " ".join(problem.message for problem in problems)


def _of_bag(path: Path) -> str:
    with open_bag(path) as bag:
        list(bag.messages())
        return _said(bag.problems)


def definition_record(size: int, folder: Path) -> str:
    fixed = 2 + 3 * 4 + len(b"std_msgs/msg/String") + len(b"ros2msg")
    path = mcap_file(folder, [message(1, 1)], b"a".ljust(size - fixed, b"#"))
    return _of_bag(path)


def bag_header(size: int, folder: Path) -> str:
    (folder / f"{size}").mkdir()
    path = write_any(folder / f"{size}", "bag", [Given("/a", [string(40)])])
    magic, data = path.read_bytes()[:13], path.read_bytes()[13:]
    header = struct.pack("<I", size - 4) + b"x=".ljust(size - 4, b"a")
    added = struct.pack("<I", size) + header + struct.pack("<I", 0)
    path.write_bytes(magic + added + data)
    return _of_bag(path)


def like_records(count: int, folder: Path) -> str:
    # The last place is a record.
    likely = (b"\x03" + b"\xff" * 4 + bytes(4)) * (count - 1)
    behind = b"".join(message(1, 10**9 + n) for n in range(4))
    return _of_bag(mcap_file(folder, [message(1, 10**9), b"\0", likely, behind]))


def point(size: int, _: Path) -> str:
    return refusal(lambda: cloud({"point_stride": size, "data": bytes(size)}))


def address(size: int, _: Path) -> str:
    uri = "package://".ljust(size, "m")
    future = AssetStore().fetch(uri)
    error = future.exception(0) if future.done() else None
    return _said(error.problems) if isinstance(error, SourceError) else ""


class _Files:
    """A source that hands out every file."""

    capabilities = frozenset({"files"})

    def fetch_asset(self, uri: str) -> Future[bytes]:
        future: Future[bytes] = Future()
        future.set_result(uri.encode())
        return future


def assets(count: int, folder: Path) -> str:
    names = (f"package://p/{number}.stl" for number in range(count))
    text = "".join(MESH.format(n, name) for n, name in enumerate(names))
    source: Any = _Files()
    said = _said(fetch_files(source, text, folder))
    written = len(list(folder.glob("p/*.stl")))
    assert written == (count - 1 if said else count), "only the last one is left out"
    return said


def controls(count: int, _: Path) -> str:
    types = store_of_all().types
    made = marker(types, controls=[control(types) for _ in range(count)])
    return refusal(lambda: require_valid(made))


def control_markers(count: int, _: Path) -> str:
    types = store_of_all().types
    shapes = [cube(types) for _ in range(count)]
    made = marker(types, controls=[control(types, markers=shapes)])
    return refusal(lambda: require_valid(made))


def checked_mesh(size: int, folder: Path) -> str:
    count = (size - 84) // 50
    corners = np.array([[0, 0, 1, 0, 0, 0, 0.2, 0, 0, 0, 0.2, 0]], "<f4").tobytes()
    stl = bytes(80) + struct.pack("<I", count) + (corners + b"\0\0") * count
    (folder / "m.stl").write_bytes(stl.ljust(size, b"\0"))
    file = folder / "r.urdf"
    link = MESH.format("a", "m.stl")
    file.write_text(f'<robot name="r">{link}</link></robot>')
    return _said(check_robot(load_robot(file)))


def number(most: int, _: Path) -> str:
    """One of a URDF file, of an SDF file and of a joint."""
    value = repr(float(most) if most % 2 == 0 else math.nextafter(most, math.inf))
    box = f'<visual><geometry><box size="1 1 {value}"/></geometry></visual>'
    urdf = load_robot(f'<robot name="r"><link name="a">{box}</link></robot>')
    shape = f"<sphere><radius>{value}</radius></sphere>"
    sdf = load_robot(
        f'<sdf version="1.8"><model name="r"><link name="a"><visual name="v"><geometry>'
        f"{shape}</geometry></visual></link></model></sdf>"
    )
    joint = '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
    robot = load_robot(
        f'<robot name="r"><link name="a"/><link name="b"/>{joint}</joint></robot>'
    )
    position = refusal(lambda: JointState(robot).set("j", float(value)))
    said = [_said(urdf.problems), _said(sdf.problems), position]
    assert len(set(map(bool, said))) == 1, "all of them, or none"
    return said[0] and " ".join(said)


def pattern(size: int, folder: Path) -> str:
    path = folder / "a.rviz"
    path.write_text(
        "Visualization Manager:\n  Displays:\n    - Class: rviz_default_plugins/TF\n"
        "      Name: TF\n      Enabled: true\n"
        f"      Filter (whitelist): {'a' * size}\n"
    )
    return _said(load_config(path).problems)


def _display(kind: str, name: str) -> Callable[[int, Path], str]:
    """Sets a property of a display, in a config, to a number."""

    def case(value: int, folder: Path) -> str:
        path = folder / "a.rviz"
        path.write_text(
            "Visualization Manager:\n  Displays:\n"
            f"    - Class: rviz_default_plugins/{kind}\n      Name: One\n"
            f"      Enabled: true\n      {name}: {value}\n"
        )
        return _said(load_config(path).problems)

    return case


def page_list(count: int, _: Path) -> str:
    do = Command("x/do", (LIST,), name="Do")
    return refusal(lambda: validation.arguments_of(do, [[1] * count]))


def page_number(most: int, _: Path) -> str:
    kinds: dict[Any, Any] = {
        "float": most,
        "vector": [0.0, most, 0.0],
        "color": [0, 0, most],
    }

    def row(kind: Any) -> Row:
        value = (0.0,) * 3 if isinstance(kinds[kind], list) else 0.0
        return Row("row", "", kind, "N", value=value, set=lambda value: None)

    said = [
        refusal(lambda k=kind, v=value: validation.validate(row(k), v))
        for kind, value in kinds.items()
    ]
    for argument, sent in ((NUMBER, most), (LIST, [most])):
        do = Command("x/do", (argument,), name="Do")
        said.append(refusal(lambda do=do, v=sent: validation.arguments_of(do, [v])))
    assert len({f"{most - 1:,}" in text for text in said}) == 1, "all of them, or none"
    return said[0] and " ".join(said)


def picture_side(pixels: int, folder: Path) -> str:
    viz = Visualizer(port=0)
    viz.stop()
    return refusal(lambda: viz.snapshot(folder / "p.png", size=(pixels, 1)))


def motion(seconds: int, folder: Path) -> str:
    with Visualizer('<robot name="r"><link name="a"/></robot>', port=0) as viz:
        moves = [0, seconds], {"j": [0, 0]}
        return refusal(lambda: viz.export(folder / "m.html", motion=moves))


CASES = {
    "ASSETS": assets,
    "PATHS": _display("Path", "Buffer Length"),
    "RANGE_CONES": _display("Range", "Buffer Length"),
    "STAMPED_POINTS": _display("PointStamped", "History Length"),
    "VECTORS": _display("Wrench", "History Length"),
    "ASSET_NAME": address,
    "BAG_HEADER": bag_header,
    "CHECKED_MESH": checked_mesh,
    "CONTROLS": controls,
    "CONTROL_MARKERS": control_markers,
    "DEFINITION_RECORD": definition_record,
    "MOTION": motion,
    "NUMBER": number,
    "PAGE_LIST": page_list,
    "PAGE_NUMBER": page_number,
    "PATTERN": pattern,
    "PICTURE_SIDE": picture_side,
    "POINT_BYTES": point,
    "REPAIRED": like_records,
}
