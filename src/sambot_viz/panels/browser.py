"""The panels of one browser alone, and answers to what it sent."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from sambot_viz.panels.displays.add_by_topic import AddByTopicPanel
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.files_panel import Files, FilesPanel
from sambot_viz.panels.frames.frames_panel import FramesPanel
from sambot_viz.panels.graph.graph_panel import GraphPanel
from sambot_viz.panels.joints.poses import GhostPanel
from sambot_viz.panels.model_panel import ModelPanel
from sambot_viz.panels.numbers_panel import NumbersPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.people import Invite, InvitePanel, OwnRolePanel
from sambot_viz.panels.permalink.permalink import PermalinkPanel
from sambot_viz.panels.row_sync import RowSync
from sambot_viz.panels.rows.row import Answer, Data, Json, Level, LongText, Row
from sambot_viz.panels.saved_pictures import AskPage, PicturesPanel
from sambot_viz.panels.selection.selection import SelectionPanel
from sambot_viz.panels.sources.images_panel import ImagesPanel
from sambot_viz.panels.sources.recordings_panel import OtherRecordings, RecordingsPanel
from sambot_viz.panels.sources.topics_panel import TopicsPanel
from sambot_viz.panels.tools import ToolPropertiesPanel, ToolsPanel
from sambot_viz.panels.undo_panel import UndoPanel
from sambot_viz.panels.views import ViewsPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.scene.scene import Scene
from sambot_viz.text import capitalized


class BrowserPanels:
    """The rows of one browser alone.

    Args:
        session: the session that it shows.
        client: the browser.
        files: the disk, for clients that may use it.
        ask_page: makes a page of the present view; None leaves that out.
        invite: makes the link for viewers; None leaves inviting out.
        recordings: the recordings to choose from; None if there are none.
        displays: the rows of the displays, for everyone.
        shared_row: finds a row that everyone sees, by its id.
        text: the text of the model; None without a file of it.

    Attributes:
        store: the rows, for the page.
        camera: the camera of the page.
        pictures: the pictures of cameras in the scene, for the page.
        item: finds a row, data or command of this browser by its id.
        close: stops following the browser.
    """

    def __init__(
        self,
        session: Session,
        client: Client,
        files: Files | None,
        ask_page: AskPage | None,
        invite: Invite | None,
        recordings: OtherRecordings | None,
        displays: DisplaysPanel,
        shared_row: Callable[[str], Row | None],
        text: ModelText | None = None,
    ) -> None:
        self._notices = NoticePanel()
        self._displays = displays
        self._shared_row = shared_row
        self._client = client
        self._sync: RowSync | None = None
        images = ImagesPanel(session.scene, session.document)
        self.pictures, self.camera = images.pictures, client.view.shown
        panels = [images, *self._panels(session, files, ask_page)]
        if text is not None:
            folders = files is not None and not session.roles.presented
            panels.append(
                ModelPanel(
                    text, session.problems, session.history, folders, self._remake
                )
            )
            panels.append(NumbersPanel(text, session.history, self._remake))
        if invite is not None:
            roles, number = session.roles, client.client_id
            panels.append(InvitePanel(roles, number, invite, self._remake))
        panels.append(
            RecordingsPanel(
                client.client_id,
                recordings,
                session.sources,
                session.document,
                session.roles,
                self.say,
                self._remake,
            )
        )
        # After the panels that have rows at once.
        panels.append(self._notices)
        sync = self._sync = RowSync(session.worker, panels, "browser")
        self.store, self.item, self.close = sync.store, sync.item, sync.close

    def _panels(
        self, session: Session, files: Files | None, ask_page: AskPage | None
    ) -> list[Panel]:
        client, displays, remake = self._client, self._displays, self._remake
        document, history, robot = session.document, session.history, session.robot
        scene, roles, frames = session.scene, session.roles, session.frames
        keep, clients = displays.keep_unfolded, session.clients
        views = ViewsPanel(client, document, scene, clients, roles, history, self.say)
        topics: list[Panel] = [AddByTopicPanel(session.sources, scene, remake)]
        if session.data is not None:
            topics.append(TopicsPanel(session.sources, scene.statuses, remake))
        person = roles.people.get(client.client_id)
        presents = roles.presented and person is not None and person.presenter
        paths = [PathsPanel(displays, document, scene)] if presents else []
        return [
            *topics,
            *paths,
            OwnRolePanel(roles, client.client_id, self.say, session.turns),
            ToolsPanel(client, scene, clients, robot),
            UndoPanel(client.client_id, history, document, displays, roles),
            views,
            SelectionPanel(client, scene, robot, remake),
            ToolPropertiesPanel(client, document),
            GhostPanel(session.poses, robot, scene, remake),
            FramesPanel(frames, robot, scene, self.say, remake),
            GraphPanel(
                session.graph,
                session.problems,
                files is not None and not roles.presented,
            ),
            PermalinkPanel(
                client,
                document,
                scene,
                robot,
                session.toggles,
                roles,
                views,
                self._shared_row,
                remake,
            ),
            FilesPanel(
                client,
                document,
                robot,
                scene,
                history,
                clients,
                files,
                roles,
                keep,
                self.say,
                remake,
            ),
            PicturesPanel(
                client, scene, robot, session.copy, session.worker, ask_page, self.say
            ),
        ]

    def say(self, sentence: str, level: Level) -> None:
        """Show a sentence in this browser."""
        self._notices.say(sentence, level)
        self._remake(self._notices)

    def _remake(self, panel: Panel) -> None:
        # While the rows are made for the first time, they are not made again.
        if self._sync is not None:
            self._sync.remake(panel)

    def answer(self, item_id: str, sentence: str) -> None:
        """Say why a value was refused; the page shows the value that holds again.

        Errors begin in lower case, as after "error:" on a terminal; here they are
        sentences, but for those that begin with a name.
        """
        begin = re.match(r"[a-z]+[ ,]", sentence)
        said = capitalized(sentence) if begin else sentence
        self._notices.say(said, "error", item_id)
        self._remake(self._notices)

    def give(self, answer: Answer) -> None:
        """Say something to the browser's user, and fill the clipboard."""
        self._notices.say(answer.say, answer.level, copy=answer.copy)
        self._remake(self._notices)


class PathsPanel(Panel):
    """The paths of which viewers see only the last part, for a presenter.

    Args:
        displays: the rows of the displays, for everyone.
    """

    name = "paths"

    def __init__(
        self, displays: DisplaysPanel, document: ShownDocument, scene: Scene
    ) -> None:
        facts = (document.replaced, document.displays, document.values)
        self.remade_by = (*facts, scene.statuses)
        self._displays = displays

    def data(self) -> Sequence[Data]:
        """Return the texts of the rows of displays, by their ids."""
        return [Data("displays/paths", {**self._displays.whole_texts()})]


class NoticePanel(Panel):
    """The last sentence to one browser."""

    name = "notice"

    def __init__(self) -> None:
        self._count = 0
        self._notice: Json = None

    def say(
        self, sentence: str, level: Level, row_id: str | None = None, copy: str = ""
    ) -> None:
        """Show a sentence, at a row or in the status bar, and fill the clipboard."""
        self._count += 1
        self._notice = {
            "number": self._count,
            "text": sentence,
            "level": level,
            "row": row_id,
            "copy": LongText(copy),
        }

    def data(self) -> Sequence[Data]:
        """Return the last notice."""
        return [Data("notice", self._notice)]
