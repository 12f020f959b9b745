"""What a person reads uses the words of the glossary, and one rule for full stops."""

from __future__ import annotations

import re

from texts import VALUE, Kind, Text, texts

NOT_SAID = re.compile(
    r"\b(visitors?|watch(es|ing)?\b(?! the files)|mistakes?|give the wheel|"
    r"ask for the wheel|anew|lest|mend(s|ed)?|copy of (my|one's) own|unfold|"
    r"any more|come in)\b",
    re.IGNORECASE,
)
"""Words for which the glossary has another one, and those of old books."""


def faulty(kind: Kind, rule: re.Pattern[str]) -> list[Text]:
    """The texts of a kind that do not follow a rule; there must be some of the kind.

    The help of the command line follows argparse, which begins small and has no stop.
    """
    all_of_them = [
        text
        for text in texts()
        if text.kind == kind and not text.file.startswith("commands/")
    ]
    assert len(all_of_them) > 20
    return [text for text in all_of_them if not rule.search(text.words)]


def test_texts_use_the_words_of_the_glossary() -> None:
    found = texts()
    assert len(found) > 1000
    assert [text for text in found if NOT_SAID.search(text.words)] == []


def test_help_is_a_sentence() -> None:
    assert faulty("help", re.compile(rf"^([A-Z'\"]|{VALUE}).*\.$", re.DOTALL)) == []


def test_a_notice_begins_with_a_capital_and_one_phrase_has_no_full_stop() -> None:
    one_phrase = re.compile(rf"^([A-Z'\"]|{VALUE})([^.]*\w+\.? )*.*([^.]|\. .*\.)$")
    assert faulty("notice", one_phrase) == []


def test_a_refusal_is_one_phrase_without_a_full_stop() -> None:
    assert faulty("refusal", re.compile(r"([^.]|\. .*\.|…|\.\.)$", re.DOTALL)) == []
