# ruff: noqa: RUF009 (`_option` makes a new field for each option)
"""Everything a user can ask for, declared once.

`Visualizer` takes the fields of `Options` as keyword arguments, and the command line
takes those that have flags (see `commands/command_line.py`). Server, session and
snapshot read the same object. A new option is one field here, and one line where it is
used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, MISSING, Field, dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from sambot_viz.errors import Problem, UsageError

# A command line is read before anything heavy is imported.
if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    from sambot_viz.frames.static_transform import StaticTransform
    from sambot_viz.joints.start import StartPose
    from sambot_viz.robot.model import Robot
    from sambot_viz.rviz import RvizConfig

PathLike = Path | str
SessionMode = Literal["shared", "private"]
Group = Literal["model", "pose", "view", "server"]
"""Options that the same commands take: all with a MODEL, those that pose the robot,
those that draw it, and the one that serves a page."""

_KEY = "option"
_BASE_PATH = re.compile(r"/|(/[A-Za-z0-9._~-]+)+")
_AGAIN = "; may be given several times"


@dataclass(frozen=True, slots=True)
class Flag:
    """How an option is written on the command line, and what it means.

    Attributes:
        help: what the option does, without its default; also its documentation as a
            keyword argument.
        names: its flags, such as ``("-d", "--display-config")``; none for an option
            of the Python interface only.
        group: which commands take it.
        word: its name as an argument of display.launch.py, for ``NAME:=VALUE``.
        metavar: the placeholder for its value in the help.
        default: the command line's default where it is not the keyword argument's.
        choices: the only values there are.
        type: makes the value from one word; None keeps the text.
        read: makes the value from all words of an option that may be repeated, and
            the flag's name.
        optional_value: how a value may follow a flag that may stand without one, and
            is "" then: as the next word, or after "=" only.
        variable: of the environment, with the value for a command line without the
            flag; for what other users must not read in the list of processes.
        switch: a bool; "yes-no" has the flags ``--name`` and ``--no-name``, "off" has
            one that makes it False.
    """

    help: str
    names: tuple[str, ...] = ()
    group: Group = "server"
    word: str = ""
    metavar: str | None = None
    default: object = None
    choices: tuple[str, ...] = ()
    type: Callable[[str], object] | None = None
    read: Callable[[Sequence[str], str], object] | None = None
    optional_value: Literal["", "word", "="] = ""
    variable: str = ""
    switch: Literal["", "yes-no", "off"] = ""


def _option(
    default: Any,
    help: str,
    *names: str,
    factory: Callable[[], Any] | None = None,
    flag_default: object = None,
    **rest: Any,
) -> Any:
    flag = Flag(help, names, default=flag_default, **rest)
    if factory is not None:
        return field(default_factory=factory, metadata={_KEY: flag})
    return field(default=default, metadata={_KEY: flag})


def _words(words: Sequence[str], flag: str) -> tuple[str, ...]:
    return tuple(words)


def _assignments(words: Sequence[str], flag: str) -> dict[str, float]:
    from sambot_viz.joints.values import parse_assignments

    return parse_assignments(words, flag)


def _static_transforms(words: Sequence[str], flag: str) -> list[StaticTransform]:
    from sambot_viz.frames.static_transform import (
        StaticTransformError,
        parse_static_transform,
    )

    parsed: list[StaticTransform] = []
    for text in words:
        try:
            parsed.append(parse_static_transform(text))
        except StaticTransformError as error:
            quotes = "" if len(text.split()) > 1 else "; all values belong in one quote"
            raise UsageError(f"{flag} '{text}': {error}{quotes}") from error
    return parsed


@dataclass(frozen=True, slots=True)
class Options:
    """What to show, to whom, and how the robot starts.

    Attributes:
        base_path: with a slash at its begin and none at its end.
        recorded: the positions of `joint_state`.
        transforms: `static_transforms`, read.

    Raises:
        UsageError: a value that makes no sense.
        JointError: a joint state file that cannot be read.
        StaticTransformError: a text that static_transform_publisher would refuse.
    """

    model: PathLike | Robot | yourdfpy.URDF | None = _option(
        None,
        "model file or package folder; from Python also a Robot or a yourdfpy.URDF; "
        "without one, the bundled sam_bot",
    )
    config: PathLike | RvizConfig | None = _option(
        None,
        "a .rviz file; by default the one that belongs to the model, or the bundled "
        "one",
        "-d",
        "--display-config",
        group="view",
        word="rvizconfig",
        metavar="FILE",
    )
    _: KW_ONLY
    xacro_args: Mapping[str, str] = _option(
        None, "arguments for xacro, name → text", factory=dict
    )
    package_path: Sequence[PathLike] = _option(
        (),
        f"a folder with ROS packages{_AGAIN}",
        "--package-path",
        group="model",
        metavar="DIR",
        read=_words,
    )
    trusted: bool = _option(
        True,
        "evaluate the model without file access and attribute access, for files you "
        "do not trust",
        "--untrusted",
        group="model",
        switch="off",
    )
    fixed_frame: str | None = _option(
        None,
        "the fixed frame, instead of the config's",
        "-f",
        "--fixed-frame",
        group="view",
        metavar="FRAME",
    )
    joint_positions: Mapping[str, float] = _option(
        None,
        f"position of a joint at the start [rad or m]{_AGAIN}",
        "--joint",
        factory=dict,
        group="pose",
        metavar="NAME=VALUE",
        read=_assignments,
    )
    zeros: Mapping[str, float] = _option(
        None,
        f"start value of a joint, as joint_state_publisher's zeros.NAME{_AGAIN}",
        "--zeros",
        factory=dict,
        group="pose",
        metavar="NAME=VALUE",
        read=_assignments,
    )
    joint_state: PathLike | None = _option(
        None,
        "a yaml file with joint positions, such as ros2 topic echo prints them",
        "--joint-state",
        group="pose",
        metavar="FILE",
    )
    static_transforms: Sequence[StaticTransform | str] = _option(
        (),
        "another frame: the arguments of static_transform_publisher, with or without "
        f"its flags such as --x, all in one pair of quotes{_AGAIN}",
        "--static-transform",
        group="pose",
        metavar='"X Y Z YAW PITCH ROLL PARENT CHILD"',
        read=_static_transforms,
    )
    gui: bool = _option(
        True,
        "the Joints panel with its sliders",
        "--gui",
        word="gui",
        switch="yes-no",
    )
    host: str = _option("127.0.0.1", "the address to listen on", "--host")
    port: int = _option(
        0,
        "the port to listen on; 0 takes any free one",
        "--port",
        type=int,
        flag_default=8080,
    )
    unix_socket: PathLike | None = _option(
        None,
        "listen on a socket in the file system instead of a port, for a proxy of the "
        "same user: nobody else can open it",
        "--unix-socket",
        metavar="PATH",
    )
    allowed_origins: Sequence[str] = _option(
        (),
        "another name of this machine, or another web page that may use the server, "
        f"such as https://lab.example.org for one behind a proxy{_AGAIN}",
        "--allow-origin",
        metavar="ORIGIN",
        read=_words,
    )
    base_path: str = _option(
        "/",
        "where a proxy shows the page, such as /robot for https://lab.example.org/robot/",
        "--base-path",
        metavar="PATH",
    )
    token: str | None = _option(
        None,
        "a secret without which nobody sees the page, in the link that is printed; "
        "made when no VALUE is given; by default that of the variable SAMBOT_VIZ_TOKEN",
        "--token",
        metavar="VALUE",
        optional_value="word",
        variable="SAMBOT_VIZ_TOKEN",
    )
    presenter: str | None = _option(
        None,
        "only who opens a second, secret link moves the robot and the displays; the "
        "others watch, may ask for the wheel, and may work on a copy of their own; "
        "VALUE is the secret, by default that of the variable SAMBOT_VIZ_PRESENTER, or "
        "made",
        "--presenter",
        metavar="=VALUE",
        optional_value="=",
        variable="SAMBOT_VIZ_PRESENTER",
    )
    session: SessionMode = _option(
        "shared",
        "one robot for all browsers, or one for each",
        "--session",
        choices=("shared", "private"),
    )
    watch: bool = _option(
        False,
        "show the model, its meshes and the config again when they are saved",
        "--watch",
        switch="yes-no",
        flag_default=True,
    )
    left_wheel: str | None = _option(
        None,
        "the joint of the left wheel to drive with",
        "--left-wheel",
        metavar="JOINT",
    )
    right_wheel: str | None = _option(
        None,
        "the joint of the right wheel to drive with",
        "--right-wheel",
        metavar="JOINT",
    )
    wheel_radius: float | None = _option(
        None,
        "radius of the wheels [m]; by default the model's",
        "--wheel-radius",
        type=float,
        metavar="METRES",
    )
    wheel_separation: float | None = _option(
        None,
        "distance of the wheels [m]; by default the model's",
        "--wheel-separation",
        type=float,
        metavar="METRES",
    )
    poses: PathLike | None = _option(
        None,
        "the yaml file for named poses; by default one beside the model, for the "
        "bundled robot in the working folder",
        "--poses",
        metavar="FILE",
    )
    panels: bool = _option(
        True, "whether the page has panels; without them the 3D view fills it"
    )
    on_reload: Callable[[Sequence[Problem]], None] | None = _option(
        None,
        "called with what is wrong with the model and the config whenever a reload "
        "changes that",
    )
    recorded: Mapping[str, float] = field(init=False, repr=False, compare=False)
    transforms: tuple[StaticTransform, ...] = field(
        init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        for each in declared():
            _check_choice(each, getattr(self, each.name))
        if self.fixed_frame is not None and not self.fixed_frame.strip():
            raise UsageError(
                "the fixed frame has an empty name; give a frame of the robot, such "
                "as base_link"
            )
        path = f"/{self.base_path.strip('/')}"
        if not _BASE_PATH.fullmatch(path):
            raise UsageError(
                f"the base path '{self.base_path}' cannot be part of an address; give "
                "one such as /robot"
            )
        object.__setattr__(self, "base_path", path)
        for name in ("token", "presenter"):
            if (secret := getattr(self, name)) is not None:
                object.__setattr__(self, name, _checked_secret(secret, f"--{name}"))
        self._check_presenter()
        object.__setattr__(self, "recorded", self._read_recorded())
        object.__setattr__(self, "transforms", self._read_transforms())

    def _check_presenter(self) -> None:
        if self.presenter is None:
            return
        if self.session == "private":
            raise UsageError(
                "--presenter needs a robot that all browsers share; leave "
                "--session private out"
            )
        if self.presenter == self.token:
            raise UsageError("--presenter and --token need different secrets")

    @property
    def start_pose(self) -> StartPose:
        """The pose that `zeros`, `joint_state` and `joint_positions` ask for."""
        from sambot_viz.joints.start import StartPose

        return StartPose(self.zeros, self.recorded, self.joint_positions)

    def _read_recorded(self) -> Mapping[str, float]:
        if self.joint_state is None:
            return {}
        from sambot_viz.joints.values import load_joint_state

        return load_joint_state(Path(self.joint_state))

    def _read_transforms(self) -> tuple[StaticTransform, ...]:
        if not self.static_transforms:
            return ()
        from sambot_viz.frames.static_transform import parse_static_transform

        return tuple(
            parse_static_transform(given) if isinstance(given, str) else given
            for given in self.static_transforms
        )


def declared() -> Iterator[Field[Any]]:
    """Return the fields of `Options` that a user can give, in the order of the help."""
    return (each for each in fields(Options) if _KEY in each.metadata)


def flag_of(option: Field[Any]) -> Flag:
    """How an option is written on the command line."""
    flag: Flag = option.metadata[_KEY]
    return flag


def keyword_help() -> str:
    """Return the options as the "Args" of a docstring."""
    lines = ["Args:"]
    for each in declared():
        flag = flag_of(each)
        given = each.default not in (MISSING, None, ())
        default = f" (default: {each.default!r})" if given else ""
        lines.append(f"    {each.name}: {flag.help.removesuffix(_AGAIN)}{default}.")
    return "\n".join(lines)


def _check_choice(option: Field[Any], value: object) -> None:
    choices = flag_of(option).choices
    if choices and value not in choices:
        listed = " or ".join(f"'{choice}'" for choice in choices)
        raise UsageError(f"{option.name}={value!r}: it must be {listed}")


def _checked_secret(secret: str, flag: str) -> str:
    from sambot_viz.tokens import check_token, new_token

    return check_token(secret, flag) if secret else new_token()
