"""A presenter drives and the others watch: what their browsers may send."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from protocol_client import ROW_PATCH, ProtocolClient
from websockets.datastructures import Headers

from sambot_viz import UsageError, Visualizer, viser_private
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.server.tickets import REMOVED
from sambot_viz.session import Session

Protocol = Callable[..., ProtocolClient]
JOINT = "drivewhl_l_joint"
REFUSED = "View only: request control"


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer]) -> Visualizer:
    return make_viz(presenter="teach-the-class")


@pytest.fixture
def settle(viz: Visualizer) -> Callable[..., None]:
    """Wait for all that clients have caused."""

    def settled(*clients: ProtocolClient) -> None:
        for client in clients:
            client.settle(viser_server(viz))

    return settled


@pytest.fixture
def guest(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    client = protocol(viz.viser.get_port())
    client.settle(viser_server(viz))
    return client


@pytest.fixture
def teacher(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    client = protocol(viz.viser.get_port(), path="/?token=teach-the-class")
    client.settle(viser_server(viz))
    return client


def joint(client: ProtocolClient) -> str:
    return client.id_of("joints", JOINT)


def me(client: ProtocolClient) -> Any:
    return client.row("role/me")["value"]


def people(client: ProtocolClient) -> list[Any]:
    """The rows of everyone, as a page has them."""
    return [row for id, row in client.rows.items() if id.startswith("person/")]


def in_control(client: ProtocolClient) -> list[str]:
    return [row["name"] for row in people(client) if row.get("control")]


def notice(client: ProtocolClient) -> str:
    """The last one; empty before the first."""
    return client.rows.get("notice", {}).get("value", {}).get("text", "")


def requests(client: ProtocolClient) -> list[tuple[int, str]]:
    return [(r["client"], r["name"]) for r in people(client) if r.get("requests")]


def give_control(
    teacher: ProtocolClient,
    client: ProtocolClient,
    name: str,
    settle: Callable[..., None],
) -> None:
    """Let a viewer request control under a name, and the presenter give it."""
    client.act("role/request", name)
    settle(client, teacher)
    ((number, _),) = requests(teacher)
    teacher.act("role/give", number)


def everything(viz: Visualizer, session: Session) -> object:
    """All that the browsers of a session have in common."""
    return (
        dict(viz.joint_positions),
        session.document.config.to_yaml(),
        sorted(session.frames.tree.frames),
        dict(session.frames.added),
        session.poses.names,
        session.clients.leading.value,
        session.motion.turning.value,
        session.history.modified.value,
    )


def other_value(row: Any) -> Any:
    """A value that a row would take, other than the one it has."""
    kind, value = row["kind"], row.get("value")
    if kind in ("bool", "display"):
        return not value
    if kind in ("int", "float", "slider"):
        low, high = row.get("min", -1e6), row.get("max", 1e6)
        return next(v for v in (1, 2, low, high) if v != value and low <= v <= high)
    if kind == "vector":
        return [part + 1 for part in value]
    if kind == "color":
        return "1; 2; 3"
    if kind in ("enum", "frame"):
        return next((o for o in row.get("options", ()) if o != value), "base_link")
    return "other"


ARGUMENTS: list[list[Any]] = [[], ["x"], ["x", "y"], ["x", "", 0], [[]], [[], []]]
"""What commands take, of all lengths; a viewer is refused before that counts."""


def test_nothing_that_a_watcher_sends_changes_what_others_see(
    viz: Visualizer,
    session: Session,
    guest: ProtocolClient,
    settle: Callable[..., None],
) -> None:
    settle(guest)
    before = everything(viz, session)
    rows = [
        row
        for row in guest.rows.values()
        if not row.get("fixed") and row["kind"] != "data"
    ]
    shared = [row for row in rows if not row.get("local")]
    assert len(shared) > 50 and len(rows) - len(shared) > 20
    for row in shared:
        if row["kind"] != "command":
            guest.edit(row["id"], other_value(row))
        else:
            for values in ARGUMENTS:
                guest.act(row["id"], *values)
    # Their own rows they may set: the view, tools, the frames they look from.
    for row in rows:
        if row.get("local") and row["kind"] != "command":
            guest.edit(row["id"], other_value(row))
    for tool in ("Select", "Measure"):
        guest.act("tools/choose", tool)
    guest.act("tools/zero")
    settle(guest)
    assert everything(viz, session) == before
    tools = guest.row("tools/list")["value"]
    assert [tool["name"] for tool in tools if tool["current"]] == ["Measure"]


def test_a_refused_edit_is_answered_in_its_own_browser(
    guest: ProtocolClient, teacher: ProtocolClient, settle: Callable[..., None]
) -> None:
    guest.edit(joint(guest), 1.0)
    settle(guest, teacher)
    assert guest.row("notice")["value"]["text"].startswith(REFUSED)
    assert teacher.row("notice").get("value") is None


def test_the_presenter_drives_and_the_guests_see_it(
    viz: Visualizer,
    guest: ProtocolClient,
    teacher: ProtocolClient,
    settle: Callable[..., None],
) -> None:
    teacher.edit(joint(teacher), 1.0)
    settle(teacher, guest)
    assert viz.joint_positions[JOINT] == 1.0
    assert guest.shown("joints", JOINT) == 1.0
    assert not me(guest)["control"] and me(teacher)["presenter"]
    assert in_control(guest) == ["Presenter"] and len(people(guest)) == 2


def test_a_guest_is_given_the_wheel_drives_and_gives_it_back(
    viz: Visualizer,
    session: Session,
    guest: ProtocolClient,
    teacher: ProtocolClient,
    settle: Callable[..., None],
) -> None:
    guest.act("role/request", "Ann <b>")
    settle(guest, teacher)
    ((number, name),) = requests(teacher)
    assert name == "Ann <b>"
    guest.act("role/give", number)
    settle(guest)
    assert "Only the presenter" in guest.row("notice")["value"]["text"]
    teacher.act("role/give", number)
    settle(teacher, guest)
    guest.edit(joint(guest), 0.5)
    settle(guest)
    assert viz.joint_positions[JOINT] == 0.5
    assert in_control(teacher) == ["Presenter", "Ann <b>"]
    guest.act("role/release")
    guest.edit(joint(guest), 0.7)
    guest.act("edit/undo")
    settle(guest)
    assert viz.joint_positions[JOINT] == 0.5


def test_the_wheel_is_free_when_its_guest_has_left(
    session: Session,
    guest: ProtocolClient,
    teacher: ProtocolClient,
    settle: Callable[..., None],
) -> None:
    guest.act("role/request", "")
    settle(guest, teacher)
    ((number, _),) = requests(teacher)
    teacher.act("role/give", number)
    settle(teacher)
    guest.close()
    teacher.wait_until(lambda: len(session.clients.all) == 1)
    settle(teacher)
    assert in_control(teacher) == ["Presenter"] and len(people(teacher)) == 1


def test_a_watcher_does_not_set_the_widgets_of_a_program(
    viz: Visualizer,
    guest: ProtocolClient,
    teacher: ProtocolClient,
    settle: Callable[..., None],
) -> None:
    slider = viz.viser.gui.add_slider("speed", 0.0, 1.0, 0.1, 0.0)
    settle(guest, teacher)
    guest.set_value(guest.uuid_of("speed"), 0.5)
    settle(guest)
    assert slider.value == 0.0
    assert guest.value_of("speed") == 0.0
    teacher.set_value(teacher.uuid_of("speed"), 0.3)
    settle(teacher)
    assert slider.value == 0.3


def test_a_wrong_presenter_token_does_not_drive(
    viz: Visualizer, session: Session, protocol: Protocol
) -> None:
    with pytest.raises(Exception, match="401"):
        protocol(viz.viser.get_port(), path="/?token=teach-the-clasS")
    assert not session.clients.all


def test_a_private_session_has_no_presenter() -> None:
    with pytest.raises(UsageError, match="leave --session private out"):
        Visualizer(port=0, session="private", presenter="")


def test_one_secret_for_both_links_is_refused() -> None:
    with pytest.raises(UsageError, match="different secrets"):
        Visualizer(port=0, token="same-secret", presenter="same-secret")


def test_the_presenters_link_lets_in_too(protocol: Protocol) -> None:
    with Visualizer(port=0, token="", presenter="") as viz:
        assert viz.presenter_url is not None and viz.presenter_url != viz.url
        port = viz.viser.get_port()
        with pytest.raises(Exception, match="401"):
            protocol(port)
        drives = []
        for url in (viz.url, viz.presenter_url):
            client = protocol(port, path=f"/?{url.partition('?')[2]}")
            client.settle(viser_server(viz))
            drives.append(me(client)["control"])
        assert drives == [False, True]


def test_each_hears_what_the_other_does_about_control(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    settle: Callable[..., None],
    session: Session,
) -> None:
    def heard(client: ProtocolClient) -> str:
        settle(guest, teacher, guest, teacher)
        return client.row("notice")["value"]["text"]

    def ask() -> int:
        guest.act("role/request", "Ann")
        settle(guest, teacher)
        ((number, _),) = requests(teacher)
        return number

    teacher.act("role/decline", ask())
    assert heard(guest) == "The presenter declined your request"
    teacher.act("role/give", ask())
    assert heard(guest).startswith("You can now change the robot")
    teacher.act("role/take-back")
    assert heard(guest).endswith("the presenter has taken back control")
    teacher.act("role/give", ask())
    settle(teacher)
    guest.act("role/release")
    assert heard(guest) == "You have released control"
    assert heard(teacher) == "Ann is no longer in control"


def test_who_loses_control_hears_who_has_it(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    settle: Callable[..., None],
) -> None:
    other = protocol(viz.viser.get_port())
    for client, name in ((guest, "Ann"), (other, "Ben")):
        settle(client)
        give_control(teacher, client, name, settle)
    settle(teacher, guest)
    assert guest.row("notice")["value"]["text"] == "View only: Ben is now in control"
    guest.act("role/request", "ben")
    settle(guest)
    assert "is called 'ben' already" in guest.row("notice")["value"]["text"]
    teacher.close()
    other.close()
    guest.wait_until(lambda: len(people(guest)) == 1)
    guest.act("role/request", "Ann")
    settle(guest)
    assert "no presenter is here" in guest.row("notice")["value"]["text"]


def test_a_presenter_gives_unasked_renames_and_declines_all(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    settle: Callable[..., None],
) -> None:
    other = protocol(viz.viser.get_port())
    settle(other)
    own, first, second = me(teacher)["client"], me(guest)["client"], me(other)["client"]
    teacher.act("role/rename", own, "Ms Weber")
    teacher.act("role/rename", first, "Ann")
    settle(teacher, guest)
    assert guest.row("notice")["value"]["text"] == "The presenter has renamed you: Ann"
    assert [row["name"] for row in people(guest)] == ["Ms Weber", "Ann", "Viewer 2"]
    teacher.act("role/give", first)
    settle(teacher, guest)
    assert in_control(other) == ["Ms Weber", "Ann"]
    # A name that a page has kept is made another one when somebody has it.
    for name, kept in (("ann", "ann 2"), ("MS WEBER", "MS WEBER 2"), ("Ben", "Ben")):
        other.act("role/greet", name, "")
        settle(other)
        assert me(other)["name"] == kept
    other.act("role/rename", first, "Mallory")
    settle(other)
    assert "Only the presenter" in other.row("notice")["value"]["text"]
    other.act("role/request", "")
    settle(other, teacher)
    assert requests(teacher) == [(second, "Ben")]
    teacher.act("role/decline-all")
    settle(teacher, other)
    assert requests(other) == [] and in_control(other) == ["Ms Weber", "Ann"]
    # Nobody takes the presenter's name while her page is loaded again.
    teacher.close()
    other.wait_until(lambda: len(people(other)) == 2)
    other.act("role/rename", second, "Ms  Weber")
    settle(other)
    assert "already" in other.row("notice")["value"]["text"]
    again = protocol(viz.viser.get_port(), path="/?token=teach-the-class")
    settle(again)
    assert me(again)["name"] == "Ms Weber"


def test_one_of_thirty_people_who_changes_is_one_row(
    guest: ProtocolClient, teacher: ProtocolClient, settle: Callable[..., None]
) -> None:
    settle(guest, teacher)
    mark = teacher.mark()
    guest.act("role/request", "Ann")
    settle(guest, teacher)
    sent = [m.fields for m in teacher.since(mark) if m.type == ROW_PATCH]
    number = me(guest)["client"]
    assert [one for one in sent if one["of"] == "session"] == [
        {
            "of": "session",
            "rows": {f"person/{number}": {"name": "Ann", "requests": True}},
        }
    ]


def test_a_viewer_who_is_removed_does_not_come_back_by_itself(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    settle: Callable[..., None],
) -> None:
    number = me(guest)["client"]
    guest.act("role/remove", me(teacher)["client"])
    guest.act("role/remove", number)
    settle(guest)
    assert "Only the presenter" in guest.row("notice")["value"]["text"]
    teacher.act("role/remove", number)
    teacher.wait_until(lambda: len(people(teacher)) == 1)
    settle(teacher)
    assert teacher.row("notice")["value"]["text"] == "Removed Viewer 1"
    teacher.wait_until(lambda: guest.channel_code == REMOVED)
    with pytest.raises(Exception, match="403"):
        protocol(viz.viser.get_port(), ticket=guest.ticket)
    # With a page that was loaded again, whoever has the link may come in.
    settle(protocol(viz.viser.get_port()))
    assert len(people(teacher)) == 2


def test_folders_of_the_server_are_shown_to_those_in_control_only(
    guest: ProtocolClient, teacher: ProtocolClient, settle: Callable[..., None]
) -> None:
    def folder(client: ProtocolClient) -> Any:
        settle(teacher, guest)
        return client.row("file/state")["value"].get("folder")

    assert folder(teacher) and folder(guest) is None
    give_control(teacher, guest, "Ann", settle)
    settle(teacher)
    assert folder(guest) == folder(teacher)
    teacher.act("role/take-back")
    assert folder(guest) is None and folder(teacher)


def test_a_viewer_undoes_what_it_did_as_a_viewer_and_nothing_else(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    viz: Visualizer,
    settle: Callable[..., None],
    session: Session,
) -> None:
    give_control(teacher, guest, "Ann", settle)
    settle(teacher)
    guest.edit(joint(guest), 1.0)
    settle(guest)
    teacher.act("role/take-back")
    settle(teacher)
    distance = guest.id_of("views", "Distance")
    guest.edit(distance, 7.5)
    settle(guest)
    before = everything(viz, session)
    for _ in range(2):
        guest.act("edit/undo")
        settle(guest)
    assert guest.row(distance)["value"] != 7.5
    assert guest.row("notice")["value"]["text"].startswith(REFUSED)
    guest.act("edit/redo")
    settle(guest)
    assert guest.row(distance)["value"] == 7.5
    assert everything(viz, session) == before


def test_a_presenter_leads_all_views_at_once_and_a_viewer_may_leave(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    settle: Callable[..., None],
) -> None:
    def distance(client: ProtocolClient) -> float:
        settle(teacher, guest, client)
        return client.row("view/Distance")["value"]

    teacher.edit("view/Distance", 7.0)
    settle(teacher)
    assert distance(guest) != 7.0 and "view/:follow" not in guest.rows
    teacher.edit("view/:lead", True)
    assert distance(guest) == 7.0
    assert "leads your view" in guest.row("notice")["value"]["text"]
    late = protocol(viz.viser.get_port())
    late.wait_until(lambda: "view/:follow" in late.rows)
    assert distance(late) == 7.0
    assert "leads your view" in late.row("notice")["value"]["text"]
    guest.edit("view/:follow", False)
    settle(guest)
    teacher.edit("view/Distance", 3.0)
    settle(teacher)
    assert (distance(guest), distance(late)) == (7.0, 3.0)
    guest.edit("view/:follow", True)
    assert distance(guest) == 3.0
    guest.edit("view/:lead", False)
    settle(guest)
    teacher.edit("view/:lead", False)
    settle(teacher)
    teacher.edit("view/Distance", 9.0)
    assert distance(guest) == 3.0 and "view/:follow" not in guest.rows


def test_a_presenter_brings_everyone_to_a_view_once(
    guest: ProtocolClient, teacher: ProtocolClient, settle: Callable[..., None]
) -> None:
    teacher.act("role/rename", me(teacher)["client"], "Ms Weber")
    teacher.edit("view/Distance", 7.0)
    guest.act("views/bring")
    settle(teacher, guest)
    assert guest.row("notice")["value"]["text"].startswith(REFUSED)
    teacher.act("views/bring")
    settle(teacher, guest)
    assert guest.row("view/Distance")["value"] == 7.0
    sentence = "Ms Weber moved your view"
    assert guest.row("notice")["value"]["text"] == sentence
    assert teacher.row("notice")["value"]["text"] == "1 other page shows your view"
    teacher.edit("view/Distance", 3.0)
    settle(teacher, guest)
    assert guest.row("view/Distance")["value"] == 7.0


def test_what_the_presenter_selects_glows_for_all_and_leaves_nothing(
    guest: ProtocolClient,
    teacher: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    session: Session,
    settle: Callable[..., None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    link = Selectable("link", "drivewhl_l_link")
    ends: list[Callable[[], None]] = []
    post_later, pointer = session.worker.post_later, session.clients.pointer

    def keep(delay: float, action: Any) -> None:
        if getattr(action, "__self__", None) is pointer:
            ends.append(action)
        else:
            post_later(delay, action)

    monkeypatch.setattr(session.worker, "post_later", keep)

    def select(client: ProtocolClient) -> None:
        tools = session.clients.all[me(client)["client"]].tools
        session.worker.post(lambda: tools.select({link}, None))
        settle(client, guest, teacher)

    def pointed(client: ProtocolClient) -> list[str]:
        ours = [m for m in client.messages if "/~pointed" in str(m.fields.get("name"))]
        return [m.type for m in ours if "Visibility" not in m.type]

    settle(guest, teacher)
    select(guest)
    guest.act("tools/point")
    settle(guest)
    assert guest.row("notice")["value"]["text"].startswith(REFUSED)
    assert pointed(teacher) == []
    select(teacher)
    assert pointed(guest) == pointed(teacher) == ["LineSegmentsMessage"]
    monkeypatch.setattr(pointer, "_until", 0.0)
    session.worker.post(ends[0])
    settle(guest, teacher)
    # Nothing of both is left for those who come later.
    assert pointed(guest) == ["LineSegmentsMessage", "RemoveSceneNodeMessage"]
    late = protocol(viz.viser.get_port())
    settle(late)
    assert "LineSegmentsMessage" not in pointed(late)
    assert buffered(viz) <= ["RemoveSceneNodeMessage"]
    # The next time takes its place.
    select(teacher)
    assert buffered(viz) == ["LineSegmentsMessage"]
    assert pointed(late)[-1] == "LineSegmentsMessage"


def buffered(viz: Visualizer) -> list[str]:
    """Return what waits for those who come later, of what is pointed at."""
    kept = viser_private.broadcast_buffer(viser_server(viz)).message_from_id
    ours = [m for m in [*kept.values()] if "pointed" in str(getattr(m, "name", ""))]
    return [name for m in ours if "Visibility" not in (name := type(m).__name__)]


def test_private_sessions_know_nothing_of_people(protocol: Protocol) -> None:
    with Visualizer(port=0, session="private") as viz:
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda: "people/state" in client.rows)
        state = client.row("people/state")["value"]
        assert not state["copy"] and not state["presented"]


@pytest.mark.parametrize(
    ("trusted", "sent", "name"),
    [
        (None, ["Ada"], "Viewer 1"),
        ("X-Remote-User", ["Ada"], "Ada"),
        ("X-Remote-User", ["Ada", "Eve"], "Viewer 1"),
        ("X-Remote-User", [], "Viewer 1"),
    ],
)
def test_only_a_trusted_header_names_a_viewer(
    make_viz: Callable[..., Visualizer],
    trusted: str | None,
    sent: list[str],
    name: str,
) -> None:
    viz = make_viz(presenter="teach-the-class", trust_user_header=trusted)
    headers = Headers()
    for one in sent:
        headers["X-Remote-User"] = one
    client = ProtocolClient(viz.viser.get_port(), headers=headers)
    roles = session_of(viz).roles
    client.wait_until(lambda: bool(roles.people), 20.0)
    named = [person.name for person in roles.people.values()]
    client.close()
    assert named == [name]


def test_viewers_see_the_names_of_files_and_a_presenter_their_folders(
    viz: Visualizer, guest: ProtocolClient, teacher: ProtocolClient, tmp_path: Path
) -> None:
    file = tmp_path / "other.urdf"
    file.write_text("<robot name='r'><link name='a'/></robot>", "utf-8")
    session = session_of(viz)
    display = next(d for d in session.scene.displays if d.robot_display is not None)
    with session.worker.lock:
        # As of a config that names a file elsewhere.
        display.config.set("Description Source", "File")
        display.config.set("Description File", str(file))
        display.property_changed("Description File")
        display.status.set("URDF", "Error", f"URDF is empty: no file '{file}'")
        session.scene.statuses.touch()
    for client in (guest, teacher):
        client.settle(viser_server(viz))
    path = guest.id_of("displays", "RobotModel", "Description File")
    status = f"{path.partition('/')[0]}/:status/URDF"
    for client in (guest, teacher):
        assert client.row(path)["value"] == "other.urdf"
        assert str(tmp_path) not in json.dumps(client.row(status))
    assert "displays/paths" not in guest.rows
    whole = teacher.row("displays/paths")["value"]
    assert whole[path] == str(file)
    assert str(file) in whole[status]


def test_control_that_was_given_is_kept_over_a_private_copy(
    teacher: ProtocolClient,
    guest: ProtocolClient,
    protocol: Protocol,
    viz: Visualizer,
    settle: Callable[..., None],
) -> None:
    teacher.act("role/give", me(guest)["client"])
    settle(teacher, guest)
    key, name = me(guest)["key"], me(guest)["name"]
    guest.close()
    teacher.wait_until(lambda: notice(teacher) == f"{name} has left, and had control")
    assert in_control(teacher) == ["Presenter"]
    assert key not in json.dumps([m.fields for m in teacher.messages], default=str)
    back = protocol(viz.viser.get_port())
    settle(back)
    back.act("role/greet", "Ann", key)
    settle(back, teacher)
    assert in_control(teacher) == ["Presenter", "Ann"]


def test_a_presenter_reads_who_has_left(
    teacher: ProtocolClient, guest: ProtocolClient, settle: Callable[..., None]
) -> None:
    teacher.act("role/rename", me(guest)["client"], "Ann")
    settle(teacher, guest)
    guest.close()
    teacher.wait_until(lambda: notice(teacher) == "Ann has left")
    assert len(people(teacher)) == 1


def test_undo_is_decided_by_the_server(
    teacher: ProtocolClient, viz: Visualizer, settle: Callable[..., None]
) -> None:
    before = viz.joint_positions[JOINT]
    # In one go, as hands are quicker than the answer.
    teacher.edit(joint(teacher), 1.0)
    teacher.act("edit/undo")
    teacher.act("edit/undo")
    settle(teacher)
    assert viz.joint_positions[JOINT] == before


def test_with_slots_control_passes_in_the_order_of_the_requests(
    make_viz: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = make_viz(presenter="teach-the-class", slot=60.0)
    ann, ben = (protocol(viz.viser.get_port()) for _ in range(2))
    for client, name in ((ann, "Ann"), (ben, "Ben")):
        client.wait_until(lambda client=client: "role/me" in client.rows)
        client.act("role/request", name)
        client.wait_until(lambda client=client, name=name: me(client)["name"] == name)
    ann.wait_until(lambda: me(ann)["control"])
    ben.wait_until(lambda: own_row(ben).get("place") == 1)
    assert 50 <= own_row(ben)["wait"] <= 60 and not me(ben)["control"]
    assert ben.row("people/state")["value"]["slot"] == 60.0
    ann.act("role/release")
    # A pause lies between two who did not hand over.
    ann.wait_until(lambda: not me(ann)["control"])
    ben.wait_until(lambda: me(ben)["control"], timeout=30.0)


def own_row(client: ProtocolClient) -> Any:
    return client.row(f"person/{me(client)['client']}")
