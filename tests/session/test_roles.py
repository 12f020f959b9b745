"""Who drives and who watches, as the session knows it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any, cast

import pytest

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.signals import Change
from sambot_viz.session.worker import Worker

TEACHER, ANN, BEN = 1, 2, 3


@pytest.fixture
def change() -> Iterator[Change]:
    loop = asyncio.new_event_loop()
    yield Change(Worker(loop), cast(Any, None))
    loop.close()


@pytest.fixture
def roles(change: Change) -> Roles:
    roles = Roles(change, presented=True)
    roles.join(ANN, presenter=False)
    roles.join(TEACHER, presenter=True)
    roles.join(BEN, presenter=False)
    return roles


def drivers(roles: Roles) -> list[str]:
    return [person.name for person in roles.people.values() if person.has_control]


def test_without_a_presenter_everyone_drives_also_before_joining(
    change: Change,
) -> None:
    roles = Roles(change)
    assert roles.may_edit(7)
    roles.join(7, presenter=False)
    assert roles.may_edit(7) and drivers(roles) == ["Viewer 1"]
    roles.release(7)
    assert roles.may_edit(7)


def test_only_the_presenter_drives_and_unknown_browsers_watch(roles: Roles) -> None:
    assert [roles.may_edit(one) for one in (TEACHER, ANN, BEN, 99)] == [True] + 3 * [
        False
    ]
    assert drivers(roles) == ["Presenter"]


def test_asking_gives_nothing_by_itself(roles: Roles) -> None:
    roles.request(ANN, " Ann ")
    assert not roles.may_edit(ANN)
    assert roles.people[ANN].requests and roles.people[ANN].name == "Ann"
    roles.request(BEN)
    assert roles.people[BEN].name == "Viewer 2"


def test_a_name_that_is_too_long_is_refused(roles: Roles) -> None:
    with pytest.raises(UsageError, match="at most 40 characters"):
        roles.request(ANN, "A" * (limits.PERSON_NAME.value + 1))
    assert not roles.people[ANN].requests


@pytest.mark.parametrize(
    "name",
    [
        "Presenter",
        " presenter 2",
        "PRESENTERs friend",
        "Рresenter",  # Cyrillic
        "РRЕЅЕNТЕR",
        "Presenteг",
        "Ρresentεr",  # Greek
        "Pre\u00adsenter",
        "Ｐｒｅｓｅｎｔｅｒ",
        "ᴘʀᴇꜱᴇɴᴛᴇʀ",
    ],
)
def test_nobody_else_is_called_presenter(roles: Roles, name: str) -> None:
    with pytest.raises(UsageError, match="are the presenter's"):
        roles.request(ANN, name)
    roles.request(TEACHER, name)
    assert roles.people[ANN].name == "Viewer 1"


def test_two_names_that_look_alike_are_one(roles: Roles) -> None:
    roles.request(ANN, "Ann")
    with pytest.raises(UsageError, match="someone here is called"):
        roles.request(BEN, "Аnn")  # the first letter is Cyrillic
    # Names in other letters are as good.
    for name in ("Димитрий", "Ελένη", "Պետրոս", "民樹", "می\u200cخواهم"):
        roles.request(BEN, name)
        assert roles.people[BEN].name == name


def test_the_wheel_goes_to_one_guest_at_a_time_and_back(roles: Roles) -> None:
    roles.request(ANN, "Ann")
    roles.give(TEACHER, ANN)
    assert drivers(roles) == ["Ann", "Presenter"] and not roles.people[ANN].requests
    roles.give(TEACHER, BEN)
    assert drivers(roles) == ["Presenter", "Viewer 2"]
    roles.release(BEN)
    assert drivers(roles) == ["Presenter"]
    roles.give(TEACHER, ANN)
    roles.take_back(TEACHER)
    assert drivers(roles) == ["Presenter"]


def test_a_question_can_be_refused_or_taken_back(roles: Roles) -> None:
    roles.request(ANN)
    roles.refuse(TEACHER, ANN)
    assert not roles.people[ANN].requests
    roles.request(ANN)
    roles.release(ANN)
    assert not roles.people[ANN].requests and not roles.may_edit(ANN)


def test_a_guest_cannot_give_take_or_refuse(roles: Roles) -> None:
    roles.request(BEN)
    roles.give(TEACHER, ANN)
    for act in (roles.give, roles.refuse):
        with pytest.raises(UsageError, match="only the presenter"):
            act(ANN, BEN)
    with pytest.raises(UsageError, match="only the presenter"):
        roles.take_back(BEN)
    assert drivers(roles) == ["Viewer 1", "Presenter"]


def test_the_wheel_cannot_go_to_who_has_left(roles: Roles) -> None:
    roles.leave(ANN)
    for gone in (ANN, 99, TEACHER):
        with pytest.raises(UsageError, match="this viewer has left"):
            roles.give(TEACHER, gone)


def test_who_leaves_with_the_wheel_comes_back_without_it(roles: Roles) -> None:
    roles.give(TEACHER, ANN)
    roles.leave(ANN)
    roles.join(ANN, presenter=False)
    assert not roles.may_edit(ANN)


def test_the_presenter_cannot_lose_the_wheel(roles: Roles) -> None:
    roles.release(TEACHER)
    assert roles.may_edit(TEACHER)
    roles.join(4, presenter=True)
    assert drivers(roles) == ["Presenter", "Presenter 2"]


def test_a_presenter_who_loads_the_page_again_is_no_second_one(roles: Roles) -> None:
    roles.leave(TEACHER)
    roles.join(5, presenter=True)
    assert roles.people[5].name == "Presenter"


def test_a_login_names_its_viewer_who_keeps_that_name(roles: Roles) -> None:
    cat, again, dog = 4, 5, 6
    roles.join(cat, presenter=False, login="cat@school\n")
    roles.join(again, presenter=False, login="cat@school")
    roles.join(dog, presenter=False, login="Presenter 2")
    people = roles.people
    assert people[cat].name == "cat@school"
    assert people[again].name == "cat@school 2"
    assert people[dog].name == "User Presenter 2"
    with pytest.raises(UsageError, match="that of the login"):
        roles.rename(dog, dog, "Cat")
    roles.greet(cat, "Ben")
    roles.request(cat, "Ben")
    assert roles.people[cat].requests and roles.people[cat].name == people[cat].name
    for by in (cat, TEACHER):
        with pytest.raises(UsageError, match="that of the login"):
            roles.rename(by, cat, "Ben")


@pytest.mark.parametrize("meanwhile", ["nothing", "taken", "given", "removed"])
def test_who_comes_again_has_control_again_unless_a_presenter_changed_it(
    roles: Roles, meanwhile: str
) -> None:
    roles.give(TEACHER, ANN)
    key = roles.people[ANN].key
    if meanwhile == "removed":
        roles.remove(TEACHER, ANN)
    else:
        roles.leave(ANN)
    if meanwhile == "taken":
        roles.take_back(TEACHER)
    elif meanwhile == "given":
        roles.give(TEACHER, BEN)
    for client_id, kept in ((7, "another's"), (8, key), (9, key)):
        roles.join(client_id, presenter=False)
        roles.greet(client_id, "", kept)
    has = [n for n in (7, 8, 9) if roles.people[n].has_control]
    assert has == ([8] if meanwhile == "nothing" else [])
