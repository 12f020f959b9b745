"""``sambot-viz``: a robot in the browser."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from xml.etree import ElementTree

from sambot_viz import problem_text
from sambot_viz._version import __version__
from sambot_viz.background import Loading, give_up, in_thread
from sambot_viz.bundled import Found, find
from sambot_viz.commands.options import ModelOptions, Parser, add_model_options, parse
from sambot_viz.commands.pose_options import add_pose_options, any_given, read_setup
from sambot_viz.errors import Problem, UsageError

EPILOG = """\
commands:
  sambot-viz [MODEL]           show a robot in the browser
  sambot-viz check MODEL       say what is wrong with a model, and how to mend it
  sambot-viz expand MODEL      print the URDF that xacro makes of a model
  sambot-viz echo MODEL SOURCE TARGET
                               print the pose of a frame in another, as tf2_echo does
  sambot-viz frames MODEL [-o FILE.svg|.dot|.json]
                               draw the tree of frames
  sambot-viz snapshot MODEL -o FILE.png
                               write a picture of the 3D view
  sambot-viz config FILE.rviz  say what of an RViz config is shown

MODEL is a URDF or xacro file, whatever its ending, or a package folder; without
one, the bundled sam_bot is shown. NAME:=VALUE is an argument for xacro, anywhere on
the line; model:=, rvizconfig:= and gui:= mean what they mean to display.launch.py.
"""

_OPEN_TO_ALL = """\
sambot-viz: note: everybody who can reach port {} of this machine can see the robot and
move its joints; without --host only this machine can
"""


def run(words: list[str]) -> int:
    """Serve until Ctrl-C."""
    options, wanted = parse(_parser(), words, ours=("rvizconfig", "gui"))
    config = options.display_config or wanted.words.get("rvizconfig")
    found = find(wanted.model, Path(config) if config else None)
    gui = _gui(options.gui, wanted.words.get("gui"))
    setup = read_setup(options) if any_given(options) else None
    _refuse_early(wanted, found)
    from sambot_viz.server.access import only_this_machine
    from sambot_viz.server.bind import close, listen, url_of

    stop, waited_for = threading.Event(), list[Loading]()
    _stop_on_signals(stop, waited_for)
    server = listen(options.host, options.port, options.allow_origin)
    try:
        _announce(url_of(server), options.open)
        if not only_this_machine(options.host):
            sys.stderr.write(_OPEN_TO_ALL.format(server.get_port()))
        # From here on a browser can load the page; the rest is imported meanwhile.
        loading = in_thread(partial(wanted.load, found.model))
        waited_for.append(loading)
        from sambot_viz.session.drive_control import WheelOptions
        from sambot_viz.visualizer import Visualizer

        with Visualizer(
            model=loading,
            config=found.config,
            fixed_frame=options.fixed_frame,
            gui=gui,
            session=options.session,
            xacro_args=wanted.xacro_args,
            package_path=wanted.package_path,
            server=server,
            trusted=wanted.trusted,
            watch=options.watch,
            on_reload=_report_reload,
            zeros=setup.start.zeros if setup else None,
            joint_positions=setup.start.positions if setup else None,
            joint_state=options.joint_state,
            static_transforms=setup.static_transforms if setup else (),
            wheels=WheelOptions(
                options.left_wheel,
                options.right_wheel,
                options.wheel_radius,
                options.wheel_separation,
            ),
            poses=options.poses,
        ):
            problem_text.write(loading.result().problems)
            stop.wait()
    finally:
        close(server)
    return 0


def _refuse_early(wanted: ModelOptions, found: Found) -> None:
    """Tell what is plainly wrong before an address is shown.

    Raises:
        RobotError: the model is no XML.
        ConfigError: the config is no .rviz document.
    """
    if not _is_xml(found.model):
        wanted.load(found.model)
    if found.config is not None:
        from sambot_viz.rviz import Declarations, RvizConfig

        RvizConfig.load(found.config, Declarations())


def _is_xml(path: Path) -> bool:
    """Whether a model is well-formed; a quick look that imports next to nothing."""
    try:
        ElementTree.fromstring(path.read_bytes())
    except (ElementTree.ParseError, ValueError, LookupError, OSError):
        return False
    return True


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="sambot-viz",
        description="Show a URDF or xacro robot in the browser: no ROS, no X server.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_model_options(parser)
    add = parser.add_argument
    add("--version", action="version", version=f"sambot-viz {__version__}")
    add("-d", "--display-config", metavar="FILE", help="a .rviz file")
    add("-f", "--fixed-frame", metavar="FRAME", help="overrides the config's")
    add(
        "--gui",
        action=argparse.BooleanOptionalAction,
        help="the Joints panel with its sliders (default: yes)",
    )
    add("--host", default="127.0.0.1", help="where to listen (default: %(default)s)")
    add("--port", type=int, default=8080, help="default: %(default)s; 0: any free one")
    add(
        "--allow-origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="a web page of another origin that may use the server, such as "
        "https://lab.example.org for one behind a proxy",
    )
    add(
        "--session",
        choices=("shared", "private"),
        default="shared",
        help="one robot for all browsers, or one for each (default: %(default)s)",
    )
    add(
        "--watch",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="show the model, its meshes and the config again when they are saved "
        "(default: yes)",
    )
    add_pose_options(parser)
    add("--left-wheel", metavar="JOINT", help="the left wheel to drive with")
    add("--right-wheel", metavar="JOINT", help="the right wheel to drive with")
    add("--wheel-radius", type=float, metavar="METRES", help="default: the model's")
    add("--wheel-separation", type=float, metavar="METRES", help="default: the model's")
    add(
        "--poses",
        metavar="FILE",
        help="where named poses are kept (default: beside the model)",
    )
    add("--open", action="store_true", help="open the page in this machine's browser")
    return parser


def _report_reload(problems: Sequence[Problem]) -> None:
    """Say what a save has brought, on the terminal as in the page."""
    if problems:
        problem_text.write(problems)
    else:
        sys.stderr.write("sambot-viz: no problems any more\n")


def _announce(url: str, open_it: bool) -> None:
    print(url, flush=True)
    if open_it:
        import webbrowser

        webbrowser.open(url)


def _stop_on_signals(stop: threading.Event, waited_for: list[Loading]) -> None:
    """Ctrl-C and a service manager's stop end the program quietly.

    Args:
        stop: is set then.
        waited_for: models that are being read, which may take long; the wait for them
            ends too.
    """

    def finish(number: int, frame: object) -> None:
        del number, frame
        stop.set()
        for loading in waited_for:
            give_up(loading)

    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, finish)


def _gui(flag: bool | None, word: str | None) -> bool:
    if flag is not None:
        return flag
    if word is None:
        return True
    if word.lower() not in ("true", "false", "1", "0"):
        raise UsageError(f"gui:={word} is neither true nor false")
    return word.lower() in ("true", "1")
