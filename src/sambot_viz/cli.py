"""The command line: flags to calls, and errors to exit codes. Nothing else does that.

Exit codes: 0 fine, 1 errors found, 2 the command line makes no sense, 3 a fault of
ours. The commands are files of `commands/`, loaded when they are called, so that each
imports only what it needs.
"""

from __future__ import annotations

import importlib
import os
import sys
import traceback
from collections.abc import Sequence

from sambot_viz import problem_text
from sambot_viz.errors import ConfigError, RobotError, SambotVizError, UsageError

OK, ERRORS, USAGE, FAULT = 0, 1, 2, 3

COMMANDS = ("check", "config", "echo", "expand", "frames", "snapshot")
"""Modules of `commands/` with ``run(words) -> exit code``; "show" is the default."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        argv: the words after the program's name; None takes those of the process.

    Returns:
        The exit code.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    name = words.pop(0) if words and words[0] in COMMANDS else "show"
    try:
        command = importlib.import_module(f"sambot_viz.commands.{name}")
        return int(command.run(words))
    except (RobotError, ConfigError) as error:
        problem_text.write(error.problems)
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


if __name__ == "__main__":
    sys.exit(main())
