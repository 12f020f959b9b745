# ruff: noqa: RUF009 (`option` makes a new field for each option)
"""Everything a user can ask for, declared once.

`Visualizer` takes the fields of `Options` as keyword arguments, and the command line
takes those that have flags (`flags.py`, `commands/command_line.py`). Server, session
and snapshot read the same object. A new option is one field here, and one line where it
is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from sambot_viz.errors import Problem, UsageError
from sambot_viz.files import LIVE_SOURCES, is_recording
from sambot_viz.flags import (
    AGAIN,
    assignments,
    check_base_path,
    check_choice,
    check_header,
    check_token,
    declared,
    duration,
    named_words,
    new_token,
    option,
    static_transforms,
    words_of,
)

# A command line is read before anything heavy is imported.
if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    from sambot_viz.frames.static_transform import StaticTransform
    from sambot_viz.joints.presets import StartPose
    from sambot_viz.lessons.study import Study
    from sambot_viz.robot.model import Robot
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.sources.given import GivenSource

PathLike = Path | str
SessionMode = Literal["shared", "private"]
Look = Literal["rviz", "studio"]
LogFormat = Literal["text", "json"]
SHORTEST_SLOT, LONGEST_SLOT = 10.0, 24 * 3600.0
"""How long a turn in control may be [s]."""
SHORTEST_PART, LONGEST_PART = 1.0, 3600.0
"""How long each file of a recording in several files may be [s]."""
LATEST = 1e9
"""No recording is longer, about thirty years; nanoseconds fit in 64 bits [s]."""


def _is_live(uri: str) -> bool:
    from sambot_viz.sources.registry import is_live

    return is_live(uri)


def _given_sources(
    words: Sequence[str], prefixes: Mapping[str, str], rules: Sequence[str]
) -> tuple[GivenSource, ...]:
    if not words and not prefixes and not rules:
        return ()
    from sambot_viz.sources.given import given_sources
    from sambot_viz.sources.remapping import remaps_of

    return given_sources(words, prefixes, remaps_of(rules))


@dataclass(frozen=True, slots=True)
class Options:
    """The robot to show, its viewers, and its start.

    Attributes:
        base_path: with a slash at its beginning and none at its end.
        recorded: the positions of `joint_state`.
        transforms: `static_transforms`, read.

    Raises:
        UsageError: a value that makes no sense.
        JointError: a joint state file that cannot be read.
        StaticTransformError: a text that static_transform_publisher would refuse.
    """

    model: PathLike | Robot | yourdfpy.URDF | None = option(
        None,
        "model file, package folder or recording; from Python also a Robot, a "
        "yourdfpy.URDF or the XML text; "
        "without one, the bundled sam_bot",
    )
    config: PathLike | RvizConfig | None = option(
        None,
        "a .rviz file; by default the one that belongs to the model, or the bundled "
        "one",
        "-d",
        "--display-config",
        group="config",
        word="rvizconfig",
        metavar="FILE",
    )
    _: KW_ONLY
    xacro_args: Mapping[str, str] = option(
        None, "arguments for xacro, name → text", factory=dict
    )
    package_path: Sequence[PathLike] = option(
        (),
        f"a folder with ROS packages{AGAIN}",
        "--package-path",
        group="model",
        metavar="DIR",
        read=words_of,
    )
    workspace: Sequence[PathLike] = option(
        (),
        "a folder of packages: those that start the robot or have its parameters are "
        f"checked with it{AGAIN}",
        "--workspace",
        group="check",
        metavar="DIR",
        read=words_of,
    )
    trusted: bool = option(
        True,
        "evaluate the model without file access and attribute access, for files you "
        "do not trust",
        "--untrusted",
        group="model",
        switch="off",
    )
    source: Sequence[str] | str = option(
        (),
        "what moves the robot: a recording (an mcap, db3 or bag file, or a folder with "
        f"them{AGAIN}), https://…/run.mcap on a web server, https://…/NAME/ of one "
        f"that is still recorded, {LIVE_SOURCES} of a live robot; NAME=URI gives it a "
        "name",
        "--source",
        group="source",
        metavar="[NAME=]URI",
        read=words_of,
    )
    source_prefix: Mapping[str, str] = option(
        None,
        "a prefix for the topics and frames of a source that has a name, so that "
        f"robots with the same names are shown together{AGAIN}",
        "--source-prefix",
        group="source",
        metavar="NAME=PREFIX",
        factory=dict,
        read=named_words,
    )
    remap: Sequence[str] = option(
        (),
        "show a topic TO of the sources as FROM, the name that the config has for it, "
        f"as RViz does for --ros-args -r FROM:=TO{AGAIN}",
        "--remap",
        group="source",
        metavar="FROM:=TO",
        read=words_of,
    )
    at: float | None = option(
        None,
        "the time of a recording to look at [s from its first message]; by default the "
        "page plays it from the beginning, and other commands take all of it",
        "--at",
        group="source",
        type=float,
        metavar="SECONDS",
    )
    msg_path: Sequence[PathLike] = option(
        (),
        "a folder with definitions of messages (PACKAGE/msg/NAME.msg) that a recording "
        f"lacks{AGAIN}",
        "--msg-path",
        group="source",
        metavar="DIR",
        read=words_of,
    )
    record: PathLike | None = option(
        None,
        "record all topics of a live robot to this mcap file; an existing file is "
        "never overwritten",
        "--record",
        metavar="FILE",
    )
    record_dir: PathLike | None = option(
        None,
        "offer the user in control a button that records all topics of a live robot to "
        "a new mcap file in this folder, named after date and time",
        "--record-dir",
        metavar="DIR",
    )
    max_bag_duration: float | None = option(
        None,
        "with --record-dir: each recording is a folder, as of ros2 bag, whose file is "
        "closed and the next one begun after this time, such as 5s; others can follow "
        "it over a web server with --source http://…/NAME/",
        "--max-bag-duration",
        type=duration,
        metavar="TIME",
    )
    publish: str | None = option(
        None,
        "what users in control may send to a live robot: goal, pose (an estimate "
        "of where it is), point, drive, joints (of the sliders), markers (interactive "
        "ones), description (the model when it is saved), or several with commas; "
        "without a value all of them",
        "--publish",
        metavar="KINDS",
        optional_value="word",
    )
    publish_log: PathLike | None = option(
        None,
        "append a line of JSON to this file for each message that is sent to the robot",
        "--publish-log",
        metavar="FILE",
    )
    cmd_vel: str = option(
        "/cmd_vel",
        "the topic for velocities of a live robot",
        "--cmd-vel",
        metavar="TOPIC",
    )
    max_linear: float = option(
        0.2,
        "maximum speed of a live robot driven by hand [m/s]",
        "--max-linear",
        type=float,
        metavar="SPEED",
    )
    max_angular: float = option(
        0.5,
        "maximum turn rate of a live robot driven by hand [rad/s]",
        "--max-angular",
        type=float,
        metavar="SPEED",
    )
    fixed_frame: str | None = option(
        None,
        "the fixed frame, instead of the config's",
        "-f",
        "--fixed-frame",
        group="view",
        metavar="FRAME",
    )
    reference: PathLike | Robot | None = option(
        None,
        "another model, or its package folder, to compare the robot with: what differs "
        "is drawn as a ghost, and listed in the panel Compare",
        "--reference",
        group="compare",
        metavar="FILE",
    )
    look: Look | None = option(
        None,
        "look of the 3D view: as RViz draws it, or with soft light and round shapes; "
        "by default rviz with a config of yours or the model's, else studio; "
        "the menu View changes it for one browser",
        "--look",
        group="view",
        choices=("rviz", "studio"),
    )
    joint_positions: Mapping[str, float] = option(
        None,
        f"position of a joint at the start [rad, m, or as 90deg]{AGAIN}",
        "--joint",
        factory=dict,
        group="pose",
        metavar="NAME=VALUE",
        read=assignments,
    )
    zeros: Mapping[str, float] = option(
        None,
        f"start value of a joint, as joint_state_publisher's zeros.NAME{AGAIN}",
        "--zeros",
        factory=dict,
        group="pose",
        metavar="NAME=VALUE",
        read=assignments,
    )
    joint_state: PathLike | None = option(
        None,
        "a yaml file with joint positions, as printed by ros2 topic echo",
        "--joint-state",
        group="pose",
        metavar="FILE",
    )
    static_transforms: Sequence[StaticTransform | str] = option(
        (),
        "add a frame: the arguments of static_transform_publisher, with or without "
        f"its flags such as --x, all in one pair of quotes{AGAIN}",
        "--static-transform",
        group="pose",
        metavar='"X Y Z YAW PITCH ROLL PARENT CHILD"',
        read=static_transforms,
    )
    gui: bool = option(
        True, "the Joints panel with its sliders", "--gui", word="gui", switch="yes-no"
    )
    host: str = option(
        "127.0.0.1", "the address to listen on", "--host", group="listen"
    )
    port: int = option(
        0,
        "the port to listen on; 0 takes any free one",
        "--port",
        group="listen",
        type=int,
        flag_default=8080,
    )
    unix_socket: PathLike | None = option(
        None,
        "listen on a socket in the file system instead of a port, for a proxy of the "
        "same user: no other user can open it",
        "--unix-socket",
        group="listen",
        metavar="PATH",
    )
    allowed_origins: Sequence[str] = option(
        (),
        "another name of this machine, or an origin that may use the server, "
        f"such as https://lab.example.org for one behind a proxy{AGAIN}",
        "--allow-origin",
        group="listen",
        metavar="ORIGIN",
        read=words_of,
    )
    base_path: str = option(
        "/",
        "path under which a proxy shows the page, such as /robot for https://lab.example.org/robot/",
        "--base-path",
        group="listen",
        metavar="PATH",
    )
    token: str | None = option(
        None,
        "require this token to open the page (generated when no VALUE is given); by "
        "default the value of the variable SAMBOT_VIZ_TOKEN",
        "--token",
        group="listen",
        metavar="VALUE",
        optional_value="word",
        variable="SAMBOT_VIZ_TOKEN",
    )
    presenter: str | None = option(
        None,
        "presenter mode: print a second, secret link; only its holder can change the "
        "robot. The others are viewers: they can request control, or open a private "
        "copy (the secret is generated when no VALUE is given); by default the value "
        "of the variable SAMBOT_VIZ_PRESENTER",
        "--presenter",
        metavar="=VALUE",
        optional_value="=",
        variable="SAMBOT_VIZ_PRESENTER",
    )
    broadcast: str | None = option(
        None,
        "publish what pages show through a router of zenoh, for any number of servers "
        "with --follow",
        "--broadcast",
        metavar="zenoh://ROUTER:7447/NAME",
    )
    follow: str | None = option(
        None,
        "show what another sambot-viz broadcasts, in place of a model: its pages only "
        "look, and lead there to request control",
        "--follow",
        metavar="zenoh://ROUTER:7447/NAME",
    )
    slot: float | None = option(
        None,
        "with --presenter: viewers who request control have it one after the other, "
        "each for this long while others wait, such as 4min or 90s",
        "--slot",
        type=duration,
        metavar="TIME",
    )
    metrics: bool = option(
        False,
        "count clients, bytes, sources and problems for Prometheus, at /metrics of the "
        "same address and with the same token",
        "--metrics",
        group="counts",
        switch="yes-no",
    )
    log_format: LogFormat = option(
        "text",
        "how notes and warnings are written to standard error: as text, or each as a "
        "line of JSON with time, level, logger and message",
        "--log-format",
        choices=("text", "json"),
    )
    trust_user_header: str | None = option(
        None,
        "name viewers after this request header, such as X-Remote-User; only "
        "behind a proxy that sets it and that alone can reach the port: others could "
        "send any name",
        "--trust-user-header",
        metavar="HEADER",
    )
    session: SessionMode = option(
        "shared",
        "one robot for all open pages, or one for each",
        "--session",
        choices=("shared", "private"),
    )
    fullscreen: bool = option(
        False,
        "open pages with their panels hidden; H shows them",
        "--fullscreen",
        switch="yes-no",
    )
    watch: bool = option(
        False,
        "reload the model, its meshes and the config when they are saved",
        "--watch",
        switch="yes-no",
        flag_default=True,
    )
    edit: bool = option(
        False,
        "browsers may change the model's files on this computer: whoever has control "
        "writes in Model and applies fixes in Problems, only inside the package of the "
        "model",
        "--edit",
        switch="yes-no",
    )
    left_wheel: str | None = option(
        None,
        "the joint of the left wheel to drive with",
        "--left-wheel",
        metavar="JOINT",
    )
    right_wheel: str | None = option(
        None,
        "the joint of the right wheel to drive with",
        "--right-wheel",
        metavar="JOINT",
    )
    wheel_radius: float | None = option(
        None,
        "radius of the wheels [m]; by default the model's",
        "--wheel-radius",
        type=float,
        metavar="METRES",
    )
    wheel_separation: float | None = option(
        None,
        "distance of the wheels [m]; by default the model's",
        "--wheel-separation",
        type=float,
        metavar="METRES",
    )
    poses: PathLike | None = option(
        None,
        "the yaml file for named poses; by default one beside the model, for the "
        "bundled robot in the working folder",
        "--poses",
        metavar="FILE",
    )
    panels: bool = option(
        True, "whether the page has panels; without them the 3D view fills it"
    )
    study: Study | None = option(
        None,
        "a student's way through a lesson, which the page shows beside the robot",
    )
    in_class: bool = option(
        False,
        "whether it is the page of a student in a class: those who look at it can only "
        "look, and nobody is invited",
    )
    on_reload: Callable[[Sequence[Problem]], None] | None = option(
        None,
        "called with the problems of the model and the config whenever a reload "
        "changes them",
    )
    notes: Sequence[Problem] = option(
        (), "findings that the page shows with those of the model"
    )
    sources: tuple[GivenSource, ...] = field(init=False, repr=False, compare=False)
    recorded: Mapping[str, float] = field(init=False, repr=False, compare=False)
    transforms: tuple[StaticTransform, ...] = field(
        init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        self._take_source()
        for each in declared(Options):
            check_choice(each, getattr(self, each.name))
        if self.fixed_frame is not None and not self.fixed_frame.strip():
            raise UsageError(
                "the fixed frame has an empty name; give a frame of the robot, such "
                "as base_link"
            )
        object.__setattr__(self, "base_path", check_base_path(self.base_path))
        check_header(self.trust_user_header)
        for name in ("token", "presenter"):
            if (secret := getattr(self, name)) is not None:
                token = check_token(secret, f"--{name}") if secret else new_token()
                object.__setattr__(self, name, token)
        self._check_presenter()
        self._check_publish()
        self._check_edit()
        self._check_broadcast()
        object.__setattr__(self, "recorded", self._read_recorded())
        object.__setattr__(self, "transforms", self._read_transforms())

    def _take_source(self) -> None:
        """Take a recording that was given as the model for a source."""
        source = (self.source,) if isinstance(self.source, str) else tuple(self.source)
        model = self.model
        if isinstance(model, Path | str) and is_recording(model):
            source = (f"bag:{model}", *source)
            object.__setattr__(self, "model", None)
        elif isinstance(model, str) and "://" in model and _is_live(model):
            raise UsageError(
                f"'{model}' is the address of a robot, not a model: write --source "
                f"{model}"
            )
        # A comparison that is also false for NaN.
        if self.at is not None and not abs(self.at) <= LATEST:
            raise UsageError(
                f"--at {self.at:g} is not a time of a recording: give the seconds from "
                "its first message, such as 2.5"
            )
        if self.at is not None and not source:
            raise UsageError(
                f"--at {self.at:g} needs a recording: give its file, or --source FILE"
            )
        object.__setattr__(self, "source", source)
        sources = _given_sources(source, self.source_prefix, self.remap)
        object.__setattr__(self, "sources", sources)
        for flag, given in (
            ("--record", self.record),
            ("--record-dir", self.record_dir),
            ("--publish", self.publish),
            ("--publish-log", self.publish_log),
        ):
            if given is not None and not self.live_sources:
                raise UsageError(f"{flag} needs a live robot: --source {LIVE_SOURCES}")
        self._check_parts()

    def _check_parts(self) -> None:
        part_s = self.max_bag_duration
        if part_s is not None and self.record_dir is None:
            raise UsageError("--max-bag-duration needs --record-dir DIR")
        if part_s is not None and not SHORTEST_PART <= part_s <= LONGEST_PART:
            raise UsageError(
                f"--max-bag-duration {part_s:g}s: a file has from {SHORTEST_PART:g}s "
                f"to {LONGEST_PART / 60:g}min; write --max-bag-duration 5s"
            )

    def _check_publish(self) -> None:
        """Refuse to send what cannot be sent."""
        if self.publish_log is not None and self.publish is None:
            raise UsageError("--publish-log needs --publish: nothing is sent without")
        if self.publish is not None:
            from sambot_viz.publishing.outbound import kinds_of

            kinds_of(self.publish)
        for flag, speed in (
            ("--max-linear", self.max_linear),
            ("--max-angular", self.max_angular),
        ):
            if not 0.0 < speed < math.inf:
                raise UsageError(f"{flag} needs a speed above 0, not {speed:g}")

    def _check_presenter(self) -> None:
        if self.slot is not None and not SHORTEST_SLOT <= self.slot <= LONGEST_SLOT:
            raise UsageError(
                f"--slot {self.slot:g}s: a turn lasts from {SHORTEST_SLOT:g}s to "
                f"{LONGEST_SLOT / 60:g}min; write --slot 4min"
            )
        if self.presenter is None and self.slot is not None:
            raise UsageError(
                "--slot needs --presenter: its second link is for whoever looks after "
                "the robot, and need not be open"
            )
        if self.presenter is None:
            return
        if self.session == "private":
            raise UsageError(
                "--presenter needs a robot that all browsers share; leave "
                "--session private out"
            )
        if self.presenter == self.token:
            raise UsageError("--presenter and --token need different secrets")

    def _check_edit(self) -> None:
        """Refuse to let visitors, or a model of unknown origin, change files."""
        if self.edit and self.session == "private":
            raise UsageError(
                "--edit needs a robot that all browsers share; leave --session private "
                "out"
            )
        if self.edit and not self.trusted:
            raise UsageError(
                "--edit changes files, and --untrusted is for models that must not "
                "touch any; leave one of them out"
            )

    def _check_broadcast(self) -> None:
        """Refuse what cannot be broadcast, and a follower that shows something else."""
        for flag, uri in (("--broadcast", self.broadcast), ("--follow", self.follow)):
            if uri is not None:
                from sambot_viz.sources.broadcast_place import parse_place

                parse_place(uri, flag)
        if self.broadcast is not None and self.session == "private":
            raise UsageError(
                "--broadcast needs a robot that all browsers share; leave "
                "--session private out"
            )
        others = (
            ("MODEL", self.model),
            ("--display-config", self.config),
            ("--source", self.source or None),
            ("--broadcast", self.broadcast),
            ("--presenter", self.presenter),
            ("--metrics", self.metrics or None),
        )
        given = [flag for flag, value in others if value is not None]
        if self.follow is not None and given:
            raise UsageError(
                f"--follow shows what another server broadcasts: leave {given[0]} out, "
                "or give it to that server"
            )

    def learning(self, study: Study) -> Options:
        """Return the same options for a student who writes the files of a study."""
        model = study.model_of(study.step)
        return self.having(model=model, study=study, watch=True, edit=True)

    def having(self, **values: object) -> Options:
        """Return the same options with other values; no file is read again."""
        changed = copy(self)
        for name, value in values.items():
            object.__setattr__(changed, name, value)
        return changed

    @property
    def live_sources(self) -> tuple[GivenSource, ...]:
        """The live robots among the sources."""
        return tuple(one for one in self.sources if one.is_live)

    @property
    def waits_for_robot(self) -> bool:
        """Whether the robot is the one that a live source will describe."""
        live = self.live_sources
        return self.model is None and bool(live) and live == self.sources

    @property
    def names_wheels(self) -> bool:
        """Whether they say anything of the wheels to drive with."""
        wheels = (self.left_wheel, self.right_wheel)
        return (*wheels, self.wheel_radius, self.wheel_separation) != (None,) * 4

    @property
    def start_pose(self) -> StartPose:
        """The pose that `zeros`, `joint_state` and `joint_positions` ask for."""
        from sambot_viz.joints.presets import StartPose

        return StartPose(self.zeros, self.recorded, self.joint_positions)

    def _read_recorded(self) -> Mapping[str, float]:
        if self.joint_state is None:
            return {}
        from sambot_viz.joints.value_texts import load_joint_state

        return load_joint_state(Path(self.joint_state))

    def _read_transforms(self) -> tuple[StaticTransform, ...]:
        if not self.static_transforms:
            return ()
        from sambot_viz.frames.static_transform import parse_static_transform

        return tuple(
            parse_static_transform(given) if isinstance(given, str) else given
            for given in self.static_transforms
        )
