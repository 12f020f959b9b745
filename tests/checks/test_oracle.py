"""What `check` says of many models and packages is what was said before.

A change that says something better stores the new words in the same commit; see
tests/support/oracle.py.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import gettempdir

import pytest
from oracle import (
    CORPORA,
    ROOT,
    SHARED,
    STORED,
    Corpus,
    apply_patch,
    difference,
    findings,
)

WITH_MORE = [corpus for corpus in CORPORA if corpus.every > 1]


@pytest.fixture(params=CORPORA, ids=lambda corpus: corpus.name)
def corpus(request: pytest.FixtureRequest) -> Corpus:
    if request.param.in_shared:
        request.getfixturevalue("shared")
    return request.param


def test_the_findings_are_those_that_are_stored(corpus: Corpus) -> None:
    wanted = corpus.in_every_run() if corpus.every > 1 else None
    _compare(corpus, wanted.__contains__ if wanted else lambda _: True)


# In every run the test above compares one in eight of them.
@pytest.mark.slow
@pytest.mark.parametrize("corpus", WITH_MORE, ids=lambda corpus: corpus.name)
def test_the_findings_of_the_other_robots_are_those_that_are_stored(
    corpus: Corpus, shared: Path
) -> None:
    often = corpus.in_every_run()
    _compare(corpus, lambda name: name not in often)


def _compare(corpus: Corpus, wanted: Callable[[str], bool]) -> None:
    before = {name: said for name, said in corpus.stored().items() if wanted(name)}
    changed = difference(corpus, before, findings(corpus, wanted))
    if changed:
        pytest.fail(
            f"{changed}\n\nIf each new line is better than the old one, store them: "
            f"python tests/support/oracle.py --write {corpus.name}",
            pytrace=False,
        )


def test_no_stored_finding_names_a_folder_of_this_machine() -> None:
    files = sorted(STORED.glob("*.json"))
    assert [file.stem for file in files] == sorted(corpus.name for corpus in CORPORA)
    stored = "".join(file.read_text("utf-8") for file in files)
    here = (ROOT, SHARED, SHARED.resolve(), Path.home(), Path(gettempdir()))
    assert [folder for folder in here if f"{folder}/" in stored] == []


def test_a_patch_changes_what_it_says(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "gone").touch()
    (tmp_path / "a.txt").write_text("1\n2\n3\n4\n5\n6\n7\n")
    patch = (
        "--- a/a.txt\n+++ b/a.txt\n@@ -2,2 +2,1 @@\n-2\n 3\n@@ -6,1 +5,2 @@\n 6\n+x\n"
    )
    apply_patch(f"Only in base/folder: gone\n{patch}", tmp_path)
    assert (tmp_path / "a.txt").read_text() == "1\n3\n4\n5\n6\nx\n7\n"
    assert not (tmp_path / "folder" / "gone").exists()
