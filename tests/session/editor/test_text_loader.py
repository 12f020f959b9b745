"""Texts of the model are loaded, then checked, while others are typed."""

from __future__ import annotations

from pathlib import Path

from inside import session_of

from sambot_viz import Visualizer, load_robot
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.editor.text_loader import ModelState, TextLoader

GOOD = '<robot name="r"><link name="hull"/></robot>'


def test_a_text_that_comes_after_the_load_does_not_count_as_checked(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD)
    files = ModelFiles(model, lambda path, *_: load_robot(path))
    states: list[ModelState] = []
    newest = 1

    def wanted() -> ModelState:
        # Somebody types each time that the text is asked for, up to a version.
        version = min(len(states) + 1, newest)
        texts = {str(model): f"{GOOD}<!-- {version} -->"}
        state = ModelState(
            files, False, 0, texts, {}, frozenset(texts), {"r.urdf": version}
        )
        states.append(state)
        return state

    with Visualizer(model, port=0) as viz:
        session = session_of(viz)
        loader = TextLoader(
            session.robot,
            session.checks,
            session.problems,
            session.show_edited,
            session.change,
            wanted,
            True,
            (),
        )
        newest = 3
        loader.begin()
        assert loader.wait(60.0)
        assert [state.versions["r.urdf"] for state in states] == [1, 2, 3]
        assert not loader.checked
        loader.begin()
        assert loader.wait(60.0)
        assert loader.checked == {"r.urdf": 3}
        loader.close()
