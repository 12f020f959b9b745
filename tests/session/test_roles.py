"""Who drives and who watches, as the session knows it."""

from __future__ import annotations

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.session.roles import LONGEST_NAME, Roles

TEACHER, ANN, BEN = 1, 2, 3


@pytest.fixture
def roles() -> Roles:
    roles = Roles(presented=True)
    roles.join(ANN, presenter=False)
    roles.join(TEACHER, presenter=True)
    roles.join(BEN, presenter=False)
    return roles


def drivers(roles: Roles) -> list[str]:
    return [person.name for person in roles.people.values() if person.drives]


def test_without_a_presenter_everyone_drives_also_before_joining() -> None:
    roles = Roles()
    assert roles.may_edit(7)
    roles.join(7, presenter=False)
    assert roles.may_edit(7) and drivers(roles) == ["Guest 1"]
    roles.hand_back(7)
    assert roles.may_edit(7)


def test_only_the_presenter_drives_and_unknown_browsers_watch(roles: Roles) -> None:
    assert [roles.may_edit(one) for one in (TEACHER, ANN, BEN, 99)] == [True] + 3 * [
        False
    ]
    assert drivers(roles) == ["Presenter"]


def test_asking_gives_nothing_by_itself(roles: Roles) -> None:
    roles.ask(ANN, " Ann ")
    assert not roles.may_edit(ANN)
    assert roles.people[ANN].asks and roles.people[ANN].name == "Ann"
    roles.ask(BEN)
    assert roles.people[BEN].name == "Guest 2"


def test_a_name_that_is_too_long_is_refused(roles: Roles) -> None:
    with pytest.raises(UsageError, match="at most 40 characters"):
        roles.ask(ANN, "A" * (LONGEST_NAME + 1))
    assert not roles.people[ANN].asks


def test_the_wheel_goes_to_one_guest_at_a_time_and_back(roles: Roles) -> None:
    roles.ask(ANN, "Ann")
    roles.give(TEACHER, ANN)
    assert drivers(roles) == ["Ann", "Presenter"] and not roles.people[ANN].asks
    roles.give(TEACHER, BEN)
    assert drivers(roles) == ["Presenter", "Guest 2"]
    roles.hand_back(BEN)
    assert drivers(roles) == ["Presenter"]
    roles.give(TEACHER, ANN)
    roles.take(TEACHER)
    assert drivers(roles) == ["Presenter"]


def test_a_question_can_be_refused_or_taken_back(roles: Roles) -> None:
    roles.ask(ANN)
    roles.refuse(TEACHER, ANN)
    assert not roles.people[ANN].asks
    roles.ask(ANN)
    roles.hand_back(ANN)
    assert not roles.people[ANN].asks and not roles.may_edit(ANN)


def test_a_guest_cannot_give_take_or_refuse(roles: Roles) -> None:
    roles.ask(BEN)
    roles.give(TEACHER, ANN)
    for act in (roles.give, roles.refuse):
        with pytest.raises(UsageError, match="only the presenter"):
            act(ANN, BEN)
    with pytest.raises(UsageError, match="only the presenter"):
        roles.take(BEN)
    assert drivers(roles) == ["Guest 1", "Presenter"]


def test_the_wheel_cannot_go_to_who_has_left(roles: Roles) -> None:
    roles.leave(ANN)
    for gone in (ANN, 99, TEACHER):
        with pytest.raises(UsageError, match="not there any more"):
            roles.give(TEACHER, gone)


def test_who_leaves_with_the_wheel_comes_back_without_it(roles: Roles) -> None:
    roles.give(TEACHER, ANN)
    roles.leave(ANN)
    roles.join(ANN, presenter=False)
    assert not roles.may_edit(ANN)


def test_the_presenter_cannot_lose_the_wheel(roles: Roles) -> None:
    roles.hand_back(TEACHER)
    assert roles.may_edit(TEACHER)
    roles.join(4, presenter=True)
    assert drivers(roles) == ["Presenter", "Presenter 2"]


def test_a_presenter_who_loads_the_page_again_is_no_second_one(roles: Roles) -> None:
    roles.leave(TEACHER)
    roles.join(5, presenter=True)
    assert roles.people[5].name == "Presenter"
