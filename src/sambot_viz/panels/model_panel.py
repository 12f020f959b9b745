"""The Model panel of one browser: the text of a file, and the problems in it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial

from sambot_viz import limits
from sambot_viz.edits import SourceFile
from sambot_viz.errors import Problem, UsageError
from sambot_viz.panels.command import FLAG, TEXT, Argument, command
from sambot_viz.panels.marked_problems import marked, problem_id
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import without_folders
from sambot_viz.panels.rows.row import Answer, Data, FileContent, Json, Row
from sambot_viz.session.editor.buffer import Buffer, Replacement, replaced
from sambot_viz.session.editor.file_text import from_units, to_units
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.shown_problems import Problems
from sambot_viz.session.undo import History

_COUNT = Argument(int, least=0, most=2 * limits.EDITED_TEXT.value)
_VERSION = Argument(int, least=0)
_PIECE = Argument(str, longest=limits.EDITED_PIECE.value)


class ModelPanel(Panel):
    """The files of the model as tabs, and the text of the one that is open.

    Args:
        text: what there is to write.
        problems: those of its files are shown at their lines.
        history: undoes what the panel writes.
        folders: whether messages may name folders of the server.
        remake: called after another file was opened.
    """

    name = "model"

    def __init__(
        self,
        text: ModelText,
        problems: Problems,
        history: History,
        folders: bool,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (text.changed, problems.shown)
        self._text = text
        self._problems, self._history = problems, history
        self._folders = folders
        self._remake = remake
        self._shown = self._expands = False
        self._open: str = ""
        self._model: str = ""
        self._wanted: Json = None
        self._count = 0

    def rows(self) -> Sequence[Row]:
        """Return a row that says that there are files."""
        names = self._text.names
        said = f"{len(names)} file{'s' if len(names) > 1 else ''} of the model"
        return [Row("model/note", "", "note", value=said)] if names else ()

    def data(self) -> Sequence[Data]:
        """Return the tabs, the text and its problems, while the panel is seen."""
        buffer = self._buffer() if self._shown else None
        files = None if buffer is None else list(self._files())
        text = None if buffer is None else self._content(buffer)
        found = None if buffer is None else self._found(buffer)
        return [
            Data("model/shown", self._shown),
            Data("model/wanted", self._wanted),
            Data("model/files", files),
            Data("model/text", text),
            Data("model/found", found),
            Data("model/words", None if buffer is None else self._words(buffer)),
            Data("model/expanded", self._expanded() if self._expands else None),
        ]

    def offers(self, command_id: str) -> bool:
        """Tell whether files may be written."""
        if command_id == "model/expand":
            return bool(self._text.expanded)
        if command_id == "model/create":
            return self._text.can_create
        return command_id != "model/save" or self._text.can_save

    def _buffer(self) -> Buffer | None:
        names = self._text.names
        if not names:
            return None
        if self._open not in names or names[0] != self._model:
            self._model = names[0]
            self._open = names[0]
        return self._text.buffer(self._open)

    def _files(self) -> Iterator[Json]:
        listed = self._problems.shown.value.listed
        count = Counter((self._text.name_of(p.file), p.severity) for p in listed)
        unsaved = {buffer.name for buffer in self._text.unsaved}
        for name in self._text.names:
            errors, warnings = count[name, "error"], count[name, "warning"]
            yield {
                "name": name,
                "changed": name in unsaved,
                "errors": errors,
                "warnings": warnings,
            }

    def _content(self, buffer: Buffer) -> Json:
        theirs, text = buffer.theirs, buffer.text
        return {
            "file": buffer.name,
            "version": buffer.version,
            "text": FileContent(buffer.text),
            "most": limits.EDITED_TEXT.value,
            "why": buffer.why,
            "changed": buffer.is_changed,
            "merges": buffer.merges,
            "asks": theirs is not None,
            "gone": theirs is not None and theirs.data is None,
            "conflicts": [
                {
                    "line": 1 + text.count("\n", 0, extent.start),
                    "from": to_units(text, extent.start),
                    "to": to_units(text, extent.end),
                    "theirs": FileContent(theirs),
                }
                for extent, theirs in buffer.conflicts
            ],
        }

    def _found(self, buffer: Buffer) -> Json:
        """Return the problems of a text; None until it has been checked."""
        is_new = buffer.version != self._text.checked.get(buffer.name, 0)
        if buffer.why or is_new:
            return None
        source = SourceFile(buffer.text, "utf-8")
        made = [
            marked(p, source, folders=self._folders, can_fix=self._can_fix(p))
            for p in self._problems_of(buffer.name)
        ]
        return {"file": buffer.name, "version": buffer.version, "problems": made}

    def _expanded(self) -> Json:
        """Return the model as ROS gets it, without xacro."""
        text = self._text.expanded
        is_long = len(text) > limits.EDITED_TEXT.value
        shown = text if self._folders else without_folders(text)
        return FileContent("" if is_long else shown)

    def _words(self, buffer: Buffer) -> Json:
        """Return what the editor offers: elements as CodeMirror reads them, or keys."""
        if buffer.name.endswith((".yaml", ".yml")):
            return {node: {**keys} for node, keys in self._text.keys(buffer).items()}
        if not buffer.name.endswith((".urdf", ".xacro", ".sdf", ".xml")):
            return None
        return [
            {
                "name": each.name,
                "top": each.is_root,
                "children": [*each.children],
                "attributes": [
                    {"name": name, "values": [*values]}
                    for name, values in each.attributes.items()
                ],
                "textContent": [*each.texts],
            }
            for each in self._text.words()
        ]

    def _problems_of(self, name: str) -> Iterator[Problem]:
        listed = self._problems.shown.value.listed[: limits.PROBLEM_ROWS.value]
        return (p for p in listed if self._text.name_of(p.file) == name)

    def _can_fix(self, problem: Problem) -> bool:
        files = {edit.file for edit in problem.edits}
        return bool(files) and all(map(self._text.name_of, files))

    # What the page calls

    @command("model/show", FLAG, client_local=True)
    def _show(self, shown: bool) -> None:
        """Send the text, or do not: the panel is on the screen, or is not."""
        self._shown = shown
        self._remake(self)

    @command("model/expand", FLAG, client_local=True)
    def _expand(self, shown: bool) -> None:
        """Send the model without xacro too, or no longer."""
        self._expands = shown
        self._remake(self)

    @command("model/open", TEXT, name="Open", client_local=True)
    def _open_file(self, name: str) -> None:
        self._text.buffer(name)
        self._open = name
        self._remake(self)

    @command("model/create", TEXT, name="New file")
    def _create(self, name: str) -> None:
        self._text.create(name)
        self._open = name
        self._remake(self)

    @command("model/find", TEXT, name="Find the link", client_local=True)
    def _find(self, link: str) -> None:
        """Open the file that has a link, and tell the page where it is.

        A link that a macro makes is written in the macro; it may be called elsewhere.
        """
        made = self._text.link(link)
        found = None if made is None else self._text.element_at(made.place)
        if made is None or found is None:
            raise UsageError(f"the files of the model do not say where '{link}' is")
        call = self._text.element_at(made.call)
        words = "" if call is None else f"{call.file} line {call.line}"
        self._open = found.file
        self._want({"extent": [*found.extent], "link": link, "call": words})

    @command("model/call", TEXT, name="Go to the call", client_local=True)
    def _find_call(self, link: str) -> None:
        """Open the file that calls the macro that makes a link."""
        made = self._text.link(link)
        found = None if made is None else self._text.element_at(made.call)
        if found is None:
            raise UsageError(f"no file of the model calls a macro for '{link}'")
        self._open = found.file
        self._want({"extent": [*found.extent]})

    @command("model/number", TEXT, name="Go to its line", client_local=True)
    def _find_number(self, row_id: str) -> None:
        """Open the file that has a number, and tell the page where it is."""
        listed = self._text.numbers.listed()
        found = next((n for n in listed if row_id == f"numbers/{n.id}"), None)
        if found is None:
            raise UsageError("this number is no longer there")
        self._open, text = found.file, self._text.buffer(found.file).text
        self._want({"extent": [to_units(text, at) for at in found.named.extent]})

    @command("model/write", name="Write into the text")
    def _write(self) -> None:
        """Let the editor of the page write the changed numbers.

        Of several files the page asks again for the next one.
        """
        found = [n for n in self._text.numbers.listed() if n.can_write]
        if not found:
            raise UsageError("no number was moved that a file has")
        name = found[0].file
        own = [n for n in found if n.file == name]
        changes = [Replacement(n.named.extent, n.written) for n in own]
        moved, before = self._text.numbers.moved.value, self._text.buffer(name).text
        after = replaced(before, changes)
        left = {key: moved[key] for key in moved.keys() - {n.id for n in own}}
        self._history.record(
            f"Write numbers into {name}",
            partial(self._text.put_back, name, after, before, moved),
            partial(self._text.put_back, name, before, after, left),
            of_document=False,
        )
        self._want_written(name, changes, more=len(own) < len(found))

    def _want_written(
        self, name: str, changes: Sequence[Replacement], *, more: bool = False
    ) -> None:
        """Let the editor of the page change a text.

        It is the page that does, so that it can be undone there like what is typed.
        """
        buffer = self._text.buffer(name)
        if not changes:
            return
        self._open = name
        made = [
            {
                "from": to_units(buffer.text, extent.start),
                "to": to_units(buffer.text, extent.end),
                "insert": text,
            }
            for extent, text in changes
        ]
        self._want({"version": buffer.version, "changes": made, "more": more})

    def _want(self, wanted: dict[str, Json]) -> None:
        """Tell the page to show a place of the file that is open, or to write there."""
        self._count += 1
        self._wanted = {"number": self._count, "file": self._open, **wanted}
        self._remake(self)

    @command(
        "model/type", TEXT, _VERSION, _COUNT, _COUNT, _PIECE, FLAG, name="The text"
    )
    def _type(
        self, name: str, version: int, start: int, end: int, new: str, more: bool
    ) -> None:
        self._text.replace(name, version, start, end, new, more=more)

    @command("model/fix", TEXT, name="Apply")
    def _fix(self, mark: str) -> Answer:
        listed = self._problems.shown.value.listed
        found = next((p for p in listed if problem_id(p) == mark), None)
        if found is None or not found.edits:
            raise UsageError("this problem is no longer there")
        self._text.apply(found.edits)
        hint = found.hint if self._folders else without_folders(found.hint)
        return Answer(f"Applied: {hint}")

    @command("model/save", TEXT, name="Save")
    def _save(self, name: str) -> Answer:
        self._text.save(name)
        return Answer(f"Saved {name}")

    @command("model/revert", TEXT, name="Take the saved text")
    def _revert(self, name: str) -> None:
        self._want_written(name, self._text.revert(name))

    @command("model/resolve", TEXT, FLAG, name="Choose the text")
    def _resolve(self, name: str, take_theirs: bool) -> None:
        self._choose(name, None, take_theirs)

    @command(
        "model/choose", TEXT, _VERSION, _COUNT, FLAG, name="Choose the text of a place"
    )
    def _choose_one(
        self, name: str, version: int, start: int, take_theirs: bool
    ) -> None:
        buffer = self._text.buffer(name)
        if version != buffer.version:
            raise UsageError(f"{name} has changed meanwhile; choose again")
        self._choose(name, from_units(buffer.text, start), take_theirs)

    def _choose(self, name: str, place: int | None, take_theirs: bool) -> None:
        """Choose between the text and what another program has saved.

        Args:
            name: of the file.
            place: where the lines begin that both have changed; None for all.
            take_theirs: whether what is saved is taken; else the text stays.
        """
        buffer = self._text.buffer(name)
        if not take_theirs:
            self._text.keep(name, place)
        elif buffer.conflicts:
            self._want_written(name, buffer.taken(place))
        else:
            self._text.revert(name)
