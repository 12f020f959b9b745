"""The command line: which command runs, and what its errors mean as exit codes.

Exit codes: 0 fine, 1 errors found, 2 a command line that makes no sense, 3 an internal
error, 130 ended by Ctrl-C (which ends a server with 0). The commands are files of
`commands/`, loaded when they are called, so that each imports only what it needs.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Sequence

from sambot_viz.errors import (
    ConfigError,
    LessonError,
    Problem,
    RobotError,
    SambotVizError,
    SourceError,
    UsageError,
    nearest,
)
from sambot_viz.outlet import drop_output, guarded, write_err, write_traceback
from sambot_viz.problems import write_problems

OK, ERRORS, USAGE, INTERNAL, INTERRUPTED = 0, 1, 2, 3, 130

COMMANDS = (
    "check",
    "class",
    "completion",
    "config",
    "diff",
    "echo",
    "expand",
    "export",
    "frames",
    "goal",
    "grade",
    "graph",
    "index",
    "lesson",
    "snapshot",
    "topics",
)
"""Modules of `commands/` with ``run(words) -> exit code``; "show" is the default."""


def main(argv: Sequence[str] | None = None, notes: Sequence[Problem] = ()) -> int:
    """Run one command.

    Args:
        argv: the words after the program's name; None takes those of the process.
        notes: findings that the page shows with those of the model.

    Returns:
        The exit code.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    with guarded():
        return _run(words, notes)


def _run(words: list[str], notes: Sequence[Problem]) -> int:
    name = words.pop(0) if words and words[0] in COMMANDS else "show"
    try:
        if name == "show" and words and not words[0].startswith("-"):
            _refuse_mistyped(words[0])
        command = importlib.import_module(f"sambot_viz.commands.{name}")
        return int(command.run(words, notes) if notes else command.run(words))
    except (RobotError, ConfigError, LessonError, SourceError) as error:
        if not error.problems:
            return _complain(error, ERRORS)
        write_problems(error.problems)
        return ERRORS
    except UsageError as error:
        return _complain(error, USAGE)
    except SambotVizError as error:
        return _complain(error, ERRORS)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of standard output has gone (`| head`): nothing more is wanted.
        drop_output()
        return OK
    except Exception as error:
        return _internal_error(error, "--debug" in words)


def _refuse_mistyped(word: str) -> None:
    """Raise UsageError for a word that is not a file, and nearly a command."""
    near = nearest(word, COMMANDS, likeness=0.7)
    if near is not None and not os.path.exists(word):
        raise UsageError(
            f"'{word}' is neither a model nor a command; did you mean '{near}'?"
        )


def _complain(error: SambotVizError, code: int) -> int:
    first, *rest = str(error).split("\n")
    write_err(f"sambot-viz: error: {first}", *rest)
    return code


def _internal_error(error: Exception, debug: bool) -> int:
    if debug:
        write_traceback(error)
    else:
        write_err(
            f"sambot-viz: internal error: {type(error).__name__}: {error}; run again "
            "with --debug to see where, and please report it"
        )
    return INTERNAL


if __name__ == "__main__":
    sys.exit(main())
