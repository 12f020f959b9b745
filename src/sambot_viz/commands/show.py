"""``sambot-viz``: a robot in the browser."""

from __future__ import annotations

import argparse
import ctypes
import os.path
import signal
import sys
import threading
from collections.abc import Callable, Generator, Sequence
from contextlib import (
    AbstractContextManager,
    contextmanager,
    nullcontext,
    suppress,
)
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from sambot_viz._version import __version__
from sambot_viz.commands.command_line import Parser, parse, warn
from sambot_viz.errors import Problem
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.outlet import write_code, write_err, write_out, write_records
from sambot_viz.problems import write_problems
from sambot_viz.waiting import wait_for

if TYPE_CHECKING:
    from sambot_viz.server.reference import ReferenceModel
    from sambot_viz.visualizer import Visualizer

EPILOG = """\
NAME:=VALUE, anywhere on the line, is an argument for xacro, as in ros2 launch.

commands:
  sambot-viz [MODEL]           show a robot in the browser
  sambot-viz check MODEL       report what is wrong with a model, and how to fix it
  sambot-viz expand MODEL      print the URDF that xacro makes from a model
  sambot-viz echo SOURCE TARGET MODEL
                               print the pose of a frame in another, as tf2_echo does
  sambot-viz frames MODEL [-o FILE.svg|.dot|.json]
                               draw the tree of frames
  sambot-viz snapshot MODEL -o FILE.png
                               write a picture of the 3D view
  sambot-viz export MODEL -o FILE.html
                               write the 3D view and a motion as one HTML file
  sambot-viz goal X Y YAW --source URI
                               send a robot on the network somewhere
  sambot-viz topics RECORDING  list the topics, and why nothing of one is seen
  sambot-viz config FILE.rviz  report what of an RViz config is shown
  sambot-viz completion SHELL  print what completes all this with the Tab key

MODEL is a URDF, SDF or xacro file, whatever its ending, a package folder or a recording
(mcap, db3 or ROS 1 bag); without one, the bundled sam_bot is shown. NAME:=VALUE is an
argument for xacro, anywhere on the line; model:=, rvizconfig:= and gui:= mean the same
as for display.launch.py.
"""

_OPEN_TO_ALL = (
    "sambot-viz: warning: anyone who can reach port {} of this machine can see the",
    "robot and move its joints; --token restricts access to those who have the link",
)


_NO_MEANING = "taken as RViz takes it; it has no meaning here"
_OF_RVIZ: Sequence[tuple[tuple[str, str], dict[str, Any], str]] = (
    (
        ("-t", "--display-title-format"),
        {"metavar": "FORMAT", "help": f"the title of the window: {_NO_MEANING}"},
        "the title of a page is the name of its config",
    ),
    (
        ("-l", "--ogre-log"),
        {"action": "store_true", "help": f"a log of Ogre: {_NO_MEANING}"},
        "nothing is drawn by Ogre",
    ),
    (
        ("-s", "--splash-screen"),
        {"metavar": "FILE", "help": f"a picture at the start: {_NO_MEANING}"},
        "a page has no splash screen",
    ),
)
"""Flags that only RViz has a use for: names, how they are added, and a warning."""

_WAITING = (
    "sambot-viz: note: the page is open and will load the file once its errors are "
    "fixed"
)


_LARGE_BLOCK = 2**22
"""A block of this size goes back to the system as soon as it is free [bytes]."""
_KEPT = 2**23
"""Freed memory that each thread keeps [bytes]: messages with clouds need it again and
again, and getting it from the system costs more than filling it."""
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3


def run(words: list[str], notes: Sequence[Problem] = ()) -> int:
    """Serve until Ctrl-C.

    While files are followed, a model or a config with a mistake is served too: the page
    shows the mistake, and the robot once it is fixed.

    Args:
        words: the command line.
        notes: findings that the page shows with those of the model.
    """
    given, options = parse(parser(), words, notes=notes)
    for (_, flag), _, why in _OF_RVIZ:
        if getattr(given, flag.removeprefix("--").replace("-", "_")):
            warn(f"{flag} has no meaning here: {why}")
    serve(options, given.open)
    return 0


def serve(
    options: Options,
    open_it: bool,
    beside: Callable[[Visualizer], AbstractContextManager[object]] = nullcontext,
) -> None:
    """Show the page of some options until Ctrl-C.

    Args:
        options: the inputs; while their files are followed, changes are reported.
        open_it: whether to open the page in this machine's browser.
        beside: what else is done as long as the page is shown.
    """
    _return_large_blocks()
    if options.follow is not None:
        write_records(options.log_format == "json")
        _follow(options, open_it)
        return
    report = _Reports()
    report.model = options.model
    options = options.having(on_reload=report)
    write_records(options.log_format == "json")
    with Inputs(options, may_be_broken=options.watch) as inputs:
        _serve(inputs, report, open_it, beside)
    _report_recording(inputs)


def _serve(
    inputs: Inputs,
    report: _Reports,
    open_it: bool,
    beside: Callable[[Visualizer], AbstractContextManager[object]],
) -> None:
    """Show the page until Ctrl-C; with `open_it` in this machine's browser."""
    options = inputs.options
    # The port is opened first; the rest of the program is imported, and the robot
    # loaded, while a browser loads the page.
    from sambot_viz.server.listener import listen

    with until_signal(inputs.give_up) as stop, listen(options) as listener:
        try:
            _refuse_early(inputs)
            announce(options, listener.viser.get_port(), open_it)
            inputs.begin()
            from sambot_viz.commands.first_notes import write_notes
            from sambot_viz.visualizer import Visualizer

            with (
                Visualizer.of_inputs(inputs, listener) as visualizer,
                beside(visualizer),
            ):
                _report_start(inputs, report, visualizer.server.sessions.reference)
                write_notes(stop, inputs, visualizer.server.sessions)
                wait_for(stop)
        except KeyboardInterrupt:
            pass  # Ctrl-C while the robot was loaded ends the server like one later.


def _follow(options: Options, open_it: bool) -> None:
    """Show what another server broadcasts until Ctrl-C."""
    from sambot_viz.server.followers.follower import follow
    from sambot_viz.server.listener import listen

    with until_signal() as stop, listen(options) as listener:
        announce(options, listener.viser.get_port(), open_it)
        end = follow(options, listener)
        try:
            wait_for(stop)
        finally:
            end()


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz",
        groups=(
            "model",
            "check",
            "source",
            "config",
            "view",
            "compare",
            "pose",
            "server",
            "listen",
            "counts",
        ),
        description="Show a URDF, SDF or xacro robot in the browser: no ROS, no X "
        "server.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = made.add_argument
    add("--version", action="version", version=f"sambot-viz {__version__}")
    made.add_open()
    for names, given, _ in _OF_RVIZ:
        add(*names, **given)
    return made


def _report_recording(inputs: Inputs) -> None:
    """Report the content of the recording of `--record`, after its end."""
    live, path = inputs.live, inputs.options.record
    if live is None or live.recorder is None or path is None:
        return
    # The first recording: the page's button may have made others since.
    status = (*live.recorder.ended, live.recorder.status)[0]
    if status is None or status.is_running:
        return
    lacks = status.trouble or status.missing
    write_err(
        f"sambot-viz: recorded {path}: {status.messages:,} messages in "
        f"{status.seconds:.1f} s, {status.size / 1e6:.1f} MB"
        f"{f'; {lacks}' if lacks else ''}"
    )


def _refuse_early(inputs: Inputs) -> None:
    """Raise the errors that end the program before it prints an address.

    Only checks that need the robot make the page wait for it.

    Raises:
        SambotVizError: options contradict each other, or a broken model is not
            followed.
    """
    options = inputs.options
    if options.transforms:
        from sambot_viz.frames import FrameTree

        tree = FrameTree()
        for added in options.transforms:
            tree.set_static(added.parent, added.child, added.transform)
    if inputs.poses is not None and os.path.exists(inputs.poses):
        inputs.presets()
    if options.waits_for_robot:
        return
    if not options.watch or options.joint_positions or options.zeros:
        if inputs.refusal() is None:
            options.start_pose.state(inputs.robot())


def _report_start(
    inputs: Inputs, report: _Reports, reference: ReferenceModel | None
) -> None:
    """Report the problems of the model, the config, the reference and the pose."""
    from sambot_viz.commands.command_line import start_state

    options = inputs.options
    of_reference = () if reference is None else reference.problems
    report.write((*inputs.problems(), *of_reference))
    if inputs.refusal() is None and not options.waits_for_robot:
        start_state(inputs.robot(), options)
    if inputs.refusal() or inputs.broken_config or of_reference:
        write_err(_WAITING)


class _Reports:
    """Reports problems at the start and after a reload, each of them once.

    Attributes:
        model: the model as the user wrote it.
    """

    model: object = None

    def __init__(self) -> None:
        self._written: set[Problem] = set()

    def __call__(self, problems: Sequence[Problem]) -> None:
        """Report the changes that a reload made."""
        if not problems:
            write_err("sambot-viz: all problems are fixed")
        elif self._written.issuperset(problems):
            write_err("sambot-viz: fixed; what is left is listed above")
        self.write(problems)

    def write(self, problems: Sequence[Problem]) -> None:
        """Write the problems that the last report did not have."""
        new = [problem for problem in problems if problem not in self._written]
        self._written = set(problems)
        write_problems(new, model=self.model)


def announce(
    options: Options,
    port: int,
    open_it: bool,
    below: str = "",
    whose: tuple[str, str] = ("viewers:   ", "presenter: "),
) -> None:
    """Write the addresses to open, and warn about who else can open them.

    Args:
        options: the address, and the secrets of the links.
        port: the port of the server.
        open_it: whether to open the page in this machine's browser: the presenter's,
            where there is one.
        below: path of the presenter's page below the page for everyone.
        whose: the readers of each link, where there is a presenter.
    """
    from sambot_viz.server.listener import page_url, public_url, reachable_at
    from sambot_viz.server.protection.access import only_this_machine

    def links(host: str) -> tuple[str, str | None]:
        own = page_url(options, host, port)
        if options.presenter is None:
            return own, None
        return own, page_url(options, host, port, below, presenter=True)

    link, presenter_link = links("")
    if presenter_link is None:
        _announce(link, open_it)
    else:
        # The wrong link in a chat would give the class thirty presenters.
        _announce(link, False, whose[0])
        _announce(presenter_link, open_it, whose[1])
    # The address that others can open: with a proxy it is not our own.
    public = public_url(options)
    if public is not None:
        presented = presenter_link is not None
        _invite(
            public, public_url(options, below, presenter=True) if presented else None
        )
    if not only_this_machine(options.host):
        if public is None:
            _invite(*links(reachable_at(options.host)))
        if options.token is None:
            write_err(*(line.format(port) for line in _OPEN_TO_ALL))


def announce_board(options: Options, port: int, open_it: bool) -> None:
    """Write the addresses of a board, which only its teacher opens.

    Args:
        options: the address, and the secret of the link.
        port: the port of the server.
        open_it: whether to open the board in this machine's browser.
    """
    from sambot_viz.server.listener import page_url, public_url

    _announce(page_url(options, "", port, "/board", presenter=True), open_it)
    public = public_url(options, "/board", presenter=True)
    if public is not None:
        write_err(f"sambot-viz: from other machines: {public}")


def _announce(url: str, open_it: bool, whose: str = "") -> None:
    write_out(f"{whose}{url}")
    if open_it:
        import webbrowser

        webbrowser.open(url)


def _invite(url: str, presenter_url: str | None) -> None:
    """Write the links for other machines, and draw one for the camera of a phone."""
    viewers = "" if presenter_url is None else ", viewers"
    write_err(f"sambot-viz: from other machines{viewers}: {url}")
    if presenter_url is not None:
        write_err(f"sambot-viz: from other machines, presenter: {presenter_url}")
    write_code(url)


@contextmanager
def until_signal(
    give_up: Callable[[], object] = lambda: None,
) -> Generator[threading.Event]:
    """Yield an event that Ctrl-C and a service manager's stop set, instead of raising.

    Args:
        give_up: called at that moment, to end the wait for a robot that loads.
    """
    # A handler runs in the middle of whatever this thread does, such as of waiting for
    # `stop`, whose lock is held just then: only a SimpleQueue may be used in it.
    signals: SimpleQueue[int] = SimpleQueue()
    stop = threading.Event()

    def finish() -> None:
        signals.get()
        stop.set()
        give_up()

    threading.Thread(target=finish, name="sambot-viz-signals", daemon=True).start()
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda number, _: signals.put(number))
    try:
        yield stop
    finally:
        # End the wait for a signal in the other thread.
        signals.put(0)


def _return_large_blocks() -> None:
    """Make Linux's C library return large blocks to the system; elsewhere do nothing.

    That library raises its threshold by itself up to 32 MB and keeps smaller blocks:
    after thirty pages with 50 MB of meshes each, it held 0.7 GB unused.
    """
    if sys.platform == "linux":
        # Other C libraries, such as that of Alpine, have no such function.
        with suppress(OSError, AttributeError):
            library = ctypes.CDLL(None)
            library.mallopt(_M_MMAP_THRESHOLD, _LARGE_BLOCK)
            library.mallopt(_M_TRIM_THRESHOLD, _KEPT)
