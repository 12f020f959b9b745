"""The panel that drives a live robot by hand, its goal, and STOP for everyone.

Messages of a driving hand are handled at once, on the event loop and without the
session's lock: a hanging session does not delay a stop (see
`publishing.dead_mans_switch`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from sambot_viz.errors import PublishError
from sambot_viz.panels.command import INTEGER, Argument, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Row
from sambot_viz.publishing.dead_mans_switch import Hand
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.publishing.velocity import VELOCITY_TYPES
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.signals import Signal

_PART = Argument(float, least=-1.0, most=1.0)
"""Of the highest speed."""
_NO_TYPE = "choose one"
_TYPES = {name.rpartition("/")[2]: name for name in VELOCITY_TYPES}


class LiveDrivePanel(Panel):
    """Drives a live robot; without one the panel is empty.

    Args:
        publisher: the way to the robot.
        roles: know who may drive, and who gets control back.
        driven: emitted when a user begins or ends to drive.
        post: schedules a call in the session's thread.
    """

    name = "live"

    def __init__(
        self,
        publisher: Publisher,
        roles: Roles,
        driven: Signal[Any],
        post: Callable[[Callable[[], object]], object],
    ) -> None:
        self.remade_by = (driven, roles.changed)
        self._publisher, self._roles, self._post = publisher, roles, post

    def refresh(self) -> None:
        """Stop a user who drives and no longer may."""
        driver = self._publisher.driver
        hand = driver and driver.driving.hand
        if driver is None or hand is None:
            return
        if hand.client not in self._roles.people:
            driver.leave(hand.client)
        elif not self._roles.may_edit(hand.client):
            driver.stop("who drove it has no control now")

    def rows(self) -> Sequence[Row]:
        """Return where velocities go, and how fast at most."""
        driver = self._publisher.driver
        if self._publisher.robot is None:
            return []
        if driver is None:
            return [Row("live/off", "", "readonly", "Off", value=self._refusal)]
        linear, angular = driver.most
        chosen = driver.type_name.rpartition("/")[2]
        asked = driver.is_asked
        return [
            Row("live/topic", "", "readonly", "Topic", value=driver.topic),
            Row(
                "live/type",
                "",
                "enum" if asked else "readonly",
                "Type",
                value=chosen or _NO_TYPE,
                options=tuple(_TYPES) if asked else (),
                help="What the robot takes; it does not say so itself.",
                set=self._choose if asked else None,
            ),
            Row("live/linear", "", "float", "Highest speed", value=linear, unit="m/s"),
            Row(
                "live/angular", "", "float", "Highest turn", value=angular, unit="rad/s"
            ),
        ]

    def data(self) -> Sequence[Data]:
        """Return who drives, why the last one was stopped, and what else stops it."""
        driver = self._publisher.driver
        if self._publisher.robot is None:
            return []
        driving = None if driver is None else driver.driving
        hand = driving and driving.hand
        name = "" if not hand else self._publisher.name_of(hand.client)
        state = {
            "refusal": self._refusal,
            "client": hand.client if hand else None,
            "name": name,
            "why": driving.why if driving else "",
            "stops": driving.stops if driving else 0,
            "failure": driving.failure if driving else "",
            "goal": self._publisher.goals.goes_on if self._publisher.goals else "",
            "protection": driver.protection if driver else "",
        }
        found = [Data("live/state", state)]
        goals = self._publisher.goals
        if goals is not None and goals.last is not None and goals.is_on_the_way:
            found.append(Data("live/goal", goals.last.words))
        return found

    def offers(self, command_id: str) -> bool:
        """Return whether there is a live robot that may be sent something."""
        publisher = self._publisher
        if command_id == "live/stop":
            return publisher.robot is not None and publisher.sends_anything
        if command_id == "live/cancel":
            return publisher.goals is not None and publisher.goals.is_on_the_way
        return publisher.driver is not None

    @property
    def _refusal(self) -> str:
        return self._publisher.refusal("drive")

    def _choose(self, name: str) -> None:
        if self._publisher.driver is not None:
            self._publisher.driver.choose(_TYPES[name])

    @command("live/hold", INTEGER, _PART, _PART, name="Drive", at_once=True)
    def _hold(self, client: int, press: int, forwards: float, left: float) -> None:
        """Drive on; a key or the stick that is held says so again and again."""
        driver = self._publisher.driver
        if driver is None:
            raise PublishError(self._refusal or "the robot has left")
        driver.hold(Hand(client, press), forwards, left)

    @command("live/release", INTEGER, client_local=True, at_once=True)
    def _release(self, client: int, press: int) -> None:
        if self._publisher.driver is not None:
            self._publisher.driver.release(client, press)

    @command("live/cancel", name="Cancel", at_once=True)
    def _cancel(self, client: int) -> None:
        name = self._publisher.name_of(client)
        # The log is written in the session's thread.
        self._post(lambda: self._publisher.cancel(name))

    @command("live/stop", client_local=True, at_once=True)
    def _stop(self, client: int) -> None:
        """Stop the robot, whoever drives it: everyone may."""
        self._publisher.stop(self._publisher.name_of(client))
        self._post(self._roles.return_control)
