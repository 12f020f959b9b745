"""Any bytes are refused in one sentence or read as far as they go."""

from __future__ import annotations

import os
import random
import struct
from pathlib import Path

import pytest

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import mcap, open_bag, ros1

KINDS = ("cut", "flip", "noise", "ones", "zeros", "twice", "drop", "head")


def damaged(data: bytes, rng: random.Random) -> bytes:
    """Return a copy with one kind of damage at a random place."""
    broken, at = bytearray(data), rng.randrange(len(data))
    kind, count = rng.choice(KINDS), rng.choice([1, 4, 16, 300])
    if kind == "cut":
        del broken[at:]
    elif kind == "flip":
        for _ in range(count):
            broken[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    elif kind == "noise":
        broken[at : at + count] = rng.randbytes(count)
    elif kind == "ones":
        broken[at : at + count] = b"\xff" * count
    elif kind == "zeros":
        broken[at : at + count] = bytes(count)
    elif kind == "twice":
        broken[at:at] = data[at : at + count]
    elif kind == "drop":
        del broken[at : at + count]
    else:
        for _ in range(3):
            broken[rng.randrange(min(300, len(data)))] = rng.randrange(256)
    return bytes(broken)


def read_all(path: Path) -> int:
    """Ask everything of a recording; return how many messages were read."""
    try:
        bag = open_bag(path)
    except SourceError as error:
        assert len(error.problems) == 1
        return 0
    with bag:
        for _ in range(100):
            if bag.index_more():
                break
        assert bag.is_complete
        times = [(m.log_ns, len(bytes(m.payload))) for m in bag.messages()]
        for topic in list(bag.topics)[:4]:
            bag.last(topic, 2**63)
            bag.next(topic, 0)
        assert len(bag.latched()) <= len(times)
        assert all(problem.hint for problem in bag.problems)
        return len(times)


@pytest.mark.parametrize("small", [mcap.SMALL, 0])
@pytest.mark.parametrize(
    "name",
    [
        "square_noindex.mcap",
        "cut60_fastwrite.mcap",
        "joints_only.mcap",
        "flipped_payload.mcap",
        "cut60.bag",
        "square.bag",
        "square_jazzy/square_jazzy_0.db3",
    ],
)
def test_nothing_but_a_sentence_or_messages_comes_out(
    name: str,
    small: int,
    shared: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mcap, "SMALL", small)
    monkeypatch.setattr(ros1, "SMALL", small)
    whole = (shared / "data" / "bags" / "made" / name).read_bytes()
    rng = random.Random(name)
    path = tmp_path / "file"
    path.write_bytes(whole)
    most = read_all(path)
    found = 0
    for _ in range(25):
        path.write_bytes(damaged(whole, rng))
        found += read_all(path)
    # Most damage costs little.
    assert found > 25 * most * 0.3


def chunks(data: bytes) -> list[int]:
    """Return where the chunks of an MCAP file begin."""
    found, at = list[int](), 8
    while at < len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if opcode == 6:
            found.append(at)
        at += 9 + length
    assert len(found) > 10
    return found


def test_the_walk_goes_on_behind_a_record_of_impossible_length(
    repository: Path, tmp_path: Path
) -> None:
    square = (repository / "assets" / "square.mcap").read_bytes()
    with open_bag(repository / "assets" / "square.mcap") as bag:
        before = sum(1 for _ in bag.messages())
    chunk = chunks(square)[2]
    # The index at the end is away, too.
    broken = bytearray(square[:-100])
    broken[chunk + 1 : chunk + 9] = b"\xff" * 8
    path = tmp_path / "broken.mcap"
    path.write_bytes(broken)
    with open_bag(path) as bag:
        found = sum(1 for _ in bag.messages())
        assert before * 0.8 < found < before
        codes = {problem.code for problem in bag.problems}
        assert "file-chunk-broken" in codes


def test_a_chunk_that_claims_any_size_takes_no_memory(
    repository: Path, tmp_path: Path
) -> None:
    data = bytearray((repository / "assets/square.mcap").read_bytes())
    for at in chunks(bytes(data)):
        # The length of its records once decompressed.
        data[at + 25 : at + 33] = (2**60).to_bytes(8, "little")
    path = tmp_path / "large.mcap"
    path.write_bytes(data)
    with open_bag(path) as bag:
        assert list(bag.messages()) == []
        assert bag.problems


def test_a_folder_a_pipe_and_no_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match="not a regular file"):
        open_bag(tmp_path)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(SourceError, match="not a regular file"):
        open_bag(tmp_path / "pipe")
    with pytest.raises(SourceError, match="there is no such file"):
        open_bag(tmp_path / "no.mcap")
    with pytest.raises(SourceError):
        open_bag("a\0b")


def test_a_closed_recording_says_so(repository: Path) -> None:
    bag = open_bag(repository / "assets" / "square.mcap")
    bag.close()
    bag.close()
    with pytest.raises(SourceError, match="cannot be read"):
        list(bag.messages())
