"""What the terminal says, once, of a source or a frame that is missing."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path

import pytest
from program import serving

from sambot_viz.commands.first_notes import write_notes
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.visualizer import Visualizer

NOBODY = "127.0.0.1:9"


def note_of(words: Sequence[str], folder: Path) -> str:
    """The only note of a command line."""
    with serving(*words, "--port", "0", cwd=folder) as program:
        lines = iter(program.stderr.readline, "")
        note = next(line for line in lines if "note:" in line)
        _, _, rest = program.end()
    assert "note:" not in rest
    return note


@pytest.mark.parametrize("protocol", ["foxglove", "rosbridge"])
def test_a_source_that_does_not_answer_is_said_once_with_the_remedy(
    protocol: str, tmp_path: Path
) -> None:
    note = note_of(["--source", f"{protocol}://{NOBODY}"], tmp_path)
    assert f"Nothing listens at {NOBODY}: start the bridge there with" in note


@pytest.mark.parametrize("source", [None, "square.mcap"])
def test_a_fixed_frame_that_does_not_exist_is_said_once_with_the_nearest(
    source: str | None, repository: Path, tmp_path: Path
) -> None:
    words = [str(repository / "assets" / source)] if source else []
    note = note_of([*words, "-f", "base_lnk"], tmp_path)
    assert "no fixed frame 'base_lnk' (-f): did you mean 'base_link'?" in note


def test_a_wheel_that_does_not_exist_is_said_with_the_nearest(tmp_path: Path) -> None:
    words = ["--left-wheel", "drivewhl_l_jnt", "--right-wheel", "drivewhl_r_joint"]
    note = note_of(words, tmp_path)
    assert (
        "no continuous joint 'drivewhl_l_jnt'; did you mean 'drivewhl_l_joint'" in note
    )


def test_a_frame_that_exists_is_no_news(capsys: pytest.CaptureFixture[str]) -> None:
    with (
        Inputs(Options(fixed_frame="drivewhl_l_link", port=0)) as inputs,
        Visualizer.of_inputs(inputs) as viz,
    ):
        # It ends when there is nothing more to wait for.
        write_notes(threading.Event(), inputs, viz.server.sessions)
    assert "note:" not in capsys.readouterr().err
