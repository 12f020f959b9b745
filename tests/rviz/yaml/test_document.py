from __future__ import annotations

import os
import random
import stat
from pathlib import Path

import pytest
import yaml

from sambot_viz.errors import ConfigError
from sambot_viz.rviz.yaml import parser
from sambot_viz.rviz.yaml.parser import parse
from sambot_viz.rviz.yaml.writer import Writer
from sambot_viz.rviz.yaml.yaml_document import Document
from sambot_viz.rviz.yaml.yaml_nodes import (
    Collection,
    Entry,
    List,
    Map,
    Scalar,
    copied,
    plain,
    same,
)

HAND_WRITTEN = """\
# Our lab's config.
Visualization Manager:   # the manager
  Displays:
  - Class: rviz/Grid   # the grid
    # inside
    Name: "quoted name"
    Offset: {X: 1, Y: 2, Z: 3}   # in braces
    List: [a, 'b, c', {d: e}]

  # the second
  -   Name: wide
      Class: rviz/TF
      Text: |
        several
         lines

      Folded: >-
        a
        b
      Long: one
        two
  -
    Name: own line
    Empty:
    Deep:
        Four: 4
        More:
              Many: 1
  - ~
  - plain
  # behind the last
  Null: ~
Panels: []   # none
Other:
  a: &x
    k: v
    l: [1, 2]
  b: *x
  c: !!str 12
  "quoted key": 'single ''q'''
  d: {}
  e:
    {}
# the end"""

IN_BRACES = (
    "Visualization Manager: {Displays: [{Class: rviz/Grid, Name: a}], Name: r}\n"
)
WINDOWS = (
    "---\r\nVisualization Manager:\r\n    Displays:\r\n        -   Name: a\r\n"
    "            X: 1\r\n        -   Name: b\r\n    Name: é한글 # ü\r\n...\r\n"
)
TEXTS = (
    *("x", "true", "a: b", "# c", "", "~", "null", "1e5", "-", "- a", "[x", "é한글"),
    *("it's", 'say "hi"', "a\nb", "tab\there", " lead", "trail ", "0; 0; 0", "@a"),
    *("<Fixed Frame>", "%b", "&c", "*d", "!e", "|", "?", "? x", ":", ":x", "a:"),
    *("a #b", "a#b", "=", "<<", "---", "--- x", "...", "{}", "a, b", "\x07", "\u2028"),
)


def changed(text: str, change: tuple[str, ...], value: str) -> str:
    """The saved text after one scalar, found by its keys, says something else."""
    document = Document(text)
    node: Collection | Scalar = document.root
    for key in change:
        if isinstance(node, Map):
            found = node.get(key)
            assert found is not None
            node = found
        else:
            assert isinstance(node, List)
            node = node.items[int(key)]
    assert isinstance(node, Scalar)
    node.assign(value)
    return document.to_yaml()


@pytest.mark.parametrize("text", [HAND_WRITTEN, IN_BRACES, WINDOWS])
def test_an_unchanged_file_is_written_as_it_was(text: str):
    document = Document(text)
    assert document.to_yaml() == text
    assert not document.modified


def test_one_changed_text_changes_nothing_else():
    keys = ("Visualization Manager", "Displays", "0", "Class")
    assert changed(HAND_WRITTEN, keys, "rviz/Axes") == HAND_WRITTEN.replace(
        "rviz/Grid", "rviz/Axes"
    )


def test_a_quoted_text_stays_quoted_and_a_comment_stays():
    keys = ("Visualization Manager", "Displays", "0", "Name")
    assert '    Name: "other"\n' in changed(HAND_WRITTEN, keys, "other")


def test_a_value_in_braces_is_changed_in_place():
    keys = ("Visualization Manager", "Displays", "0", "Offset", "Y")
    text = changed(HAND_WRITTEN, keys, "2.5")
    assert "    Offset: {X: 1, Y: 2.5, Z: 3}   # in braces\n" in text


def test_a_missing_value_is_written_behind_its_colon():
    document = Document("Visualization Manager:\n  Empty:\n  Name: root\n")
    manager = document.root.get("Visualization Manager")
    assert isinstance(manager, Map)
    manager.put_text("Empty", "full")
    assert document.to_yaml() == (
        "Visualization Manager:\n  Empty: full\n  Name: root\n"
    )


def test_the_line_breaks_and_the_mark_of_windows_stay():
    document = Document("\ufeff" + WINDOWS)
    manager = document.root.get("Visualization Manager")
    assert isinstance(manager, Map)
    manager.put_text("Zoom", "1")
    text = document.to_yaml()
    assert text.startswith("\ufeff---\r\n")
    assert text.count("\n") == text.count("\r\n") == WINDOWS.count("\n") + 1


def test_the_later_one_of_a_double_key_holds_and_is_changed():
    text = "Visualization Manager:\n  Name: a\n  Name: b\n"
    assert plain(Document(text).root) == {"Visualization Manager": {"Name": "b"}}
    keys = ("Visualization Manager", "Name")
    assert changed(text, keys, "c") == text.replace("Name: b", "Name: c")


def test_a_new_key_goes_where_rviz_would_write_it():
    document = Document("Panels: []\nVisualization Manager:\n  A: 1\n  C: 3\n")
    manager = document.root.get("Visualization Manager")
    assert isinstance(manager, Map)
    manager.put("B", Scalar("2"))
    manager.put("D", Map())
    manager.put("E", List())
    assert document.to_yaml() == (
        "Panels: []\nVisualization Manager:\n"
        "  A: 1\n  B: 2\n  C: 3\n  D:\n    {}\n  E: ~\n"
    )


def test_an_emptied_list_becomes_a_tilde_as_in_rviz():
    document = Document("Visualization Manager:\n  Displays:\n    - a\n    - b\n")
    manager = document.root.get("Visualization Manager")
    assert isinstance(manager, Map)
    displays = manager.get("Displays")
    assert isinstance(displays, List)
    displays.entries.clear()
    assert document.to_yaml() == "Visualization Manager:\n  Displays: ~\n"


@pytest.mark.parametrize("text", TEXTS)
def test_any_text_can_be_written_and_read_back(text: str):
    for quote in ("", "'", '"'):
        written = Writer().document(Map([Entry(text, Scalar(text, quote=quote))]))
        assert plain(parse(written)) == {text: text}
    in_braces = changed(
        IN_BRACES, ("Visualization Manager", "Displays", "0", "Name"), text
    )
    read = plain(parse(in_braces))
    assert read == {
        "Visualization Manager": {
            "Displays": [{"Class": "rviz/Grid", "Name": text}],
            "Name": "r",
        }
    }


def test_a_change_below_an_anchor_is_written_although_the_alias_must_go():
    text = changed(HAND_WRITTEN, ("Other", "a", "l", "0"), "7")
    read = plain(parse(text))
    assert isinstance(read, dict)
    other = read["Other"]
    assert isinstance(other, dict)
    assert other["a"] == {"k": "v", "l": ["7", "2"]}
    assert other["b"] == {"k": "v", "l": ["1", "2"]}


def meaning(text: str) -> object:
    """What any other YAML reader makes of a text."""
    return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def collections(node: Collection) -> list[Map | List]:
    """All maps and lists of a document."""
    found: list[Map | List] = [node] if isinstance(node, (Map, List)) else []
    for entry in node.entries:
        if isinstance(entry.value, Collection):
            found += collections(entry.value)
    return found


def holds(node: Map | List | Scalar, wanted: Map | List) -> bool:
    """Whether a node is another one or has it somewhere inside."""
    if node is wanted:
        return True
    entries = [] if isinstance(node, Scalar) else node.entries
    return any(holds(entry.value, wanted) for entry in entries)


def edit(rng: random.Random, root: Map) -> None:
    """One random change somewhere in a document."""
    everywhere = collections(root)
    here = rng.choice(everywhere)
    kind = rng.choice(["text", "text", "remove", "add", "shuffle", "move", "replace"])
    if kind == "text":
        texts = [e.value for e in here.entries if isinstance(e.value, Scalar)]
        if texts:
            rng.choice(texts).assign(rng.choice(TEXTS))
    elif kind == "remove" and here is not root and here.entries:
        here.entries.pop(rng.randrange(len(here.entries)))
    elif kind == "add":
        made = rng.choice(
            [Scalar(rng.choice(TEXTS)), Map(), List(), copied(rng.choice(everywhere))]
        )
        if isinstance(here, Map):
            here.put(rng.choice([*TEXTS, "Alpha", "Zoom"]), made)
        else:
            here.entries.insert(rng.randrange(len(here.entries) + 1), Entry(None, made))
    elif kind == "shuffle":
        rng.shuffle(here.entries)
    elif kind == "move" and here.entries and here is not root:
        entry, there = rng.choice(here.entries), rng.choice(everywhere)
        fits = isinstance(there, List) or not there.entry(entry.key or "")
        if type(here) is type(there) and fits and not holds(entry.value, there):
            here.entries.remove(entry)
            there.entries.insert(rng.randrange(len(there.entries) + 1), entry)
    elif kind == "replace" and here.entries:
        rng.choice(here.entries).value = rng.choice([Scalar("new"), Map(), List()])


@pytest.mark.parametrize("source", [HAND_WRITTEN, IN_BRACES, WINDOWS])
def test_any_edits_of_a_hand_written_file_read_back_as_they_are_meant(source: str):
    rng = random.Random(20261121)
    for _ in range(60):
        document = Document(source)
        for _ in range(rng.choice([1, 2, 5, 12])):
            edit(rng, document.root)
        read = parse(document.to_yaml())
        assert read is not None
        assert same(read, document.root)


def test_any_edits_of_real_files_are_written_into_their_text(real_files: list[Path]):
    rng = random.Random(4)
    for path in rng.sample([p for p in real_files if p.stat().st_size < 20000], 25):
        text = path.read_text("utf-8")
        document = Document(text)
        for _ in range(rng.choice([1, 3, 8])):
            edit(rng, document.root)
        in_place = Writer(text).document(document.root)
        read = parse(in_place)
        assert read is not None
        assert same(read, document.root), path.name


def test_python_s_own_yaml_reader_gives_the_same(monkeypatch: pytest.MonkeyPatch):
    fast = parse(HAND_WRITTEN)
    monkeypatch.setattr(parser, "_LOADER", yaml.SafeLoader)
    slow = parse(HAND_WRITTEN)
    assert fast is not None
    assert slow is not None
    assert same(fast, slow)
    keys = ("Visualization Manager", "Displays", "1", "Text")
    assert "      Text: short\n" in changed(HAND_WRITTEN, keys, "short")


def test_rviz_s_own_files_written_anew_are_the_same_text(real_files: list[Path]):
    differing: list[str] = []
    some = real_files[::5]
    for path in some:
        text = path.read_text("utf-8")
        root = parse(text)
        assert root is not None
        written = Writer().document(root)
        assert meaning(written) == meaning(text), path.name
        if written != text:
            differing.append(path.name)
    # The rest was written by hand or by a template.
    assert len(differing) < 0.1 * len(some)


def test_a_save_writes_the_file_and_keeps_its_rights(tmp_path: Path):
    path = tmp_path / "my.rviz"
    path.write_text(IN_BRACES)
    path.chmod(0o640)
    document = Document.load(path)
    document.root.put("Panels", List())
    assert document.modified
    document.save(path)
    assert not document.modified
    assert path.read_text() == document.to_yaml()
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert [p.name for p in tmp_path.iterdir()] == ["my.rviz"]


def test_a_save_that_fails_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    path = tmp_path / "my.rviz"
    path.write_text(IN_BRACES)
    document = Document.load(path)
    document.root.put("Panels", Scalar("x"))

    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ConfigError) as caught:
        document.save(path)
    assert str(caught.value) == (
        f"{path}: error[config-unwritable]: cannot write it: No space left on device; "
        "choose another place"
    )
    assert path.read_text() == IN_BRACES
    assert [p.name for p in tmp_path.iterdir()] == ["my.rviz"]
    assert document.modified


def test_a_save_through_a_link_keeps_the_link(tmp_path: Path):
    target, link = tmp_path / "real.rviz", tmp_path / "link.rviz"
    target.write_text(IN_BRACES)
    link.symlink_to(target)
    document = Document.load(link)
    document.root.put("Panels", List())
    document.save(link)
    assert link.is_symlink()
    assert target.read_text() == document.to_yaml()


def test_an_unreadable_file_is_an_error_with_its_name(tmp_path: Path):
    missing = tmp_path / "none.rviz"
    with pytest.raises(ConfigError) as caught:
        Document.load(missing)
    assert str(caught.value) == (
        f"{missing}: error[config-unreadable]: cannot read it: "
        "No such file or directory; check the path"
    )
    for other in (tmp_path, Path("/dev/zero")):
        with pytest.raises(ConfigError, match="not a regular file"):
            Document.load(other)


def test_a_file_that_is_far_too_large_is_not_read(tmp_path: Path):
    path = tmp_path / "large.rviz"
    with path.open("wb") as file:
        file.truncate(2**30)
    with pytest.raises(ConfigError, match="more than 4,000,000 bytes"):
        Document.load(path)


@pytest.mark.parametrize("size", [64, 2**30])
def test_a_recording_is_said_to_be_one(tmp_path: Path, size: int):
    path = tmp_path / "run.mcap"
    with path.open("wb") as file:
        file.write(b"\x89MCAP0\r\n")
        file.truncate(size)
    with pytest.raises(ConfigError) as caught:
        Document.load(path)
    assert str(caught.value) == (
        f"{path}: error[config-not-rviz]: this is a recording, not a display config; "
        f"show it with --source {path}, and give an .rviz file as the config"
    )


def test_a_file_that_is_no_utf_8_is_an_error_with_the_line(tmp_path: Path):
    path = tmp_path / "old.rviz"
    path.write_bytes(b"Panels: []\nVisualization Manager:\n  Name: \xe9t\xe9\n")
    with pytest.raises(ConfigError) as caught:
        Document.load(path)
    assert str(caught.value) == (
        f"{path}:3: error[config-encoding]: this line is not UTF-8; save it as UTF-8"
    )
