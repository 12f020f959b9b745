"""Find why the tags of a text do not form one tree.

When a closing tag does not match the open tags, the tag that was forgotten, crossed or
misspelt is reported with the place to fix. expat reports only the place where it
stopped.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.root_end import after_root
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.robot.xml.diagnose.structure_messages import StructureMessages
from sambot_viz.robot.xml.diagnose.tokens import Token

_LEAVES = frozenset(
    "axis box calibration capsule child color cylinder dynamics inertia limit mass "
    "mesh mimic origin parent safety_controller sphere texture".split()
)
"""Elements that have attributes only: they are written <origin …/>."""

_TOP_LEVEL = frozenset({"link", "joint", "transmission", "gazebo", "ros2_control"})
"""Elements of <robot>, never inside one of `_HOLDS_NO_LINKS`."""

_HOLDS_NO_LINKS = frozenset({"link", "visual", "collision", "inertial", "geometry"})

_MOST = 12
"""Most problems reported: further ones usually follow from the first."""


@dataclass
class _Open:
    token: Token
    children: list[Token] = field(default_factory=list["Token"])


def structure_problems(source: SourceText, file: str) -> list[Problem]:
    """Find what prevents the tags from forming one tree, in document order.

    Args:
        source: the text.
        file: its name, for the places.

    Returns:
        At most one problem per error; empty when the tags are in order.
    """
    walk = _Walk(source, file, StructureMessages(source, file))
    walk.run()
    return walk.problems


@dataclass
class _Walk:
    source: SourceText
    file: str
    messages: StructureMessages
    problems: list[Problem] = field(default_factory=list["Problem"])
    stack: list[_Open] = field(default_factory=list["_Open"])
    root: Token | None = None
    root_end: Token | None = None

    def run(self) -> None:
        tags = self.source.tags
        if tags and tags[-1].closes and tags[-1].name == "robot":
            if not any(t.name == "robot" and not t.closes for t in tags):
                self.problems.append(self.messages.robot_missing(tags))
                return
        for index, token in enumerate(tags):
            if self.root_end is not None:
                break
            if len(self.problems) > _MOST:
                return
            if token.kind == "close":
                self._close(index)
            else:
                self._start(token)
        if self.root is not None and self.root_end is not None:
            found = after_root(self.source, self.file, self.root, self.root_end)
            self.problems += [found] if found else []
        elif self.stack:
            self._end_of_file()

    def _add(self, code: str, at: int, message: str, hint: str) -> None:
        self.problems.append(self.source.error(self.file, code, at, message, hint))

    def _line(self, token: Token) -> int:
        return self.source.line(token.start)

    def _start(self, token: Token) -> None:
        if self.stack:
            self.stack[-1].children.append(token)
        elif self.root is None:
            self.root = token
        if token.kind == "open":
            self.stack.append(_Open(token))
        elif not self.stack:
            self.root_end = token

    def _close(self, index: int) -> None:
        token = self.source.tags[index]
        if not self.stack:
            self._surplus(token)
            return
        top = self.stack[-1].token
        if token.name != top.name:
            self._mismatch(index)
            return
        self._pop(token)

    def _pop(self, token: Token) -> None:
        self.stack.pop()
        self._note_root_end(token)

    def _note_root_end(self, token: Token) -> None:
        if not self.stack:
            self.root_end = token

    def _mismatch(self, index: int) -> None:
        token = self.source.tags[index]
        top = self.stack[-1].token
        names = [entry.token.name for entry in self.stack]
        if token.name.lower() == top.name.lower():
            self.problems.append(self.messages.wrong_case(top, token))
            self._pop(token)
        elif token.name in names:
            self._not_closed(index, names)
        elif difflib.SequenceMatcher(None, token.name, top.name).ratio() >= 0.7:
            self.problems.append(self.messages.misspelt(top, token))
            self._pop(token)
        else:
            self._surplus(token)

    def _not_closed(self, index: int, names: list[str]) -> None:
        """The closing tag belongs further down: the tags above it were not closed."""
        tags = self.source.tags
        token = tags[index]
        depth = len(names) - 1 - names[::-1].index(token.name)
        unclosed = self.stack[depth + 1 :]
        following = tags[index + 1] if index + 1 < len(tags) else None
        top = unclosed[-1].token
        if len(unclosed) == 1 and following and following.closes:
            if following.name == top.name and names.count(top.name) == 1:
                self.problems.append(self.messages.crossed(top, token, following))
                # Continue as if the pair were in the right order.
                del self.stack[depth]
                self._note_root_end(token)
                return
        for entry in unclosed[:_MOST]:
            self._unclosed(entry, token)
        del self.stack[depth:]
        self._note_root_end(token)

    def _unclosed(self, entry: _Open, closed: Token | None) -> None:
        opened = entry.token
        shown = opened.shown
        line = self._line(opened)
        if opened.name in _LEAVES and not entry.children:
            self._add(
                "xml-tag-not-closed",
                opened.start,
                f"{shown} on line {line} is opened but never closed",
                f"end it with a slash: {shown[:-1]}/>",
            )
            return
        at = self._place_to_close(entry, closed)
        before = self._last_before(at)
        where = (
            f"after {self._named(before)} on line {self.source.line(before.end - 1)}"
        )
        self._add(
            "xml-tag-not-closed",
            before.start,
            f"{shown} opened on line {line} is never closed",
            f"add </{opened.name}> {where}",
        )

    def _named(self, token: Token) -> str:
        if token.kind == "comment":
            return "the comment"
        return f"</{token.name}>" if token.closes else f"<{token.name} …>"

    def _place_to_close(self, entry: _Open, closed: Token | None) -> int:
        """Offset before which the missing closing tag belongs; 0 when unknown."""
        opened = entry.token
        column = self.source.column(opened.start)
        for child in entry.children:
            stray = child.name in _TOP_LEVEL and opened.name in _HOLDS_NO_LINKS
            outdented = (
                self.source.starts_line(child.start)
                and self.source.column(child.start) <= column
            )
            if (stray or outdented) and self._line(child) > self._line(opened):
                return child.start
        return closed.start if closed else 0

    def _last_before(self, offset: int) -> Token:
        tags = [t for t in self.source.tags if t.end <= offset]
        return tags[-1]

    def _surplus(self, token: Token) -> None:
        """A closing tag that nothing opened."""
        line = self._line(token)
        before = [t for t in self.source.tags if t.end <= token.start]
        twin = next((t for t in reversed(before) if t.name == token.name), None)
        inner = self.stack[-1].token if self.stack else None
        orphan = self._first_orphan(token)
        closed_at_once = twin is not None and twin.kind == "empty"
        if orphan is not None and not (
            closed_at_once and twin is self._sibling_before(orphan)
        ):
            self.problems.append(self.messages.opening_missing(token, orphan))
            return
        if twin is not None and closed_at_once:
            message = (
                f"</{token.name}> on line {line} closes <{token.name} …/> of line "
                f"{self._line(twin)} again: the slash before > has closed it already"
            )
            hint = (
                f"delete the slash on line {self._line(twin)} if something belongs "
                f"inside, or delete </{token.name}>"
            )
        else:
            within = (
                f" inside <{inner.name}> (line {self._line(inner)})" if inner else ""
            )
            message = f"</{token.name}> on line {line}{within} closes nothing"
            hint = f"delete it, or write the <{token.name}> that is missing before it"
        self._add("xml-closing-tag-surplus", token.start, message, hint)

    def _first_orphan(self, closed: Token) -> Token | None:
        """The first of the elements that are indented as if inside `closed`."""
        if not self.stack:
            return None
        column = self.source.column(closed.start)
        if self.source.column(self.stack[-1].token.start) >= column:
            return None
        orphan: Token | None = None
        for child in reversed(self.stack[-1].children):
            if self.source.column(child.start) <= column:
                break
            orphan = child
        return orphan

    def _sibling_before(self, child: Token) -> Token | None:
        children = self.stack[-1].children
        index = children.index(child)
        return children[index - 1] if index else None

    def _end_of_file(self) -> None:
        """The text ends with tags open: one was forgotten, or the file is cut off."""
        forgotten = [e for e in self.stack[1:] if self._place_to_close(e, None)]
        for entry in forgotten[:_MOST]:
            self._unclosed(entry, None)
        if forgotten:
            return
        at = max(len(self.source.text.rstrip()) - 1, 0)
        names = [entry.token.name for entry in self.stack]
        root = self.stack[0].token
        inner = f", inside {self.stack[-1].token.shown}" if names[1:] else ""
        ends = "".join(f"</{name}>" for name in reversed(names[:4]))
        self._add(
            "xml-root-not-closed",
            at,
            f"<{root.name}> opened on line {self._line(root)} is never closed: the "
            f"file ends on line {self.source.line(at)}{inner}",
            f"add {ends} at the end"
            + ("; the file may be cut off" if names[1:] else ""),
        )
