"""Translate arguments of ROS and RViz into the flags that mean the same here."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.errors import UsageError

BEGIN, END = "--ros-args", "--"
_RULE = ("-r", "--remap")
_PARAMETER = ("-p", "--param")
_ONE_WORD = {
    "--params-file": "parameters of a node",
    "--log-level": "the level of ROS's log",
    "--log-file-name": "the name of ROS's log",
    "--log-config-file": "settings of ROS's log",
    "-e": "an enclave",
    "--enclave": "an enclave",
}
"""ROS's flags that take a value, and the name of the value: both are ignored."""
_LOGS = ("rosout", "stdout", "external-lib")
_ALONE = {f"--{on}able-{one}-logs" for on in ("en", "dis") for one in _LOGS}


def without_ros_arguments(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return a command line with remappings as flags, and warnings about the rest.

    Args:
        words: the command line; the words from ``--ros-args`` to ``--`` are ROS's.

    Raises:
        UsageError: a flag of ROS lacks its value, or does not exist.
    """
    left: list[str] = []
    notes: list[str] = []
    given = iter(words)
    for word in given:
        if word != BEGIN:
            # A separate word would be read as an argument of xacro.
            is_rule = word == _RULE[1]
            left.append(f"{word}={next(given, '')}" if is_rule else word)
            continue
        for word in given:
            if word == END:
                break
            flag, equals, value = word.partition("=")
            if flag in _ALONE:
                notes.append(f"{flag} has no meaning here: nothing is logged to ROS")
                continue
            if flag not in (*_RULE, *_PARAMETER, *_ONE_WORD):
                raise UsageError(f"{BEGIN}: '{word}' is none of ROS's flags")
            if not (value := value if equals else next(given, "")):
                raise UsageError(f"{BEGIN}: {flag} needs a word behind it")
            if flag in _RULE:
                left.append(f"{_RULE[1]}={value}")
            elif flag in _PARAMETER:
                notes.append(_parameter_note(value))
            else:
                notes.append(f"{flag} has no meaning here: it is {_ONE_WORD[flag]}")
    return left, notes


def _parameter_note(value: str) -> str:
    name, _, given = value.partition(":=")
    if name.rpartition(":")[2] == "use_sim_time":
        is_on = given.strip().lower() == "true"
        return (
            f"use_sim_time:={given}: the time of /clock is taken where a robot has one"
            + ("" if is_on else ", all the same")
        )
    return f"the parameter {name} has no meaning here"
