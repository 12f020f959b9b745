"""Other recordings, for one browser: which there are, and opening one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from sambot_viz.errors import SambotVizError, SourceError
from sambot_viz.panels.command import TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Level
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.people.roles import Roles


class OtherRecordings(Protocol):
    """The recordings in the folders of those that were opened, for one session."""

    @property
    def parts(self) -> Sequence[str]:
        """The shown sources that can be replaced, and the names of recordings."""
        ...

    @property
    def replaces_config(self) -> bool:
        """Whether another recording comes with another config: no user has one."""
        ...

    def names(self) -> Sequence[str]:
        """Return the names of what can be opened.

        Raises:
            UsageError: a folder cannot be read.
        """
        ...

    def open(
        self, part: str, name: str, done: Callable[[SambotVizError | None], object]
    ) -> None:
        """Show another recording; keep the present one until it is open, or on failure.

        Args:
            part: the source to replace.
            name: the recording.
            done: called with the session locked, with the error if any.

        Raises:
            UsageError: there is no such part or name, or one is being opened.
        """
        ...


class RecordingsPanel(Panel):
    """Lists recordings for File > Open Recording, and opens one.

    Args:
        client_id: the client.
        recordings: the recordings to choose from; None if there are none.
        sources: the shown sources.
        document: the config.
        roles: knows whether the client may open others; viewers see no names.
        say: shows a sentence to this browser.
        remake: called when the answer changes.
    """

    name = "recordings"

    def __init__(
        self,
        client_id: int,
        recordings: OtherRecordings | None,
        sources: SessionSources,
        document: ShownDocument,
        roles: Roles,
        say: Callable[[str, Level], None],
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (sources.replaced, document.file, roles.changed)
        self._client_id = client_id
        self._recordings = recordings
        self._roles = roles
        self._say = say
        self._remake = remake
        self._names: Sequence[str] | None = None
        self._answer: Json = None
        self._answers = 0

    def data(self) -> Sequence[Data]:
        """Return the shown recordings, the choices, and the last answer."""
        recordings = self._recordings
        if recordings is None:
            return ()
        state: Json = {
            "parts": [*recordings.parts],
            "replaces": recordings.replaces_config,
        }
        may = self._roles.may_edit(self._client_id)
        return [
            Data("recording/state", state),
            Data("recording/names", self._names if may else None),
            Data("recording/answer", self._answer),
        ]

    def offers(self, command_id: str) -> bool:
        """Return whether there is a recording that another one can replace."""
        return self._recordings is not None

    @command("recording/list")
    def _list(self) -> None:
        if self._recordings is not None:
            self._names = self._recordings.names()
            self._remake(self)

    @command("recording/open", TEXT, TEXT, name="Open recording")
    def _open(self, part: str, name: str) -> None:
        def done(error: SambotVizError | None) -> None:
            if error is None:
                self._say(f"Opened {name}", "ok")
                self._reply(done=name)
            else:
                sentence = f"{_why(error)}. What was shown stays"
                self._say(sentence, "error")
                self._reply(refused=sentence)

        if self._recordings is not None:
            self._recordings.open(part, name, done)
            self._reply(opening=name)

    def _reply(self, **content: Json) -> None:
        self._answers += 1
        self._answer = {"number": self._answers, "to": "open", **content}
        self._remake(self)


def _why(error: SambotVizError) -> str:
    """Return the error and the remedy, without the folder of the file."""
    problems = error.problems if isinstance(error, SourceError) else ()
    for problem in problems:
        if problem.severity == "error":
            return f"{problem.message}; {problem.hint}"
    return str(error)
