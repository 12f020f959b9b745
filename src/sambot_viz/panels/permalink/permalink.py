"""Make permalinks of what one client shows, and open them.

A link has the names and values of what differs from the start, as a form that is sent
has them. Every value is checked as if a user had set it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any, cast

from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.errors import UsageError
from sambot_viz.panels.command import LIST, command
from sambot_viz.panels.joints.joint_rows import joint_id
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.permalink.permalink_parts import (
    OFF,
    ON,
    VERSION,
    Pair,
    PermalinkParts,
    number,
    read,
    short,
    written,
)
from sambot_viz.panels.rows.property_rows import property_rows
from sambot_viz.panels.rows.row import Answer, Data, Json, Row
from sambot_viz.panels.sources.source_panel import PLAYING, TIME
from sambot_viz.panels.validation import validate
from sambot_viz.panels.views import CURRENT, ViewsPanel
from sambot_viz.rviz import FIXED_FRAME, ConfigItem
from sambot_viz.session.clients.client import Client
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.toggles import Toggles
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.registry import VIEWS


class PermalinkPanel(Panel):
    """Makes permalinks, and shows what they say.

    Args:
        client: whose view and selection it is.
        views: shows the view of a link.
        row: finds the row of a joint, by its id.
        remake: called when a link has been made.
    """

    name = "permalink"

    def __init__(
        self,
        client: Client,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        toggles: Toggles,
        roles: Roles,
        views: ViewsPanel,
        row: Callable[[str], Row | None],
        remake: Callable[[Panel], None],
    ) -> None:
        self._client = client
        self._document = document
        self._scene = scene
        self._robot = robot
        self._toggles = toggles
        self._roles = roles
        self._views = views
        self._row = row
        self._remake = remake
        self._made: Json = None
        self._count = 0

    def data(self) -> Sequence[Data]:
        """Return the last permalink that was made, as its parts."""
        return [Data("permalink/made", self._made)]

    # Making one

    @command("permalink/copy", client_local=True)
    def _copy(self) -> None:
        self._count += 1
        parts = [list(pair) for pair in self._parts()]
        self._made = {"number": self._count, "parts": parts}
        self._remake(self)

    def _parts(self) -> Iterator[Pair]:
        """Yield names and values; the last one shows that none is missing."""
        view = self._client.view.view
        yield "view", view.kind.rpartition("/")[2]
        for row in property_rows(view.config, CURRENT, lambda path, value: None):
            default = _default(view.config, row)
            if row.set is not None and row.value not in (None, default):
                yield f"view.{_path(row)}", written(row.value)
        robot = self._robot.model
        if robot is not None:
            yield "robot", robot.name
        fixed = self._scene.context.fixed_frame
        if fixed != self._document.first_fixed_frame:
            yield "fixed", fixed
        time = self._row(TIME)
        if time is not None:
            yield "time", f"{time.value!r}"
        yield from self._moved()
        for name, toggle in self._toggles.all().items():
            if toggle.on != toggle.first:
                yield f"show.{name}", ON if toggle.on else OFF
        for item in self._client.tools.selection:
            # Data is of one moment.
            if item.is_data:
                continue
            yield "select", f"{item.kind}:{item.name}"
        yield "v", VERSION

    def _moved(self) -> Iterator[Pair]:
        joints, first = self._robot.joints, self._robot.first
        if joints is None or self._robot.followed.value:
            # The messages of a recording say at each time where the joints are.
            return
        for name, q in joints.positions.items():
            if q != first.get(name):
                row = self._row(joint_id(name))
                yield f"j.{name}", repr(q) if row is None else short(row, q)

    # Opening one

    # Viewers may open one: what others see then stays as it is.
    @command("permalink/open", LIST, LIST, name="link", client_local=True)
    def _open(self, names: list[Any], values: list[Any]) -> Answer:
        link = PermalinkParts.read(names, values)
        robot = self._robot.model
        link.elsewhere = robot is not None and link.robot not in (None, robot.name)
        link.watching = not self._roles.may_edit(self._client.client_id)
        # The camera is in the fixed frame.
        self._fix(link)
        self._look(link)
        self._go(link)
        self._move(link)
        self._switch(link)
        self._select(link)
        return link.answer()

    def _fix(self, link: PermalinkParts) -> None:
        frame = link.fixed
        if frame is None or frame == self._scene.context.fixed_frame:
            return
        if frame not in self._scene.context.tree.frames:
            link.missing["frame"] += [frame]
        elif link.watching:
            link.kept = True
        else:
            self._document.set_option("Fixed Frame", frame)

    def _look(self, link: PermalinkParts) -> None:
        if not link.kind and not link.view:
            # Who has written it by hand wants the view as it is.
            return
        kinds = {kind.rpartition("/")[2]: kind for kind in VIEWS}
        if link.kind not in kinds:
            link.missing["view"] += [link.kind]
            return
        frames = {FIXED_FRAME, *self._scene.context.tree.frames}
        used: set[str] = set()

        def wanted(row: Row) -> Json:
            path = _path(row)
            used.add(path)
            given = link.view.get(path)
            if given is None:
                return _default(self._client.view.view.config, row)
            value = read(row, given)
            if row.kind == "frame" and value not in frames:
                link.missing["frame"] += [given]
                return None
            try:
                validate(row, value)
            except UsageError as error:
                link.refuse(str(error))
                return None
            return value

        self._views.look_as(kinds[link.kind], wanted)
        link.missing["property of the view"] += [p for p in link.view if p not in used]

    def _go(self, link: PermalinkParts) -> None:
        """Stop the player at the time of the link."""
        time, playing = self._row(TIME), self._row(PLAYING)
        if not link.time:
            return
        if time is None or playing is None or time.set is None or playing.set is None:
            link.refuse("no recording is played here")
        elif link.watching:
            link.kept = True
        else:
            try:
                seconds = validate(time, number(link.time))
            except UsageError as error:
                link.refuse(str(error))
                return
            playing.set(False)
            time.set(seconds)

    def _move(self, link: PermalinkParts) -> None:
        if self._robot.followed.value:
            if link.joints:
                link.refuse(
                    f"joints are moved by {self._robot.followed.value}, not by the link"
                )
            return
        joints = self._robot.joints
        if joints is None:
            link.missing["joint"] += link.joints
            return
        rows = {name: self._row(joint_id(name)) for name in joints.free}
        positions: dict[str, float] = {}
        if not link.elsewhere:
            # Joints that a link does not name are at their start.
            first = self._robot.first.items()
            positions = {n: q for n, q in first if rows.get(n) is not None}
        link.missing["joint"] += [name for name in link.joints if name not in rows]
        for name, row in rows.items():
            given = link.joints.get(name)
            if given is None:
                continue
            try:
                if row is None:
                    raise UsageError("this page has no panel that moves joints")
                positions[name] = validate(row, number(given))
            except UsageError as error:
                positions.pop(name, None)
                link.refuse(str(error))
        changed = {n: q for n, q in positions.items() if joints.positions[n] != q}
        if changed and link.watching:
            link.kept = True
        elif changed:
            self._robot.set_positions(changed, "Open a link")

    def _switch(self, link: PermalinkParts) -> None:
        for name in sorted(link.switches.keys() - self._toggles.all().keys()):
            link.missing["display or part of one"] += [name.replace("/=", "/")]
        # A switch for all links turns each of them: those of the links come after it.
        for of_entries in (False, True):
            for name, toggle in self._toggles.all().items():
                if ("/=" in name) is not of_entries:
                    continue
                as_now = toggle.on if link.elsewhere else toggle.first
                on = link.switches.get(name, as_now)
                if on != toggle.on and link.watching:
                    link.kept = True
                elif on != toggle.on:
                    try:
                        toggle.set(on)
                    except UsageError as error:
                        link.refuse(str(error))

    def _select(self, link: PermalinkParts) -> None:
        robot, frames = self._robot.model, self._scene.context.tree.frames
        links: Collection[str] = () if robot is None else robot.links
        items: set[Selectable] = set()
        for given in link.selected:
            kind, _, name = given.partition(":")
            if kind == "link" and name in links:
                items.add(Selectable("link", name))
            elif kind == "frame" and name in frames:
                items.add(Selectable("frame", name))
            else:
                link.missing[kind if kind in ("link", "frame") else "item"] += [name]
        if items != set(self._client.tools.selection):
            self._client.tools.select(items, None)


def _path(row: Row) -> str:
    return row.id.removeprefix(f"{CURRENT}/")


def _default(config: ConfigItem, row: Row) -> Json:
    default = config.declared[_path(row)].property.default
    if isinstance(default, tuple):
        return list(cast("tuple[Json, ...]", default))
    return default
