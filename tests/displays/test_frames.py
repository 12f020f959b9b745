"""TF: which frames are drawn, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import viser

from sambot_viz.displays.tf.tf import TfDisplay
from sambot_viz.frames import Transform
from sambot_viz.session import Session

Show = Callable[..., Session]
Nodes = Callable[[Session], dict[str, viser.SceneNodeHandle]]
CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
      Show Names: true
{body}
  Global Options: {{Fixed Frame: {fixed}}}
"""


@pytest.fixture
def tf(show: Show) -> Callable[..., Session]:
    """``tf(body, fixed="base")``: a session whose only display is a TF."""

    def open_session(body: str = "", fixed: str = "base") -> Session:
        return show(config=CONFIG.format(body=body, fixed=fixed))

    return open_session


def display_of(session: Session) -> TfDisplay:
    display = session.scene.displays[0]
    assert isinstance(display, TfDisplay)
    return display


def drawn(session: Session, nodes: Nodes) -> set[str]:
    """The frames that have axes."""
    found = nodes(session)
    key = display_of(session).key
    paths = {f: session.scene.context.nodes.path(f) for f in session.frames.tree.frames}
    return {frame for frame, path in paths.items() if f"{path}/{key}a" in found}


def test_all_frames_are_drawn_unless_the_file_says_otherwise(
    tf: Show, nodes: Nodes
) -> None:
    assert drawn(tf(), nodes) == {"base", "upper", "tool"}
    one_off = tf("      Frames: {All Enabled: true, upper: {Value: false}}")
    assert drawn(one_off, nodes) == {"base", "tool"}
    only_listed = tf("      Frames: {All Enabled: false, upper: {Value: true}}")
    assert drawn(only_listed, nodes) == {"upper"}
    without_value = tf("      Frames: {All Enabled: true, upper: {}}")
    assert drawn(without_value, nodes) == {"base", "tool"}


@pytest.mark.parametrize(
    ("body", "left"),
    [
        ('      Filter (whitelist): "^up"', {"upper"}),
        ('      Filter (blacklist): "o"', {"base", "upper"}),
        (
            '      Filter (whitelist): "e|o"\n      Filter (blacklist): "^b"',
            {"upper", "tool"},
        ),
        ('      Filter (whitelist): "("', {"base", "upper", "tool"}),
        ('      Filter (whitelist): "UP"', set[str]()),
    ],
)
def test_filters_are_searched_anywhere_in_the_name(
    body: str, left: set[str], tf: Show, nodes: Nodes
) -> None:
    assert drawn(tf(body), nodes) == left


def test_all_enabled_sets_the_frames_of_the_file_too(tf: Show, nodes: Nodes) -> None:
    session = tf("      Frames: {All Enabled: true, upper: {Value: false}}")
    display = display_of(session)
    session.display_edits.set_property(display, "Frames/All Enabled", False)
    assert drawn(session, nodes) == set()
    session.display_edits.set_property(display, "Frames/All Enabled", True)
    assert drawn(session, nodes) == {"base", "upper", "tool"}


def test_a_frame_has_the_facts_of_rviz(tf: Show) -> None:
    session = tf(fixed="upper")
    frames = display_of(session).entries()[0]
    assert list(frames.names) == ["base", "upper", "tool"]
    facts = frames.facts("tool")
    assert facts["Parent"] == "upper"
    assert facts["Position"] == facts["Relative Position"] == "1; 0; 0"
    assert facts["Orientation"] == "0; 0; 0; 1"
    assert "Relative Position" not in frames.facts("base")
    frames.set("tool", "Value", False)
    assert display_of(session).config.dynamic(("Frames", "tool")) == {"Value": "false"}


def test_a_frame_of_another_tree_is_not_drawn_and_warned_of(
    tf: Show, nodes: Nodes
) -> None:
    session = tf()
    session.frames.add("map", "odom", Transform.from_xyz_rpy((1, 0, 0)))
    assert drawn(session, nodes) == {"base", "upper", "tool"}
    status = display_of(session).status
    assert status.level == "Warn"
    assert status.rows["odom"].text == "No transform from [odom] to [base]"
    assert status.rows["tool"].text == "Transform OK"


def test_without_the_fixed_frame_no_heap_of_axes_is_drawn(
    tf: Show, nodes: Nodes
) -> None:
    session = tf(fixed="nowhere")
    assert drawn(session, nodes) == set()
    assert session.scene.global_status().text == "Frame [nowhere] does not exist"
    session.document.set_option("Fixed Frame", "base")
    assert drawn(session, nodes) == {"base", "upper", "tool"}
