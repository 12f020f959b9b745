"""The command line: flags to calls, and errors to exit codes. Nothing else does that.

Exit codes: 0 fine, 1 errors found, 2 the command line makes no sense, 3 a fault of
ours. Imports stand inside the commands, so that each loads only what it needs.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from sambot_viz import report
from sambot_viz._version import __version__
from sambot_viz.errors import (
    ConfigError,
    RobotError,
    SambotVizError,
    UsageError,
)

OK, ERRORS, USAGE, FAULT = 0, 1, 2, 3
_ARGUMENT = re.compile(r"\s*([A-Za-z_][\w.-]*)\s*:=(.*)", re.DOTALL)
_LAUNCH_ARGUMENTS = ("model", "rvizconfig", "gui")

EPILOG = """\
commands:
  sambot-viz [MODEL]           show a robot in the browser
  sambot-viz check MODEL       say what is wrong with a model, and how to mend it
  sambot-viz expand MODEL      print the URDF that xacro makes of a model

MODEL is a URDF or xacro file, whatever its ending, or a package folder; without
one, the bundled sam_bot is shown. NAME:=VALUE is an argument for xacro, anywhere on
the line; model:=, rvizconfig:= and gui:= mean what they mean to display.launch.py.
"""


class _Parser(argparse.ArgumentParser):
    """One clear line for a bad command line, instead of the whole usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(USAGE, f"{self.prog}: error: {message}; see {self.prog} --help\n")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        argv: the words after the program's name; None takes those of the process.

    Returns:
        The exit code.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    commands: dict[str, Callable[[list[str]], int]] = {
        "check": _check,
        "expand": _expand,
    }
    command = commands.get(words[0]) if words else None
    try:
        return command(words[1:]) if command else _show(words)
    except (RobotError, ConfigError) as error:
        report.write(error.problems)
        return ERRORS
    except UsageError as error:
        return _complain(error, USAGE)
    except SambotVizError as error:
        return _complain(error, ERRORS)
    except KeyboardInterrupt:
        return OK
    except BrokenPipeError:
        # The reader of our output has gone (`| head`); nothing more to say to it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except Exception as error:
        return _fault(error, "--debug" in words)


def _complain(error: SambotVizError, code: int) -> int:
    sys.stderr.write(f"sambot-viz: error: {error}\n")
    return code


def _fault(error: Exception, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    else:
        sys.stderr.write(
            f"sambot-viz: internal error: {type(error).__name__}: {error}; run again "
            "with --debug for the place, and please report it\n"
        )
    return FAULT


def _split(words: list[str]) -> tuple[list[str], dict[str, str]]:
    """Take the NAME:=VALUE words out of a command line."""
    rest: list[str] = []
    arguments: dict[str, str] = {}
    for word in words:
        match = _ARGUMENT.fullmatch(word)
        if match:
            arguments[match[1]] = match[2].strip()
        else:
            rest.append(word)
    return rest, arguments


def _model_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "model", nargs="?", metavar="MODEL", help="model file or folder"
    )
    parser.add_argument(
        "--model", dest="model_option", metavar="PATH", help="the same, by name"
    )
    parser.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="DIR",
        help="a folder with ROS packages; may be given several times",
    )
    parser.add_argument(
        "--untrusted",
        action="store_true",
        help="take from xacro what a stranger's file could misuse",
    )
    parser.add_argument(
        "--debug", action="store_true", help="show where a fault of ours comes from"
    )


def _model(options: argparse.Namespace, arguments: dict[str, str]) -> Path | None:
    named = [options.model, options.model_option, arguments.pop("model", None)]
    given = [name for name in named if name is not None]
    if len(given) > 1:
        raise UsageError(f"two models given: '{given[0]}' and '{given[1]}'; name one")
    return Path(given[0]) if given else None


def _show(words: list[str]) -> int:
    parser = _Parser(
        prog="sambot-viz",
        description="Show a URDF or xacro robot in the browser: no ROS, no X server.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    _model_options(parser)
    add = parser.add_argument
    add("--version", action="version", version=f"sambot-viz {__version__}")
    add("-d", "--display-config", metavar="FILE", help="a .rviz file")
    add("-f", "--fixed-frame", metavar="FRAME", help="overrides the config's")
    add(
        "--gui",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="the Joints panel with its sliders (default: yes)",
    )
    add(
        "--host",
        default="127.0.0.1",
        help="address to listen on (default: %(default)s)",
    )
    add("--port", type=int, default=8080, help="default: %(default)s; 0: any free one")
    add(
        "--session",
        choices=("shared", "private"),
        default="shared",
        help="one robot for all browsers, or one for each (default: %(default)s)",
    )
    add("--open", action="store_true", help="open the page in this machine's browser")
    rest, arguments = _split(words)
    return _serve(parser.parse_args(rest), arguments)


def _serve(options: argparse.Namespace, arguments: dict[str, str]) -> int:
    from sambot_viz.find import find
    from sambot_viz.loading import in_thread
    from sambot_viz.robot.loading import load_robot

    model = _model(options, arguments)
    config = options.display_config or arguments.pop("rvizconfig", None)
    gui = _gui(options.gui, arguments.pop("gui", None))
    found = find(model, Path(config) if config else None)
    # The robot is read while viser, which is slower to import, is being imported.
    loading = in_thread(
        lambda: load_robot(
            found.model,
            xacro_args=arguments,
            package_path=options.package_path,
            trusted=not options.untrusted,
        )
    )
    from sambot_viz.visualizer import Visualizer

    stop = threading.Event()
    _stop_on_signals(stop)
    with Visualizer(
        model=loading,
        config=found.config,
        host=options.host,
        port=options.port,
        fixed_frame=options.fixed_frame,
        gui=gui,
        session=options.session,
        xacro_args=arguments,
        package_path=options.package_path,
        on_open=lambda url: _announce(url, options.open),
    ):
        report.write(loading.result().problems)
        stop.wait()
    return OK


def _announce(url: str, open_it: bool) -> None:
    print(url, flush=True)
    if open_it:
        import webbrowser

        webbrowser.open(url)


def _stop_on_signals(stop: threading.Event) -> None:
    """Ctrl-C and a service manager's stop end the program quietly."""

    def finish(number: int, frame: object) -> None:
        del number, frame
        stop.set()

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


def _check(words: list[str]) -> int:
    parser = _Parser(
        prog="sambot-viz check",
        description="Say what is wrong with a model, where, and how to mend it. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    _model_options(parser)
    parser.add_argument("--format", choices=("text", "json"), default="text")
    rest, arguments = _split(words)
    options = parser.parse_args(rest)
    from sambot_viz.checks import check
    from sambot_viz.find import find

    model = find(_model(options, arguments)).model
    problems = check(model, xacro_args=arguments, package_path=options.package_path)
    if options.format == "json":
        found = [problem.as_json() for problem in problems]
        print(json.dumps({"model": str(model), "problems": found}, indent=2))
    else:
        report.write(problems, sys.stdout)
        if not problems:
            print(f"{model}: no problems found")
    return ERRORS if any(p.severity == "error" for p in problems) else OK


def _expand(words: list[str]) -> int:
    parser = _Parser(
        prog="sambot-viz expand",
        description="Print the URDF that xacro makes of a model.",
    )
    _model_options(parser)
    rest, arguments = _split(words)
    options = parser.parse_args(rest)
    from sambot_viz.find import find
    from sambot_viz.robot.loading import expand

    sys.stdout.write(
        expand(
            find(_model(options, arguments)).model,
            xacro_args=arguments,
            package_path=options.package_path,
            trusted=not options.untrusted,
        )
    )
    return OK


if __name__ == "__main__":
    sys.exit(main())
