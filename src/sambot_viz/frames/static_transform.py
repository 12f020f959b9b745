"""The arguments of static_transform_publisher, in all the forms that tool has had.

Rules and error texts are those of the ROS 2 tool. A hint after them explains what they
leave out (the order yaw pitch roll, the period of ROS 1).
"""

from __future__ import annotations

import math
import re
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sambot_viz.errors import UsageError
from sambot_viz.frames.frame_errors import TransformRefused
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.transform import Transform

FORM = "X Y Z YAW PITCH ROLL PARENT CHILD"
"""The usual form: metres, radians, and yaw first."""

_TRANSLATION = ("x", "y", "z")
_ANGLES = ("yaw", "pitch", "roll")
_QUATERNION = ("qx", "qy", "qz", "qw")
_FRAMES = ("frame-id", "child-frame-id")
_FLAGS = {f"--{name}": name for name in _TRANSLATION + _ANGLES + _QUATERNION + _FRAMES}
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*)", re.DOTALL)
_NOT_FINITE = re.compile(r"\s*[+-]?(nan|inf|infinity)", re.IGNORECASE)


class StaticTransformError(UsageError):
    """Arguments that static_transform_publisher would refuse, or listeners ignore.

    Attributes:
        ros_text: what the real tool says.
        hint: what to write instead; may be empty.
    """

    def __init__(self, ros_text: str, hint: str = "") -> None:
        self.ros_text = ros_text
        self.hint = hint
        super().__init__(f"{ros_text}; {hint}" if hint else ros_text)


@dataclass(frozen=True, slots=True)
class StaticTransform:
    """A transform that holds for all times.

    Attributes:
        parent: the frame in which the pose is given.
        child: the frame whose pose it is.
        transform: T_parent_child.
        warnings: what the real tool would take in silence, and why it is doubtful.
    """

    parent: str
    child: str
    transform: Transform
    warnings: tuple[str, ...] = ()


def parse_static_transform(arguments: str | Sequence[str]) -> StaticTransform:
    """Read the arguments of static_transform_publisher.

    Args:
        arguments: one text or a list of words. Either eight values "X Y Z YAW PITCH
            ROLL PARENT CHILD", or nine "X Y Z QX QY QZ QW PARENT CHILD", or flags
            "--x … --yaw … --frame-id PARENT --child-frame-id CHILD". Metres, radians.

    Raises:
        StaticTransformError: with the text of the real tool and an explanation.
    """
    words = _words(arguments)
    flags, bare = _sort(words)
    warnings: list[str] = []
    if len(bare) in (8, 9):
        flags = _old_form(bare, flags, warnings)
    elif bare:
        raise StaticTransformError(
            "Extra unparsed arguments on command-line", _extra_hint(bare, flags)
        )
    return _build(flags, old_form=bool(bare), warnings=warnings)


def _words(arguments: str | Sequence[str]) -> list[str]:
    if not isinstance(arguments, str):
        return list(arguments)
    try:
        return shlex.split(arguments)
    except ValueError as error:
        raise StaticTransformError(
            f"cannot split {arguments!r} into words", f"{error}; {_usage()}"
        ) from error


def _sort(words: list[str]) -> tuple[dict[str, str], list[str]]:
    flags: dict[str, str] = {}
    bare: list[str] = []
    rest = iter(words)
    for word in rest:
        name = _FLAGS.get(word)
        if name is None:
            bare.append(word)
            continue
        value = next(rest, None)
        if value is None:
            raise StaticTransformError(
                f"Not enough arguments for {word}", "its value is the next word"
            )
        if name not in _FRAMES:
            _number(value, f"{word} argument", [])
        flags[name] = value
    return flags, bare


def _old_form(
    bare: list[str], flags: dict[str, str], warnings: list[str]
) -> dict[str, str]:
    angles_too = [name for name in _ANGLES if name in flags]
    if len(flags) > len(angles_too):
        raise StaticTransformError(
            "Cannot specify both new-style (flags) and old-style (arguments)",
            f"leave the flags out and {_usage()}",
        )
    rotation = _ANGLES if len(bare) == 8 else _QUATERNION
    given: dict[str, str] = dict(
        zip((*_TRANSLATION, *rotation, *_FRAMES), bare, strict=True)
    )
    for name in (*_TRANSLATION, *rotation):
        try:
            _number(given[name], f"{name} argument", [])
        except StaticTransformError as error:
            raise StaticTransformError(
                error.ros_text, _old_form_hint(bare, error.hint)
            ) from None
    for name in angles_too:
        warnings.append(
            f"--{name} {flags[name]} has no effect beside the {len(bare)} bare values"
        )
    return given


def _old_form_hint(bare: list[str], hint: str) -> str:
    if len(bare) == 9 and _is_number(bare[8]) and not _is_number(bare[6]):
        return (
            "nine values are X Y Z QX QY QZ QW PARENT CHILD; the last one looks like "
            "the period in milliseconds of ROS 1, which ROS 2 does not have: "
            f"leave '{bare[8]}' out"
        )
    return f"{hint}; {_usage()}" if hint else _usage()


def _extra_hint(bare: list[str], flags: dict[str, str]) -> str:
    joined = next((w for w in bare if w.split("=")[0] in _FLAGS), None)
    if joined is not None:
        return f"write '{joined.replace('=', ' ', 1)}': the value is a word of its own"
    unknown = next((w for w in bare if w.startswith("--")), None)
    if unknown is not None:
        return f"there is no flag '{unknown}'; the flags are {', '.join(_FLAGS)}"
    if flags:
        return f"the words {' '.join(bare)} belong to no flag"
    return f"{len(bare)} values are neither 8 nor 9; {_usage()}"


def _build(
    given: dict[str, str], *, old_form: bool, warnings: list[str]
) -> StaticTransform:
    quaternion = any(name in given for name in _QUATERNION)
    if quaternion and any(name in given for name in _ANGLES):
        raise StaticTransformError(
            "Cannot specify both quaternion and Euler rotations",
            "give either --qx --qy --qz --qw or --roll --pitch --yaw",
        )
    parent, child = _frame_names(given, warnings)

    def value(name: str, default: str = "0") -> float:
        label = f"{name} argument" if old_form else f"--{name} argument"
        return _number(given.get(name, default), label, warnings)

    xyz = [value(name) for name in _TRANSLATION]
    try:
        if quaternion:
            xyzw = [value(n, "1" if n == "qw" else "0") for n in _QUATERNION]
            transform = Transform.from_xyz_xyzw(xyz, xyzw)
        else:
            rpy = [value(name) for name in ("roll", "pitch", "yaw")]
            warnings.extend(_degrees(rpy))
            transform = Transform.from_xyz_rpy(xyz, rpy)
    except TransformRefused as refused:
        raise StaticTransformError(
            str(refused), "the real tool publishes it, and every listener ignores it"
        ) from refused
    return StaticTransform(parent, child, transform, tuple(warnings))


def _frame_names(given: dict[str, str], warnings: list[str]) -> tuple[str, str]:
    names: list[str] = []
    for key, title in zip(_FRAMES, ("Frame id", "Child frame id"), strict=True):
        written = given.get(key, "")
        name = plain_name(written)
        if not name:
            raise StaticTransformError(
                f"{title} must not be empty", f"name it with --{key}, or {_usage()}"
            )
        if name != written:
            warnings.append(f"tf2 strips the leading slash of '{written}'")
        names.append(name)
    parent, child = names
    if parent == child:
        raise StaticTransformError(
            f"cannot publish static transform from '{parent}' to '{child}', exiting",
            "a frame cannot be its own parent",
        )
    return parent, child


def _is_number(text: str) -> bool:
    found = _NUMBER.match(text)
    return found is not None and not found[2]


def _number(text: str, label: str, warnings: list[str]) -> float:
    found = _NUMBER.match(text)
    if found is None:
        if _NOT_FINITE.match(text):
            return math.nan
        raise StaticTransformError(
            f"Failed to parse {label} as float", f"'{text}' is not a number"
        )
    if found[2]:
        warnings.append(f"'{text}' is read as {found[1]}: leave '{found[2]}' out")
    number = float(found[1])
    if math.isinf(number):
        # The real tool ends with an uncaught std::out_of_range here.
        raise StaticTransformError(
            f"Failed to parse {label} as float", f"'{text}' is too large"
        )
    return number


def _degrees(rpy: Sequence[float]) -> Iterator[str]:
    """Yield a warning for each angle of more than a full turn."""
    for name, angle in zip(("roll", "pitch", "yaw"), rpy, strict=True):
        if math.tau + 1e-3 < abs(angle) <= 360:
            yield (
                f"{name} {angle:g} looks like degrees, but it is in radians: write "
                f"{math.radians(angle):.5g}"
            )


def _usage() -> str:
    return f'give "{FORM}" (metres, radians, yaw before pitch and roll)'
