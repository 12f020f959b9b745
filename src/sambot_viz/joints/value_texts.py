"""Joint values as text: arguments, sensor_msgs/JointState files, ros2 commands."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import cast

import yaml

from sambot_viz import limits
from sambot_viz.errors import JointError, UsageError
from sambot_viz.files import read_limited
from sambot_viz.geometry import finite
from sambot_viz.robot.slips.units import quantity


def parse_assignments(texts: Iterable[str], option: str) -> dict[str, float]:
    """Read the arguments of ``--joint`` or ``--zeros``.

    Args:
        texts: each "NAME=VALUE", VALUE in radians or metres, or with its unit, such as
            90deg or 15mm. The last one of a name counts.
        option: the name of the option, for the message.

    Raises:
        UsageError: a text that has no name, no '=' or no finite number.
    """
    values: dict[str, float] = {}
    for text in texts:
        # A joint's name may hold '=', a number cannot.
        name, equals, number = text.rpartition("=")
        if not equals or not name.strip():
            raise UsageError(
                f"{option} {text}: expected NAME=VALUE, such as "
                f"{option} drivewhl_l_joint=1.57"
            )
        values[name.strip()] = _argument(number, f"{option} {text}")
    return values


def _argument(text: str, label: str) -> float:
    number = quantity(text)
    if number is None or not math.isfinite(number):
        raise UsageError(
            f"{label}: '{text}' is not a finite number of radians or metres, nor one "
            "with its unit, such as 90deg or 15mm"
        )
    return number


def load_joint_state(path: Path) -> dict[str, float]:
    """Read joint positions from a yaml file.

    Args:
        path: either the lists `name` and `position` of a sensor_msgs/JointState, as
            ``ros2 topic echo`` prints it (of several messages the first), or a plain
            mapping of joint names to positions [rad or m].

    Raises:
        JointError: the file cannot be read or is neither of the two.
    """
    # ros2 topic echo ends each message with a document mark.
    document = first_document(path, "", limits.JOINTS_FILE.value, pipe=True)
    if not isinstance(document, dict):
        raise JointError(
            f"{path} is not a joint state: expected the lists 'name' and 'position', "
            "or one 'joint: value' per line"
        )
    mapping = cast("dict[object, object]", document)
    if isinstance(mapping.get("name"), list):
        mapping = _paired(mapping, path)
    return {str(name): _value(name, v, path) for name, v in mapping.items()}


def first_document(
    path: Path, what: str, largest: int, *, pipe: bool = False
) -> object:
    """Read the first document of a yaml file.

    Args:
        path: the file.
        what: what it holds, for a message: "the poses in ".
        largest: a larger file is not read [bytes].
        pipe: a pipe is read too.

    Raises:
        JointError: the file cannot be read, or is not yaml.
    """
    try:
        text = read_limited(path, largest, pipe=pipe).decode()
        return next(iter(yaml.safe_load_all(text)), None)
    except (OSError, UnicodeDecodeError) as error:
        reason = "it is not UTF-8 text"
        if isinstance(error, OSError):
            reason = (error.strerror or str(error)).lower()
        raise JointError(f"cannot read {what}{path}: {reason}") from error
    except yaml.YAMLError as error:
        reason = " ".join(str(error).split())
        raise JointError(f"{path} is not yaml: {reason}") from error


def _paired(message: dict[object, object], path: Path) -> dict[object, object]:
    names = cast("list[object]", message["name"])
    positions = message.get("position")
    count = len(cast("list[object]", positions)) if isinstance(positions, list) else 0
    if count != len(names):
        raise JointError(
            f"{path} names {len(names)} joints and gives {count} positions; "
            "there must be one position for each name"
        )
    paired: dict[object, object] = {}
    for name, position in zip(names, cast("list[object]", positions), strict=True):
        # robot_state_publisher takes the first of two values with one name.
        paired.setdefault(name, position)
    return paired


def _value(name: object, value: object, path: Path) -> float:
    number = finite(value)
    if number is not None:
        return number
    raise JointError(
        f"{path}: joint '{name}' has {value!r}, which is not a finite number"
    )


def as_yaml(positions: Mapping[str, float]) -> str:
    """Write positions as the yaml of a sensor_msgs/JointState, exact."""
    lines = ["name:", *(f"- {_word(name)}" for name in positions)]
    lines += ["position:", *(f"- {_exact(value)}" for value in positions.values())]
    return "\n".join(lines) + "\n" if positions else "name: []\nposition: []\n"


def as_topic_pub(positions: Mapping[str, float], topic: str = "/joint_states") -> str:
    """Write the shell command that publishes positions once, with the time of then.

    robot_state_publisher drops messages with the stamp 0, so the header asks for the
    present time.
    """
    names = ", ".join(_word(name) for name in positions)
    values = ", ".join(_exact(value) for value in positions.values())
    message = f"{{header: auto, name: [{names}], position: [{values}]}}"
    quoted = message.replace("'", "'\"'\"'")
    return f"ros2 topic pub --once {topic} sensor_msgs/msg/JointState '{quoted}'"


def as_arguments(positions: Mapping[str, float]) -> str:
    """Write positions as arguments of this program: ``--joint NAME=VALUE …``."""
    words = (shlex.quote(f"{name}={_exact(v)}") for name, v in positions.items())
    return " ".join(f"--joint {word}" for word in words)


def as_launch_parameters(positions: Mapping[str, float]) -> str:
    """Write positions as start values of joint_state_publisher, for a launch file.

    It is the Python that the argument `parameters` of a Node takes.
    """
    lines = (
        f"    {'zeros.' + name!r}: {_exact(v)},\n" for name, v in positions.items()
    )
    return f"parameters=[{{\n{''.join(lines)}}}],\n"


def _word(name: str) -> str:
    """A name as a flow scalar of yaml, in quotes where it needs them."""
    text = yaml.safe_dump(
        [name], default_flow_style=True, allow_unicode=True, width=10**9
    )
    return text.strip()[1:-1]


def _exact(value: float) -> str:
    # yaml 1.1 reads 1e-07 as text; with a dot in it, it is a number.
    text = repr(float(value) + 0.0)
    mantissa, e, exponent = text.partition("e")
    return f"{mantissa}.0e{exponent}" if e and "." not in mantissa else text
