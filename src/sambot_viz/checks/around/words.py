"""Report misspelt words, which are not in the vocabulary of a program."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import NamedTuple

from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.errors import Fix, Place, Problem, Severity, nearest

_LIKENESS = 0.75


class WordKind(NamedTuple):
    """The common data of words of one kind.

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
    """A word in a file.

    Attributes:
        owner: its owner: the row in the vocabulary.
        text: the word.
        given: the words beside it, which are not candidates.
        place: where it is.
        fix: returns the fix that replaces it with another word.
        shown: the name of the owner for a message.
    """

    owner: str
    text: str
    given: Collection[str]
    place: Place
    fix: Callable[[str], Fix]
    shown: str = ""


def meant_word(words: tuple[str, ...], wrong: str, likeness: float) -> str | None:
    """Return the word of a vocabulary that a text misspells.

    Args:
        words: of the vocabulary; "wrong=right" gives the right word for a wrong one.
        wrong: the word in the file.
        likeness: the required similarity of a word that is not in the row.

    Returns:
        None for a known word, and for one without a similar word.
    """
    known = [word for word in words if "=" not in word]
    if wrong in known:
        return None
    named = dict(word.split("=") for word in words if "=" in word)
    return named.get(wrong) or nearest(wrong, known, likeness)


def misspelt(words: Iterable[WrittenWord], kind: WordKind) -> Iterator[Problem]:
    """Report misspelt words of their owners' vocabularies."""
    table = vocabulary(kind.table)
    for word in words:
        near = meant_word(table.get(word.owner, ()), word.text, _LIKENESS)
        if near is not None and near not in word.given:
            owner = word.shown or word.owner
            message = kind.message.format(owner=owner, wrong=word.text, right=near)
            fix = word.fix(near)
            yield Problem.at(word.place, kind.severity, kind.code, message, fix)
