"""The window of a session: its panels as rows, and what its browsers send back."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from sambot_viz.errors import SambotVizError
from sambot_viz.panels import validation
from sambot_viz.panels.browser import BrowserPanels
from sambot_viz.panels.command import Command
from sambot_viz.panels.compare_panel import ComparePanel
from sambot_viz.panels.displays.display_commands import DisplayCommands
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.drive_panel import DrivePanel
from sambot_viz.panels.files_panel import Files
from sambot_viz.panels.joints.joints_panel import JointsPanel
from sambot_viz.panels.joints.poses import PosesPanel
from sambot_viz.panels.lesson_panel import LessonPanel
from sambot_viz.panels.live_drive_panel import LiveDrivePanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.people import Invite, PeoplePanel
from sambot_viz.panels.problems.problems_panel import ProblemsPanel
from sambot_viz.panels.row_sync import RowSync
from sambot_viz.panels.rows.row import Answer, Level, Row
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.panels.saved_pictures import AskPage
from sambot_viz.panels.sent import Sent, read
from sambot_viz.panels.sent_panel import SentPanel
from sambot_viz.panels.session_info import SessionInfoPanel, StatusBarPanel
from sambot_viz.panels.sources.recordings_panel import OtherRecordings
from sambot_viz.panels.sources.source_panel import SourcePanel
from sambot_viz.panels.sources.time_panel import TimePanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.model_edits import ModelEdits
from sambot_viz.session.scene.joint_arrow import JointArrow
from sambot_viz.session.shown_lesson import ShownLesson

_NUMBERS = ("int", "float", "slider")


class Window:
    """The panels of one session.

    Args:
        session: the session that they show.
        joints: whether there are panels to move joints (``--no-gui`` leaves them out).
        files: the disk; None if the browsers may not use it.
        ask_page: makes a page of the view; None leaves that out.
        invite: makes the link for viewers; None leaves inviting out.
        recordings: the recordings to choose from; None if there are none.
        edits: writes fixes into files; None if no browser may.
        text: the text of the model; None without a file of it.
        lesson: the lesson; None without one.

    Attributes:
        text: the same.
        lesson: the same.
    """

    def __init__(
        self,
        session: Session,
        joints: bool = True,
        files: Files | None = None,
        ask_page: AskPage | None = None,
        invite: Invite | None = None,
        recordings: OtherRecordings | None = None,
        edits: ModelEdits | None = None,
        text: ModelText | None = None,
        lesson: ShownLesson | None = None,
    ) -> None:
        self._session = session
        self._files = files
        self._ask_page = ask_page
        self._invite = invite
        self._recordings = recordings
        self._edits = edits
        self.text, self._closed = text, False
        self.lesson = lesson
        self._browsers: dict[int, BrowserPanels] = {}
        # Others than those at the disk of the server see only the names of its files.
        self._folders = files is not None and not session.roles.presented
        self._displays = DisplaysPanel(
            session.document,
            session.display_edits,
            session.scene,
            session.robot,
            session.problems,
            self._remake,
            self._folders,
        )
        self._shared = RowSync(session.worker, self._panels(joints), "session")
        session.problems.tell_client = self._tell_error
        session.clients.listeners.append(self._take_client)
        for client in session.clients.all.values():
            self._take_client(client, True)

    def _panels(self, joints: bool) -> list[Panel]:
        session, remake = self._session, self._remake
        robot, scene, history = session.robot, session.scene, session.history
        is_copy = session.private and session.options.session == "shared"
        panels: list[Panel] = [
            SessionInfoPanel(
                session.document, scene, session.private, session.fullscreen
            ),
            StatusBarPanel(scene),
            PeoplePanel(session.roles, is_copy, session.turns),
            self._displays,
            ProblemsPanel(
                session.problems,
                session.history,
                remake,
                self._folders,
                self._edits,
                self.text,
            ),
            DisplayCommands(
                session.display_edits,
                self._displays,
                session.scene,
                session.document,
                remake,
            ),
        ]
        if self.lesson is not None:
            panels.append(LessonPanel(self.lesson))
        panels.append(
            ComparePanel(session.comparison, robot, scene, self.text is not None)
        )
        if session.data is not None:
            panels.append(SourcePanel(session.sources, not session.private))
            panels.append(TimePanel(session.document, scene, session.sources))
            panels.append(
                LiveDrivePanel(
                    session.publisher,
                    session.roles,
                    session.driven,
                    session.worker.post,
                )
            )
            panels.append(
                SentPanel(
                    session.publisher, session.sent, session.sending, session.driven
                )
            )
        if joints:
            arrow = JointArrow(scene, session.worker)
            panels += [
                JointsPanel(
                    robot,
                    session.motion,
                    history,
                    arrow,
                    session.sources,
                    session.joints_out,
                    remake,
                ),
                PosesPanel(
                    session.poses, robot, session.motion, history, session.roles, remake
                ),
                DrivePanel(session.drive, robot, session.follow_view),
            ]
        return panels

    def _shared_row(self, row_id: str) -> Row | None:
        item = self._shared.item(row_id)
        return item if isinstance(item, Row) else None

    def _remake(self, panel: Panel) -> None:
        self._shared.remake(panel)

    def close(self) -> None:
        """Follow the session no longer; a second call does nothing."""
        if self._closed:
            return
        self._closed = True
        self._session.clients.listeners.remove(self._take_client)
        for panels in self._browsers.values():
            panels.close()
        self._shared.close()
        if self.text is not None:
            self.text.close()
        if self.lesson is not None:
            self.lesson.close()

    def _take_client(self, client: Client, joined: bool) -> None:
        if joined:
            self._browsers[client.client_id] = BrowserPanels(
                self._session,
                client,
                self._files,
                self._ask_page,
                self._invite,
                self._recordings,
                self._displays,
                self._shared_row,
                self.text,
            )
        else:
            panels = self._browsers.pop(client.client_id, None)
            if panels is not None:
                panels.close()

    def say(self, sentence: str, level: Level) -> None:
        """Show a sentence in all browsers."""
        for browser in self._browsers.values():
            browser.say(sentence, level)

    def _tell_error(self, client_id: int, sentence: str) -> None:
        browser = self._browsers.get(client_id)
        if browser is not None:
            browser.say(sentence, "error")

    def rows_of(self, client_id: int) -> ClientRows | None:
        """Return the rows that a client sees; None when it has none yet."""
        browser = self._browsers.get(client_id)
        if browser is None:
            return None
        others = (browser.camera, browser.pictures)
        return ClientRows((self._shared.store, browser.store), others)

    # What browsers send

    def receive(self, client_id: int, message: object) -> None:
        """Take a message of a browser; called on the event loop, returns at once."""
        sent = read(message)
        if sent is None:
            return
        found = self._shared.item(sent.id)
        if isinstance(found, Command) and found.at_once:
            self._take_at_once(client_id, found, sent)
            return
        # Of the values of one drag that wait, only the last one counts; and of numbers
        # that come faster than they are handled. A command may add to the one before.
        latest_of = None
        if sent.gesture is not None or self._is_number(client_id, sent.id):
            latest_of = (sent.id, sent.gesture)
        take = partial(self._take, client_id, sent)
        self._session.worker.post(take, latest_of=latest_of, client=client_id)

    def _take_at_once(self, client_id: int, found: Command, sent: Sent) -> None:
        """Run a command that waits for nothing; a refusal is answered in its turn."""
        may_edit = self._session.roles.may_edit(client_id)
        found = replace(found, run=partial(found.run, client_id))
        try:
            validation.accept(found, sent.value, may_edit=may_edit)()
        except SambotVizError as error:
            refuse = partial(self._refuse, client_id, sent.id, str(error))
            # Repeated refusals are reported once.
            self._session.worker.post(refuse, latest_of=sent.id, client=client_id)

    def _refuse(self, client_id: int, item_id: str, sentence: str) -> None:
        browser = self._browsers.get(client_id)
        if browser is not None:
            browser.answer(item_id, sentence)

    def _is_number(self, client_id: int, row_id: str) -> bool:
        """Return whether a row is a number, in any thread."""
        rows = self.rows_of(client_id)
        found = [store.get(row_id) for store in rows.stores] if rows else []
        return any(row is not None and row.get("kind") in _NUMBERS for row in found)

    def _take(self, client_id: int, sent: Sent) -> None:
        """Check a browser's message and execute it, or answer with the refusal."""
        browser = self._browsers.get(client_id)
        if browser is None:
            return
        item = browser.item(sent.id) or self._shared.item(sent.id)
        if item is None:
            browser.answer(sent.id, "this no longer exists")
            return
        may_edit = self._session.roles.may_edit(client_id)
        try:
            call = validation.accept(item, sent.value, may_edit=may_edit)
            with self._session.history.acting(
                client_id, sent.gesture, by_viewer=not may_edit
            ):
                answer = call()
            if isinstance(answer, Answer):
                browser.give(answer)
        except SambotVizError as error:
            browser.answer(sent.id, str(error))
