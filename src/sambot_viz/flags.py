"""Declare options: fields of a dataclass that are flags of the command line too.

`options.py` has the list; the command line, the documents and the checks of values
follow from the declaration of each field.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from typing import TYPE_CHECKING, Any, Literal

from sambot_viz.errors import UsageError

# A command line is read before anything heavy is imported.
if TYPE_CHECKING:
    from sambot_viz.frames.static_transform import StaticTransform

Group = Literal[
    "model",
    "check",
    "source",
    "config",
    "pose",
    "view",
    "compare",
    "server",
    "listen",
    "counts",
]
"""Groups of options for the same commands: all with a MODEL, those that check it, read
recordings and live robots, read a .rviz file, pose the robot, draw it, or draw another
one beside it, the one that serves a robot's page, those that serve any page, and those
that count."""
AGAIN = "; may be given several times"

SHORTEST_TOKEN = 8
"""Minimum length of a token that a user has chosen."""

_KEY = "option"
_BASE_PATH = re.compile(r"/|(/[A-Za-z0-9._~-]+)+")
_HEADER = re.compile(r"[A-Za-z0-9-]+")
_DURATION = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)\s*(s|min|h)", re.ASCII)
_UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
_TOKEN = re.compile(r"[A-Za-z0-9._~-]+")


@dataclass(frozen=True, slots=True)
class Flag:
    """The name of an option on the command line, and its meaning.

    Attributes:
        help: what the option does, without its default; also its documentation as a
            keyword argument.
        names: its flags, such as ``("-d", "--display-config")``; none for an option
            of the Python interface only.
        group: the group of commands that take it.
        word: its name as an argument of display.launch.py, for ``NAME:=VALUE``.
        metavar: the placeholder for its value in the help.
        default: the command line's default where it is not the keyword argument's.
        choices: all valid values.
        type: makes the value from one word; None keeps the text.
        read: makes the value from all words of an option that may be repeated, and
            the flag's name.
        optional_value: for a flag with an optional value ("" by default), the place of
            the value: the next word, or only after "=".
        variable: environment variable with the value for a command line without the
            flag; for secrets, which other users could read in the list of processes.
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


def option(
    default: Any,
    help: str,
    *names: str,
    factory: Callable[[], Any] | None = None,
    flag_default: object = None,
    **rest: Any,
) -> Any:
    """Make the field of an option.

    Args:
        default: default of the keyword argument.
        help: what the option does, without its default.
        names: its flags.
        factory: makes a mutable default.
        flag_default: default of the command line, where it differs.
        rest: further attributes of `Flag`.
    """
    flag = Flag(help, names, default=flag_default, **rest)
    if factory is not None:
        return field(default_factory=factory, metadata={_KEY: flag})
    return field(default=default, metadata={_KEY: flag})


def words_of(words: Sequence[str], flag: str) -> tuple[str, ...]:
    """Return the values of a flag that may be repeated."""
    del flag
    return tuple(words)


def named_words(words: Sequence[str], flag: str) -> dict[str, str]:
    """Read the NAME=WORD values of a flag that may be repeated.

    Raises:
        UsageError: a value has another form.
    """
    pairs = [word.partition("=") for word in words]
    for word, (name, equals, value) in zip(words, pairs, strict=True):
        if not (name and equals and value):
            raise UsageError(f"{flag}: '{word}' is not NAME={value or 'WORD'}")
    return {name: value for name, _, value in pairs}


def duration(word: str) -> float:
    """Read a time such as 90s or 4min [s].

    Raises:
        UsageError: it is none.
    """
    match = _DURATION.fullmatch(word)
    if match is None:
        raise UsageError(f"'{word}' is not a time: write seconds or minutes, as 4min")
    return float(match[1]) * _UNITS[match[2]]


def assignments(words: Sequence[str], flag: str) -> dict[str, float]:
    """Read NAME=VALUE words."""
    from sambot_viz.joints.value_texts import parse_assignments

    return parse_assignments(words, flag)


def static_transforms(words: Sequence[str], flag: str) -> list[StaticTransform]:
    """Read the arguments of static_transform_publisher."""
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


def declared(kind: type) -> Iterator[Field[Any]]:
    """Yield the options of a dataclass, in the order of the help."""
    return (each for each in fields(kind) if _KEY in each.metadata)


def flag_of(option: Field[Any]) -> Flag:
    """Return how an option is written on the command line."""
    flag: Flag = option.metadata[_KEY]
    return flag


def keyword_help(kind: type) -> str:
    """Return the options of a dataclass as the "Args" of a docstring."""
    lines = ["Args:"]
    for each in declared(kind):
        flag = flag_of(each)
        given = each.default not in (MISSING, None, ())
        default = f" (default: {each.default!r})" if given else ""
        lines.append(f"    {each.name}: {flag.help.removesuffix(AGAIN)}{default}.")
    return "\n".join(lines)


def check_choice(option: Field[Any], value: object) -> None:
    """Raise UsageError for a value that is none of the option's choices."""
    choices = flag_of(option).choices
    if choices and value not in choices and value != option.default:
        listed = " or ".join(f"'{choice}'" for choice in choices)
        raise UsageError(f"{option.name}={value!r}: it must be {listed}")


def new_token() -> str:
    """Return a token that cannot be guessed: 22 characters, 128 bits."""
    # Commands without a server must not wait for it.
    import secrets

    return secrets.token_urlsafe(16)


def check_header(name: str | None) -> None:
    """Raise UsageError for what cannot be the name of a header."""
    if name is not None and not _HEADER.fullmatch(name):
        raise UsageError(
            f"'{name}' cannot be the name of a header; give one such as X-Remote-User"
        )


def check_base_path(text: str) -> str:
    """Return a base path with a slash at its beginning and none at its end.

    Raises:
        UsageError: it cannot be part of an address.
    """
    path = f"/{text.strip('/')}"
    if not _BASE_PATH.fullmatch(path):
        raise UsageError(
            f"the base path '{text}' cannot be part of an address; give one such as "
            "/robot"
        )
    return path


def check_token(token: str, flag: str = "--token") -> str:
    """Return the token that a user has chosen.

    Args:
        token: the value of the flag.
        flag: the flag, for messages.

    Raises:
        UsageError: it is too short, would not survive in an address, or is a file: then
            it was probably meant as the model.
    """
    if os.path.exists(token):
        raise UsageError(
            f"{flag} has taken '{token}', which is a file, for its value; write the "
            f"model before {flag}"
        )
    if not _TOKEN.fullmatch(token):
        raise UsageError(
            f"{flag} '{token}': only letters, digits and . _ ~ - are allowed; leave "
            "the value out to have one generated"
        )
    if len(token) < SHORTEST_TOKEN:
        raise UsageError(
            f"{flag} '{token}' is too easy to guess; give at least {SHORTEST_TOKEN} "
            "characters, or leave the value out to have one generated"
        )
    return token
