from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.errors import ConfigError
from sambot_viz.rviz.yaml.yaml_document import Document

MANAGER = "Visualization Manager:\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            MANAGER + "\tName: root\n",
            "f:2:1: error[config-yaml]: this line is indented with a tab, which YAML "
            "does not allow; indent with spaces only",
        ),
        (
            MANAGER + "  Name: a: b\n",
            "f:2:10: error[config-yaml]: there are two colons in this line, each "
            "followed by a blank; put the value in quotes",
        ),
        (
            MANAGER + "  Name: a\n    Value: b\n",
            "f:3:10: error[config-yaml]: this line is indented further than the line "
            "above allows; indent it like the keys around it",
        ),
        (
            MANAGER + "  Name a\n  Value: b\n",
            "f:2: error[config-yaml]: this line is not 'key: value'; write a colon and "
            "a blank behind the key",
        ),
        (
            MANAGER + "  Depth:5\n  Value: b\n",
            "f:2: error[config-yaml]: this line is not 'key: value'; write a colon and "
            "a blank behind the key",
        ),
        (
            MANAGER + "  Value: b\n  Name\n",
            "f:3: error[config-yaml]: this line is not 'key: value'; write a colon and "
            "a blank behind the key",
        ),
        (
            MANAGER + "  Displays:\n      - a\n    b: c\n",
            "f:4:5: error[config-yaml]: the indentation does not fit any map or list "
            "above; indent it exactly like the other keys of its map",
        ),
        (
            MANAGER + "  Displays: [a\n",
            "f:2:13: error[config-yaml]: the bracket or brace opened here is not "
            "closed, or lacks a comma; close it, and put commas between its parts",
        ),
        *(
            (
                MANAGER + f"  Displays: {opened}",
                "f:2:13: error[config-yaml]: the bracket or brace opened here is not "
                "closed, or lacks a comma; close it, and put commas between its parts",
            )
            for opened in ("[", "[a,", "[a, [b],\n\n", "{")
        ),
        (
            MANAGER + '  Name: "root\n',
            "f:2:9: error[config-yaml]: the quotes that are opened here are never "
            "closed; close them with the same kind of quote",
        ),
        (
            MANAGER + '  Name: "a\\q"\n',
            "f:2:11: error[config-yaml]: a backslash in double quotes begins an escape "
            "YAML does not know; use single quotes, or double the backslash",
        ),
        (
            MANAGER + "  Name: @root\n",
            "f:2:9: error[config-yaml]: a value cannot begin with '@'; put the value "
            "in quotes",
        ),
        (
            MANAGER + "  Name: a\x07b\n",
            "f:2:10: error[config-yaml]: there is a character that YAML does not "
            "allow; remove it",
        ),
        (
            MANAGER + "  Name: *root\n",
            "f:2:9: error[config-yaml]: the alias *root names no anchor above it; "
            "write the value out",
        ),
        (
            MANAGER + "  Name: &a [*a]\n",
            "f:2:13: error[config-yaml]: the alias *a is inside what it names; "
            "write the value out",
        ),
        (
            MANAGER + "<<<<<<< HEAD\n  Name: a\n=======\n  Name: b\n>>>>>>> x\n",
            "f:2: error[config-merge]: this line is the mark of a merge that is not "
            "finished; choose one of the two texts and remove the marks",
        ),
        (
            "%YAML 1.1 x\n---\nPanels: []\n",
            "f:1:11: error[config-yaml]: this is not YAML: while scanning a directive "
            "did not find expected comment or line break; look at this line and the "
            "one above: all keys of one map are indented alike, with spaces only, and "
            "every colon is followed by a blank",
        ),
        (
            '<?xml version="1.0"?>\n<robot name="r"/>\n',
            "f:1: error[config-is-xml]: this is a robot model, not a display config; "
            "give an .rviz file as the config, and the file of the robot as the model",
        ),
        (
            "<launch/>",
            "f:1: error[config-is-xml]: this is XML, not a display config; give an "
            ".rviz file as the config, and the file of the robot as the model",
        ),
        (
            "Background\\ ColorB=0\nFixed\\ Frame=/map\nGrid.Alpha=0.5\n",
            "f:1: error[config-is-vcg]: this is a config of RViz before 1.9 (.vcg, "
            "lines of 'name=value'), which today's RViz cannot read either; set the "
            "displays up again and save an .rviz file",
        ),
        (
            "services:\n  web: x\n",
            "f:1: error[config-not-rviz]: this YAML is not a .rviz document: "
            "'Visualization Manager' is missing; give a file that RViz has saved, or "
            "one with the same structure",
        ),
    ],
)
def test_a_text_that_is_no_rviz_document_is_explained(text: str, message: str):
    with pytest.raises(ConfigError) as caught:
        Document(text, "f")
    assert str(caught.value) == message


@pytest.mark.parametrize("blanks", [3, 5])
@pytest.mark.parametrize("right", ["    - Class: b", "      Name: n"])
def test_a_line_that_is_one_blank_off_its_like_is_moved(
    tmp_path: Path, right: str, blanks: int
):
    text = f"{MANAGER}  Displays:\n    - Class: a\n      Name: m\n"
    text += "    - Class: b\n      Name: n\n      Value: true\n"
    depth = len(right) - len(right.lstrip()) + blanks - 4
    path = tmp_path / "r.rviz"
    path.write_text(text.replace(right, " " * depth + right.lstrip()))
    with pytest.raises(ConfigError) as caught:
        Document.load(path)
    (problem,) = caught.value.problems
    assert "one blank off" in problem.message
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == text


@pytest.mark.parametrize("text", ["- a\n", "just words\n", "42"])
def test_yaml_that_is_no_map_is_no_rviz_document(text: str):
    with pytest.raises(ConfigError, match="config-not-rviz"):
        Document(text, "f")


def test_a_file_nested_beyond_reason_is_refused():
    with pytest.raises(ConfigError, match="nested too deeply"):
        Document("Panels: " + "[" * 250 + "]" * 250)


def test_aliases_that_would_fill_the_memory_are_refused():
    lines = ["Panels: &b0 [1, 2, 3, 4, 5, 6, 7, 8, 9]"]
    lines += [f"b{i}: &b{i} [{', '.join([f'*b{i - 1}'] * 9)}]" for i in range(1, 9)]
    with pytest.raises(ConfigError, match="more than 50,000 names and values"):
        Document("\n".join(lines))


def test_aliases_that_nest_each_other_too_deeply_are_refused():
    lines = ["a0: &a0 [x]", *(f"a{i}: &a{i} [*a{i - 1}]" for i in range(1, 5000))]
    with pytest.raises(ConfigError, match="nested too deeply"):
        Document("\n".join(lines))


def test_a_file_that_is_no_config_by_its_size_is_refused():
    views = "".join(f"  - {{Name: v{i}}}\n" for i in range(20_000))
    with pytest.raises(
        ConfigError, match="more than 50,000 names and values"
    ) as caught:
        Document(f"Visualization Manager:\n  Views:\n{views}")
    assert caught.value.problems[0].hint.startswith("remove what is not needed")


@pytest.mark.parametrize("text", ["", "\n\n", "# only a comment\n", "~", "---\n"])
def test_an_empty_file_gives_nothing_and_a_warning(text: str):
    document = Document(text, "f")
    assert document.root.entries == []
    assert [str(problem) for problem in document.problems] == [
        "f: warning[config-empty]: the file is empty: it gives no displays; "
        "add displays and save, or give another file"
    ]


def test_a_file_without_a_manager_is_read_with_a_warning():
    document = Document("Panels: []\n", "f")
    assert [problem.message for problem in document.problems] == [
        "'Visualization Manager' is missing: there are no displays"
    ]


def test_a_vcg_file_of_the_real_world_is_recognised(shared: Path):
    for path in (shared / "data/rviz").glob("*.vcg"):
        with pytest.raises(ConfigError, match="config-is-vcg"):
            Document.load(path)
