"""Interactive markers are completed, moved, erased and refused as in RViz."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from inside import session_of
from interactive_messages import (
    ALONG_Y,
    ALONG_Z,
    BUTTON,
    FIXED,
    MENU,
    MOVE_AXIS,
    MOVE_PLANE,
    MOVE_ROTATE,
    PLAIN,
    ROTATE_AXIS,
    VIEW_FACING,
    control,
    cube,
    full,
    marker,
    moved,
    six_degrees,
    update,
)
from lower_limit import lower
from made_messages import Make

from sambot_viz.displays.by_topic import displays_of_topic
from sambot_viz.displays.data.interactive_markers.controls import controls_of
from sambot_viz.displays.data.interactive_markers.handles import handles
from sambot_viz.displays.data.interactive_markers.initial_set import (
    FULL_TYPE,
    as_full_set,
)
from sambot_viz.displays.data.interactive_markers.menu import menu_of
from sambot_viz.errors import DecodeError
from sambot_viz.frames import Transform
from sambot_viz.geometry import IDENTITY
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.source import Reply
from sambot_viz.tools.picking.pick_scene import PickSnapshot
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.service_message import ServiceMessage

Open = Callable[..., Any]
NAMESPACE = "Interactive Markers Namespace"
TYPE = "visualization_msgs/msg/InteractiveMarkerUpdate"
CLIENT = "Interactive Marker Client"


@pytest.fixture
def shown(messages: Open) -> Open:
    """Opens updates of the namespace /ns."""

    def open_updates(*made: Make, **values: Any) -> Any:
        return messages("InteractiveMarkers", *made, **{NAMESPACE: "/ns", **values})

    return open_updates


@pytest.fixture(scope="module")
def types() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY).types


def known(opened: Any) -> set[str]:
    return set(opened.display._markers.known)  # pyright: ignore[reportPrivateUsage]


def handle_of(opened: Any, end: str) -> Any:
    """The node of the scene whose name ends so."""
    scene = opened.viz.viser.scene
    ours = opened.node_names()
    names = [end] if end in ours else [name for name in ours if name.endswith(end)]
    assert len(names) == 1, (end, opened.node_names())
    return scene._handle_from_node_name[names[0]]  # pyright: ignore[reportPrivateUsage]


def add_frame(opened: Any, name: str, xyz: tuple[float, float, float]) -> None:
    """Hang a frame below the map, as a user does."""
    session_of(opened.viz).frames.add("map", name, Transform.from_xyz_rpy(xyz))


def root(opened: Any) -> Any:
    return handle_of(opened, f"{opened.display.key}i1")


# What is completed


def test_a_scale_of_zero_is_one_and_a_rotation_of_zeros_turns_nothing(
    types: Any,
) -> None:
    box = cube(types, scale=(0.0, 0.5, 0.0))
    made = marker(
        types,
        scale=0.0,
        controls=[
            control(types, MOVE_AXIS, turn=(0.0, 0.0, 0.0, 0.0)),
            control(types, markers=[box]),
        ],
    )
    arrows, boxed = controls_of(made, is_transparent=True)
    assert arrows.wxyz == IDENTITY
    assert arrows.markers[0].points[1].x == pytest.approx(0.9)
    assert boxed.markers[0].scale == (1.0, 0.5, 1.0)


def test_controls_of_the_same_name_get_others(types: Any) -> None:
    made = marker(types, controls=[control(types, name="a") for _ in range(3)])
    names = [one.name for one in controls_of(made, is_transparent=True)]
    assert names[0] == "a" and len(set(names)) == 3
    assert all(name.startswith("a_u") for name in names[1:])


@pytest.mark.parametrize(
    ("turn", "color"),
    [(PLAIN, (1, 0, 0)), (ALONG_Y, (0, 1, 0)), (ALONG_Z, (0, 0, 1))],
)
def test_handles_have_the_colour_of_their_axis(
    types: Any, turn: Sequence[float], color: Sequence[float]
) -> None:
    made = marker(types, controls=[control(types, MOVE_AXIS, turn=tuple(turn))])
    ((arrow, _),) = (one.markers for one in controls_of(made, is_transparent=True))
    assert arrow.color == pytest.approx((*color, 0.5))


def test_arrows_go_both_ways_along_the_axis() -> None:
    there, back = handles(MOVE_AXIS, 2.0, IDENTITY, "")
    assert [point.x for point in there.points] == pytest.approx([1.0, 1.8])
    assert [point.x for point in back.points] == pytest.approx([-1.0, -1.8])
    assert there.scale == pytest.approx((0.3, 0.5, 0.4))


@pytest.mark.parametrize("mode", [MOVE_PLANE, ROTATE_AXIS, MOVE_ROTATE])
def test_rings_are_about_the_axis_and_cover_all_of_it(mode: int) -> None:
    (ring,) = handles(mode, 2.0, IDENTITY, "")
    corners = np.reshape(np.array(ring.points), (-1, 3, 3))
    radii = np.linalg.norm(corners, axis=2)
    assert corners.shape == (72, 3, 3) and not corners[..., 0].any()
    assert set(np.round(np.ravel(radii), 6)) == {0.5, 0.65}
    sides = corners[:, 1:] - corners[:, :1]
    area = np.abs(np.cross(sides[:, 0], sides[:, 1])[:, 0]).sum() / 2
    # The area of a ring with 36 corners.
    assert area == pytest.approx(18 * math.sin(math.pi / 18) * (0.65**2 - 0.5**2))
    assert ring.scale == (2.0, 2.0, 2.0)


def test_rings_that_turn_have_dark_and_bright_parts() -> None:
    (turns,) = handles(ROTATE_AXIS, 1.0, IDENTITY, "")
    assert [color.r for color in turns.colors[:4]] == pytest.approx([0.6, 0.6, 1, 1])
    assert len(turns.colors) == 72
    (moves,) = handles(MOVE_PLANE, 1.0, IDENTITY, "")
    assert not moves.colors


def test_a_menu_is_its_description_and_others_have_no_handles() -> None:
    (text,) = handles(MENU, 2.0, IDENTITY, "choose")
    assert text.text == "choose" and text.scale.z == 0.5
    assert text.pose.position == pytest.approx((-0.05, 0.0, 2.35))
    for mode in (0, BUTTON, 7, 8, 9, 200):
        assert not handles(mode, 1.0, IDENTITY, "x")


def test_a_control_is_turned_as_its_modes_say(types: Any) -> None:
    box = [cube(types)]
    made = marker(
        types,
        controls=[
            control(types, markers=box),
            control(types, markers=box, turning=FIXED),
            control(types, markers=box, turning=VIEW_FACING),
            control(types, markers=box, turning=VIEW_FACING, independent=True),
            control(types, markers=box, turning=77),
            control(types, MENU, description="m"),
        ],
    )
    turnings = [one.group.turning for one in controls_of(made, is_transparent=True)]
    assert turnings == [0, FIXED, VIEW_FACING, 0, FIXED, VIEW_FACING]


def test_without_transparency_what_can_be_seen_is_opaque(types: Any) -> None:
    boxes = [cube(types, alpha=0.3), cube(types, alpha=0.0)]
    made = marker(types, controls=[control(types, markers=boxes)])
    (one,) = controls_of(made, is_transparent=False)
    assert [box.color.a for box in one.markers] == [1.0, 0.0]


# What messages do


def test_updates_add_move_and_erase(shown: Open) -> None:
    opened = shown(
        update(lambda t: six_degrees(t, "a"), lambda t: marker(t, "b")),
        update(poses=[lambda t: moved(t, "a", 3.0)], erases=["b"], number=2),
    )
    assert known(opened) == {"a"}
    assert tuple(root(opened).position) == (3.0, 0.0, 0.0)
    assert opened.statuses["a"] == ("Ok", "Locked to frame map")
    assert "b" not in opened.statuses
    assert opened.statuses[CLIENT] == ("Ok", "Connected on namespace: /ns")
    opened.viz.player.jump(0.0)
    assert known(opened) == {"a", "b"}


def test_a_full_set_replaces_all_and_older_updates_do_not_count(shown: Open) -> None:
    opened = shown(
        update(lambda t: marker(t, "old")),
        full(lambda t: marker(t, "a", x=1.0), number=5),
        update(poses=[lambda t: moved(t, "a", 9.0)], number=5),
    )
    assert known(opened) == {"a"}
    assert root(opened).position[0] == 1.0


def test_after_a_jump_the_last_full_set_and_what_followed_count(shown: Open) -> None:
    opened = shown(
        full(lambda t: marker(t, "a")),
        *(
            update(poses=[lambda t, x=n: moved(t, "a", float(x))], number=n)
            for n in range(2, 30)
        ),
        full(lambda t: marker(t, "b"), number=30),
        update(lambda t: marker(t, "c"), number=31),
    )
    assert known(opened) == {"b", "c"}
    opened.viz.player.jump(1.05)
    assert known(opened) == {"a"}
    # The second message moves it to 2, one more comes each tenth of a second.
    assert root(opened).position[0] == 11.0
    opened.viz.player.jump(opened.viz.player.duration)
    assert known(opened) == {"b", "c"}


def test_messages_that_keep_alive_change_nothing(shown: Open) -> None:
    opened = shown(
        update(lambda t: marker(t, "a")),
        update(lambda t: marker(t, "b"), kind=0),
    )
    assert known(opened) == {"a"}


def test_missing_updates_are_counted(shown: Open) -> None:
    made = [
        update(lambda t: marker(t, "a")),
        *(update(poses=[lambda t: moved(t, "a", 1.0)], number=n) for n in (3, 6)),
    ]
    opened = shown(*made)
    level, text = opened.statuses["Updates"]
    assert level == "Warn" and text.startswith("3 updates are missing")
    opened.viz.player.jump(0.1)
    assert opened.statuses["Updates"][1].startswith("1 update is missing")


def test_only_poses_are_said_to_be_only_poses(shown: Open) -> None:
    opened = shown(update(poses=[lambda t: moved(t, "a", 1.0)]))
    level, text = opened.statuses[CLIENT]
    assert level == "Warn" and "Only poses have come, such as that of 'a'" in text
    assert "/ns/get_interactive_markers" in text


def test_a_namespace_without_a_topic_says_which_one_was_meant(shown: Open) -> None:
    opened = shown(update(lambda t: marker(t, "a")), **{NAMESPACE: "/other"})
    assert not known(opened)
    assert "/ns/update" in opened.statuses[CLIENT][1]
    (repair,) = opened.display.repairs().values()
    assert repair.value == "/ns"
    opened.set(repair.path, repair.value)
    assert known(opened) == {"a"}
    assert opened.display.options() == {NAMESPACE: ["/ns"]}
    opened.set(NAMESPACE, "")
    assert opened.statuses[CLIENT] == ("Error", "Error connecting: empty namespace")
    assert not opened.node_names()


def test_the_topic_of_ros_1_is_taken_for_its_namespace(messages: Open) -> None:
    made = update(lambda t: marker(t, "a"))
    opened = messages("InteractiveMarkers", made, **{"Update Topic": "/ns/update"})
    assert known(opened) == {"a"}
    # What is chosen is written as ROS 1 has it.
    assert opened.display.options() == {NAMESPACE: ["/ns/update"]}


def test_a_display_that_is_added_for_a_topic_shows_its_namespace() -> None:
    (first, *_) = displays_of_topic("/ns/update", TYPE)
    assert first.topic_values("/ns/update", TYPE, None) == {NAMESPACE: "/ns"}


def test_a_recording_has_nobody_who_hears_of_a_hand(shown: Open) -> None:
    opened = shown(update(lambda t: marker(t)))
    assert known(opened) == {"one"} and not opened.display.has_handles


@pytest.mark.parametrize("is_json", [True, False])
def test_the_answer_of_the_service_is_a_full_set(types: Any, is_json: bool) -> None:
    content = b'{"sequence_number": 7, "markers": [{"name": "one"}]}'
    if not is_json:
        numbers = struct.pack("<QI", 7, 0)
        content = b"\0\1\0\0" + numbers
    asked = ServiceMessage("/s", "/ns/update_full", FULL_TYPE, as_full_set, print)
    message = asked.message(Reply(content, is_json), 5, "")
    read = Decoding(MessageTypes()).decode(message)
    assert (read.seq_num, read.server_id) == (7, "")
    assert [str(one.name) for one in read.markers] == (["one"] if is_json else [])


@pytest.mark.parametrize("reply", [Reply(b"[]", True), Reply(b"{}", True), Reply(b"")])
def test_another_answer_is_refused(reply: Reply) -> None:
    with pytest.raises(DecodeError):
        as_full_set(reply)


def test_a_menu_has_a_bottom_and_says_what_is_more(
    types: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = types["visualization_msgs/msg/MenuEntry"]
    made = marker(types)
    # The first is below itself, each other one below the one before.
    chain = [entry(1, 1, "ring", "", 0), entry(2, 0, "top", "", 0)]
    made.menu_entries = chain + [entry(n, n - 1, "", "", 0) for n in range(3, 40)]
    depth, below = 0, menu_of(made)
    assert [one.title for one in below] == ["top"]
    while below:
        depth, below = depth + 1, below[0].entries
    assert depth == 38
    lower(monkeypatch, "MENU_ENTRIES", 20)
    assert menu_of(made)[-1].title == "19 more, above 20"
    made.menu_entries = made.menu_entries[:20]
    assert len(menu_of(made)) == 1


# Where markers are


def test_a_marker_without_a_place_says_so_and_waits(shown: Open) -> None:
    opened = shown(update(lambda t: marker(t, frame="nowhere")))
    level, text = opened.statuses["one"]
    assert level == "Error" and "nowhere" in text
    assert not opened.node_names()
    add_frame(opened, "nowhere", (1.0, 2.0, 3.0))
    assert opened.statuses["one"] == ("Ok", "Locked to frame nowhere")
    assert opened.node_names()


def test_a_locked_marker_hangs_at_its_frame_and_a_stamped_one_does_not(
    shown: Open,
) -> None:
    opened = shown(
        update(
            lambda t: marker(t, "locked", frame="moving", x=1.0),
            lambda t: marker(t, "fixed", frame="moving", x=1.0, seconds=5),
        )
    )
    add_frame(opened, "moving", (10.0, 0.0, 0.0))
    assert opened.statuses["fixed"] == ("Ok", "Position is fixed.")
    key = opened.display.key
    locked, fixed = (handle_of(opened, f"{key}i{n}") for n in (1, 2))
    assert locked.position[0] == 1.0 and fixed.position[0] == 11.0
    assert locked.name.count("/") > fixed.name.count("/")


def test_a_fixed_control_stays_parallel_to_the_frame(shown: Open) -> None:
    opened = shown(
        update(
            lambda t: marker(
                t, turn=ALONG_Y, controls=[control(t, MOVE_AXIS, turning=FIXED)]
            )
        ),
        update(poses=[lambda t: moved(t, "one", 0.0, turn=ALONG_Z)], number=2),
    )
    x, y, z, w = ALONG_Z
    assert tuple(root(opened).wxyz) == pytest.approx((w, x, y, z))
    assert tuple(handle_of(opened, "/g10").wxyz) == pytest.approx((w, -x, -y, -z))


def test_a_marker_of_a_control_with_a_frame_is_placed_there_once(shown: Open) -> None:
    made = update(
        lambda t: marker(
            t, x=1.0, controls=[control(t, markers=[cube(t, frame="other", x=0.5)])]
        )
    )
    later = update(poses=[lambda t: moved(t, "one", 2.0)], number=2)
    opened = shown(made, later)
    add_frame(opened, "other", (10.0, 0.0, 0.0))
    # 10.5 in the map, seen from the marker at 2 when the frame was known.
    assert handle_of(opened, "bo").batched_positions[0][0] == pytest.approx(8.5)


def test_properties_show_descriptions_axes_and_transparency(shown: Open) -> None:
    opened = shown(update(lambda t: six_degrees(t, description="Title")))
    before = set(opened.node_names())
    opened.set("Show Axes", True)
    (axes,) = set(opened.node_names()) - before
    assert axes.endswith("/a")
    opened.set("Show Descriptions", False)
    (text,) = before - set(opened.node_names())
    assert "/g21/" in text
    rings = [name for name in opened.node_names() if "/g00/" in name]
    opened.set("Enable Transparency", False)
    # What is opaque is in one batch.
    assert len([n for n in opened.node_names() if "/g00/" in n]) < len(rings)
    opened.display.show(False)
    assert not opened.node_names()


def test_one_group_has_all_controls_that_are_turned_and_hidden_together(
    shown: Open,
) -> None:
    opened = shown(update(lambda t: six_degrees(t)))
    groups = [name for name in opened.node_names() if name[-4:-1] in ("/g0",)]
    assert [name[-4:] for name in groups] == ["/g00", "/g01"]


def test_a_pose_moves_one_node_and_makes_none(shown: Open) -> None:
    opened = shown(
        update(lambda t: six_degrees(t)),
        update(poses=[lambda t: moved(t, "one", 2.0)], number=2),
    )
    opened.viz.player.jump(0.0)
    before = {name: id(handle_of(opened, name)) for name in opened.node_names()}
    session_of(opened.viz).data.player.advance(1.0)
    assert root(opened).position[0] == 2.0
    assert before == {name: id(handle_of(opened, name)) for name in before}
    assert set(opened.node_names()) == set(before)


def test_rays_meet_what_is_always_visible(shown: Open) -> None:
    def boxed(types: Any, name: str, always: bool, **values: Any) -> object:
        box = [cube(types, scale=(1.0, 1.0, 1.0))]
        controls = [control(types, markers=box, always=always)]
        return marker(types, name, controls=controls, **values)

    opened = shown(
        update(
            lambda t: boxed(t, "a", True, x=2.0, frame="moving"),
            lambda t: boxed(t, "b", False, x=-3.0),
        )
    )
    add_frame(opened, "moving", (1.0, 0.0, 0.0))
    snapshot = PickSnapshot((opened.display.pick_geometry(),))
    down = np.array((0.0, 0.0, -1.0))
    hit = snapshot.first_hit(np.array((3.0, 0.0, 9.0)), down, 0.001)
    assert hit.point == pytest.approx((3.0, 0.0, 0.5))
    assert hit.item is not None
    assert (hit.item.kind, hit.item.name) == ("marker", "a/0")
    (facts,) = opened.display.selected(hit.item).facts(None)
    assert (facts.title, dict(facts.facts)["Frame"]) == ("Marker a/0", "moving")
    assert facts.position == pytest.approx((3.0, 0.0, 0.0))
    # A tool that clicks hides the other one.
    assert snapshot.first_hit(np.array((-3.0, 0.0, 9.0)), down, 0.001).point is None


# What is refused


@pytest.mark.parametrize(
    "made",
    [
        lambda t: marker(t, "bad", x=math.nan),
        lambda t: marker(t, "bad", scale=math.inf),
        lambda t: marker(t, "bad", controls=[control(t, turn=(math.nan, 0, 0, 1))]),
        lambda t: marker(
            t, "bad", controls=[control(t, markers=[cube(t, x=math.inf)])]
        ),
    ],
)
def test_numbers_that_are_none_are_refused_and_others_are_shown(
    shown: Open, made: Callable[[Any], Any]
) -> None:
    opened = shown(update(made, lambda t: marker(t, "good")))
    assert known(opened) == {"good"}
    assert opened.statuses["bad"] == ("Error", "Marker contains invalid floats!")


def test_a_pose_that_is_not_finite_leaves_the_marker_where_it_was(shown: Open) -> None:
    opened = shown(
        update(lambda t: marker(t, x=1.0)),
        update(poses=[lambda t: moved(t, "one", math.nan)], number=2),
    )
    assert root(opened).position[0] == 1.0
    wrong = "Pose message contains invalid floats!"
    assert opened.statuses["one"] == ("Error", wrong)


@pytest.mark.parametrize("scale", [1e30, -1e30])
def test_a_marker_that_is_absurdly_large_is_refused(shown: Open, scale: float) -> None:
    opened = shown(update(lambda t: marker(t, scale=scale)))
    assert "at most 1e+06 m" in opened.statuses["one"][1]
    assert not opened.node_names()


def test_a_marker_without_controls_is_empty(shown: Open) -> None:
    opened = shown(
        update(lambda t: marker(t)), update(lambda t: marker(t, controls=[]), number=2)
    )
    assert not known(opened)
    assert opened.statuses["one"] == ("Ok", "Marker empty.")


def test_a_shape_that_cannot_be_drawn_is_named_and_the_others_are_drawn(
    shown: Open,
) -> None:
    opened = shown(
        update(
            lambda t: marker(
                t, controls=[control(t, name="c", markers=[cube(t, kind=99), cube(t)])]
            )
        )
    )
    wrong = ("Error", "Control 'c': Unknown marker type: 99.")
    assert opened.statuses["one"] == wrong
    assert handle_of(opened, "bo") is not None


def test_points_that_no_browser_can_show_do_no_harm(shown: Open) -> None:
    points = [1e300, 0.0, 1.0, 0.0, 1.0, 2.0]
    shapes = [
        (kind, points[:2] if kind == 0 else points, colors)
        for kind in range(12)
        for colors in (0, 2, 6)
    ]

    def made(types: Any) -> object:
        boxes = [
            cube(types, kind=kind, points=some, colors=colors)
            for kind, some, colors in shapes
        ]
        controls = [control(types, markers=[box]) for box in boxes]
        return marker(types, "far", controls=controls)

    opened = shown(update(made, lambda t: marker(t, "good")))
    assert opened.statuses["good"][0] == "Ok"
    assert known(opened) == {"far", "good"}


@pytest.mark.parametrize("name", ["", CLIENT, "Updates"])
def test_any_name_of_a_marker_has_a_row(shown: Open, name: str) -> None:
    opened = shown(update(lambda t: marker(t, name)), update(erases=[name], number=3))
    assert not known(opened)
    client = opened.statuses[CLIENT]
    opened.viz.player.jump(0.0)
    assert client == opened.statuses[CLIENT]
    opened.display.report_topic()
    rows = [key for key, row in opened.statuses.items() if "Locked" in row[1]]
    assert len(rows) == 1 and rows != [CLIENT] and rows != [""]


def test_thousands_of_controls_are_refused(shown: Open) -> None:
    opened = shown(
        update(
            lambda t: marker(
                t, "many", controls=[control(t, ROTATE_AXIS) for _ in range(1001)]
            ),
            lambda t: marker(t, "few"),
        )
    )
    assert known(opened) == {"few"}
    assert "1,001 controls" in opened.statuses["many"][1]


def test_more_markers_than_are_shown_are_said(
    shown: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "INTERACTIVE_MARKERS", 120)
    names = [str(number) for number in range(121)]
    made = update(*(lambda t, n=n: marker(t, n, controls=[control(t)]) for n in names))
    opened = shown(made)
    assert len(known(opened)) == 120
    said = ("Warn", "More than the 120 markers that are shown")
    assert opened.statuses["Markers"] == said
    # Not all of them have a row.
    assert len(opened.statuses) < 110
