"""The answer to a look-up as rows: the pose in four forms, texts to copy, the way."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from sambot_viz.frames import Transform
from sambot_viz.frames.robot_frames import Explanation
from sambot_viz.panels.rows.row import Row

DIGITS = 6
"""Decimals: a micrometre is more than a hand can use."""


def answer_rows(found: Explanation) -> Iterator[Row]:
    """Yield the pose in four forms, texts to copy, and the way; or why not."""
    T = found.transform
    if T is None:
        yield Row("frames/why", "", "note", value=found.reason, level="error")
        if found.refused is not None:
            said = f"tf2 says: {found.refused.tf2_text}"
            yield Row("frames/tf2", "", "note", value=said)
        return
    xyz, rpy = T.translation.tolist(), T.rpy
    (distance,) = plain_numbers([math.hypot(*xyz)])
    degrees = [math.degrees(angle) for angle in rpy]
    quaternion = T.rotation_xyzw.tolist()
    yield _copied("xyz", "Position x y z [m]", " ".join(plain_numbers(xyz)))
    yield _copied("distance", "Distance [m]", distance)
    yield _copied("rpy", "Roll pitch yaw [rad]", " ".join(plain_numbers(rpy)))
    yield _copied("deg", "Roll pitch yaw [°]", " ".join(plain_numbers(degrees, 3)))
    yield _copied("xyzw", "Quaternion x y z w", " ".join(plain_numbers(quaternion)))
    yield Row("frames/matrix", "", "group", "Matrix 4×4", expanded=True)
    yield _copied("matrix/rows", "Matrix 4×4", matrix_text(T), "frames/matrix", "lines")
    yield Row("frames/copy", "", "group", "Copy as", expanded=True)
    for key, name, value in copies(found.target, found.source, T):
        yield _copied(f"copy/{key}", name, value, "frames/copy")
    yield from _chain(found)


def _copied(
    key: str, name: str, value: str, parent: str = "", kind: str = "readonly"
) -> Row:
    return Row(
        f"frames/{key}",
        parent,
        "lines" if kind == "lines" else "readonly",
        name,
        value,
        extra={"copy": True},
    )


def copies(parent: str, child: str, T: Transform) -> Iterator[tuple[str, str, str]]:
    """Yield a pose as other programs want it: key, name, text."""
    x, y, z = plain_numbers(T.translation.tolist())
    roll, pitch, yaw = plain_numbers(T.rpy)
    flags = (
        *("--x", x, "--y", y, "--z", z),
        *("--roll", roll, "--pitch", pitch, "--yaw", yaw),
        *("--frame-id", parent, "--child-frame-id", child),
    )
    listed = ", ".join(f'"{word}"' for word in flags)
    yield "launch", "Launch file", f"arguments=[{listed}]"
    yield "flags", "Command line", " ".join(flags)
    eight = (x, y, z, yaw, pitch, roll, parent, child)
    yield "eight", "x y z yaw pitch roll …", " ".join(eight)
    yield (
        "urdf",
        "URDF origin",
        f'<origin xyz="{x} {y} {z}" rpy="{roll} {pitch} {yaw}"/>',
    )


def matrix_text(T: Transform) -> str:
    """Four lines of four numbers."""
    rows = [plain_numbers(row) for row in T.matrix.tolist()]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = (
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    )
    return "\n".join(lines)


def _chain(found: Explanation) -> Iterator[Row]:
    count = len(found.hops)
    steps = "the same frame" if not count else f"{count} step{'s' * (count != 1)}"
    yield Row(
        "frames/chain",
        "",
        "group",
        f"Path from {found.source} to {found.target}: {steps}",
    )
    for number, hop in enumerate(found.hops):
        xyz = shown_numbers(hop.step.translation.tolist())
        pose = f"xyz {xyz} m, rpy {shown_numbers(hop.step.rpy)} rad"
        yield Row(
            f"frames/chain/{number}",
            "frames/chain",
            "note",
            value=f"{hop.words}: {pose}",
        )


def plain_numbers(values: Iterable[float], digits: int = DIGITS) -> list[str]:
    """Return numbers without exponents, without zeros at the end, and without −0."""
    return [_plain(float(value), digits) for value in values]


def shown_numbers(values: Iterable[float], digits: int = DIGITS) -> str:
    """Return several numbers as RViz shows a vector, "1; 0; 0.5"."""
    return "; ".join(plain_numbers(values, digits))


def _plain(value: float, digits: int) -> str:
    shown = f"{round(value, digits) + 0.0:.{digits}f}"
    return shown.rstrip("0").rstrip(".") if "." in shown else shown
