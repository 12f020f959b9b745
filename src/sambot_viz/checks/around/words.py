"""Words that a program does not know, where another one of its vocabulary is meant."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import NamedTuple

from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.errors import Fix, Place, Problem, Severity, nearest

_LIKENESS = 0.75


class WordKind(NamedTuple):
    """What words of one kind have in common.

    Attributes:
        table: the vocabulary.
        code: of the problem.
        message: with {owner}, {wrong} and {right}.
        severity: of the problem.
    """

    table: str
    code: str
    message: str
    severity: Severity = "error"


class WrittenWord(NamedTuple):
    """A word as somebody wrote it.

    Attributes:
        owner: what has it: its row in the vocabulary.
        text: the word.
        given: the words beside it; one of these is not what is meant.
        place: where it is.
        fix: returns the fix that writes another word in its place.
        shown: what the owner is called.
    """

    owner: str
    text: str
    given: Collection[str]
    place: Place
    fix: Callable[[str], Fix]
    shown: str = ""


def meant_word(words: tuple[str, ...], wrong: str, likeness: float) -> str | None:
    """Return the word of a vocabulary that was meant by another one.

    Args:
        words: of the vocabulary; "wrong=right" gives the one that is meant.
        wrong: what is written.
        likeness: how like a word that is not given has to be.

    Returns:
        None for a word that is known, and for one that is like no other.
    """
    known = [word for word in words if "=" not in word]
    if wrong in known:
        return None
    named = dict(word.split("=") for word in words if "=" in word)
    return named.get(wrong) or nearest(wrong, known, likeness)


def misspelt(words: Iterable[WrittenWord], kind: WordKind) -> Iterator[Problem]:
    """Report words that are not in the vocabulary of their owner."""
    table = vocabulary(kind.table)
    for word in words:
        near = meant_word(table.get(word.owner, ()), word.text, _LIKENESS)
        if near is not None and near not in word.given:
            owner = word.shown or word.owner
            message = kind.message.format(owner=owner, wrong=word.text, right=near)
            fix = word.fix(near)
            yield Problem.at(word.place, kind.severity, kind.code, message, fix)
