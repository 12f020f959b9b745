"""Find why the tags of a text do not form one tree.

When a closing tag does not match the open tags, the tag that was forgotten or misspelt
is reported with the place to fix. expat reports only the place where it stopped.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.lexer import Token
from sambot_viz.robot.xml.diagnose.source_text import ROOTS, Change, SourceText

_LEAVES = frozenset(
    "axis box calibration capsule child color cylinder dynamics inertia limit mass "
    "mesh mimic origin parent safety_controller sphere texture".split()
)
"""Elements of URDF that have attributes only: they are written <origin …/>."""

_TOP_LEVEL = frozenset({"link", "joint", "transmission", "gazebo", "ros2_control"})
"""Elements of <robot>, never inside one of `_HOLDS_NO_LINKS`."""

_HOLDS_NO_LINKS = frozenset({"link", "visual", "collision", "inertial", "geometry"})

_BELONGS = {
    "model": frozenset({"link", "joint", "frame"}),
    "link": frozenset({"visual", "collision", "inertial"}),
    "joint": frozenset({"parent", "child", "axis"}),
}
"""Element → what is in it and never beside it: then it was closed too early."""

_ONCE = frozenset({"parent", "child", "axis", "inertial"})
"""What an element has once: a second one is of another element."""

_CONTENT = {
    "geometry": ("box", "cylinder", "sphere", "mesh"),
    "inertial": ("mass", "inertia"),
}
"""Element → what is in it and in no other."""

_ROOT_TAGS = {
    "sdf": '<sdf version="1.8">',
    "robot": '<robot name="…" xmlns:xacro="http://www.ros.org/wiki/xacro">',
}
"""Root element → its opening tag."""

_MOST = 12
"""Most problems reported: further ones usually follow from the first."""


@dataclass
class _Open:
    token: Token
    children: list[Token] = field(default_factory=list["Token"])
    ends: list[Token] = field(default_factory=list["Token"])
    """The tags that close the children, in document order."""


def structure_problems(source: SourceText, file: str) -> list[Problem]:
    """Find what prevents the tags from forming one tree, in document order.

    Args:
        source: the text.
        file: its name, for the places.

    Returns:
        At most one problem per error; empty when the tags are in order, and when a
        file has no <robot> and no <sdf>, for which expat's own line is as good.
    """
    root = next((t.name for t in source.tags if t.name in ROOTS and not t.closes), None)
    walk = _Walk(source, file, frozenset() if root == "sdf" else _LEAVES)
    if root is not None:
        walk.run()
    elif source.tags and source.tags[-1].name in ROOTS:
        walk.without_root(source.tags[0], source.tags[-1])
    return walk.problems


@dataclass
class _Walk:
    source: SourceText
    file: str
    leaves: frozenset[str]
    problems: list[Problem] = field(default_factory=list["Problem"])
    stack: list[_Open] = field(default_factory=list["_Open"])
    root: Token | None = None
    crossed: bool = False

    def run(self) -> None:
        tags = self.source.tags
        for index, token in enumerate(tags):
            if len(self.problems) > _MOST:
                return
            if self.crossed:
                # The two tags were reported together.
                self.crossed = False
                self.stack.pop()
            elif token.kind == "close":
                self._close(token, tags[index + 1] if tags[index + 1 :] else None)
            else:
                self._start(token)
            if not self.stack and self.root is not None:
                self._after_root(self.root, token, tags[index + 1 :])
                return
        if self.stack:
            self._end_of_file()

    def without_root(self, first: Token, closed: Token) -> None:
        """Report a closing tag of the root at the end whose opening tag is missing."""
        if difflib.SequenceMatcher(None, first.name, closed.name).ratio() >= 0.7:
            self._misspelt(first, closed, is_opened=True)
            return
        opening = _ROOT_TAGS[closed.name]
        line = self._line(first)
        added = [(first.start, first.start, f"{opening}\n")]
        self._add(
            "xml-closing-tag-surplus",
            first.start,
            f"</{closed.name}> on line {self._line(closed)} closes nothing: the "
            f"<{closed.name}> before {first.shown} on line {line} is missing",
            f"write {opening} before {first.shown} on line {line}",
            *(added if "…" not in opening else []),
        )

    def _add(
        self, code: str, at: int, message: str, hint: str, *changes: Change
    ) -> None:
        problem = self.source.error(self.file, code, at, message, hint, changes)
        self.problems.append(problem)

    def _line(self, token: Token) -> int:
        return self.source.line(token.start)

    def _start(self, token: Token) -> None:
        if self.stack:
            self.stack[-1].children.append(token)
        else:
            self.root = token
        if token.kind == "open":
            self.stack.append(_Open(token))

    def _close(self, token: Token, following: Token | None) -> None:
        names = [entry.token.name for entry in self.stack]
        if not names:
            self._surplus(token)
            return
        name, opened = token.name, self.stack[-1].token
        if name == opened.name:
            self.stack.pop()
            if self.stack:
                self.stack[-1].ends.append(token)
        elif name.lower() == opened.name.lower():
            self._misspelt(opened, token)
        elif following and names[-2:] == [name, following.name] and following.closes:
            self._crossed(token, following)
        elif name in names:
            depth = len(names) - 1 - names[::-1].index(name)
            for entry in self.stack[depth + 1 :][:_MOST]:
                self._unclosed(entry, token)
            del self.stack[depth:]
        elif difflib.SequenceMatcher(None, name, opened.name).ratio() >= 0.7:
            self._misspelt(opened, token)
        elif self._closed_early(self.stack[-1], token):
            return
        elif names[1:] and following and following.shown == f"</{names[-2]}>":
            self._misspelt(opened, token)
        else:
            self._surplus(token)

    def _misspelt(self, opened: Token, closed: Token, is_opened: bool = False) -> None:
        """A closing tag whose name is nearly that of the open tag.

        Args:
            opened: the open tag.
            closed: the closing tag.
            is_opened: the open tag is known to be the wrong one.
        """
        if self.stack:
            self.stack.pop()
        first, last = self._line(opened), self._line(closed)
        ends = f"is closed by </{closed.name}> on line {last}"
        if opened.name.lower() != closed.name.lower():
            message = f"<{opened.name}> opened on line {first} {ends}"
            code, hint = "xml-closing-tag-misspelt", f"write </{opened.name}>"
            change = (closed.start, closed.end, f"</{opened.name}>")
            at = closed.start
            others = self._is_used(closed.name) or self._is_macro(closed.name)
            if is_opened or (others and not self._is_used(opened.name, opened)):
                at, begin = opened.start, opened.start + 1
                hint = f"write <{closed.name}>"
                hint += ", as other elements are called" if others else ""
                change = (begin, begin + len(opened.name), closed.name)
            self._add(code, at, message, hint, change)
            return
        wrong = closed if opened.name.islower() else opened
        right = opened.name if opened.name.islower() else opened.name.lower()
        message = (
            f"<{opened.name}> on line {first} {ends}: XML distinguishes capital "
            "letters from small ones"
        )
        hint = f"write <{right}> and </{right}>"
        changes = [
            (start, start + len(right), right)
            for start in (opened.start + 1, closed.start + 2)
        ]
        self._add("xml-tag-case", wrong.start, message, hint, *changes)

    def _crossed(self, first: Token, second: Token) -> None:
        """Report two closing tags in the order of their opening tags."""
        inner, outer = (f"</{token.name}>" for token in (second, first))
        self._add(
            "xml-tag-not-closed",
            first.start,
            f"{outer} on line {self._line(first)} is before {inner} on line "
            f"{self._line(second)}, which was opened later",
            f"exchange {outer} and {inner}",
            (first.start, first.end, inner),
            (second.start, second.end, outer),
        )
        self.crossed = True
        self.stack.pop()

    def _is_used(self, name: str, but: Token | None = None) -> bool:
        """Return whether elements have a name, without the one of a tag."""
        tags = self.source.tags
        return any(t.name == name and not t.closes and t is not but for t in tags)

    def _is_macro(self, name: str) -> bool:
        """Return whether a macro of this name is defined."""
        own = name.removeprefix("xacro:")
        return own != name and any(
            tag.name == "xacro:macro" and tag.get("name") == own
            for tag in self.source.tags
        )

    def _unclosed(self, entry: _Open, closed: Token | None) -> None:
        opened = entry.token
        shown = opened.shown
        line = self._line(opened)
        if opened.name in self.leaves and not entry.children:
            self._add(
                "xml-tag-not-closed",
                opened.start,
                f"{shown} on line {line} is opened but never closed",
                f"end it with a slash: {shown[:-1]}/>",
                (opened.end - 1, opened.end - 1, "/"),
            )
            return
        at = self._place_to_close(entry, closed)
        before = [tag for tag in self.source.tags if tag.end <= at][-1]
        named = f"</{before.name}>" if before.closes else f"<{before.name} …>"
        self._add(
            "xml-tag-not-closed",
            before.start,
            f"{shown} opened on line {line} is never closed",
            f"add </{opened.name}> after {named} on line "
            f"{self.source.line(before.end - 1)}",
            (before.end, before.end, self._new_line(opened) + f"</{opened.name}>"),
        )

    def _new_line(self, opened: Token) -> str:
        """Return the line break and the blanks before a tag that begins its line."""
        if not self.source.starts_line(opened.start):
            return ""
        return "\n" + " " * (self.source.column(opened.start) - 1)

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

    def _closed_early(self, around: _Open, right: Token) -> bool:
        """Report an element of that name whose content goes on behind its end."""
        name = right.name
        early = next((t for t in reversed(around.ends) if t.name == name), None)
        if early is None:
            return False
        behind = [child for child in around.children if child.start > early.start]
        if not any(child.name in _BELONGS.get(name, ()) for child in behind):
            return False
        if self._is_of_another(early, behind):
            return False
        end = self._line(early)
        self._add(
            "xml-closed-early",
            early.start,
            f"line {end} closes </{name}> too early, before the content that starts "
            f"with {behind[0].shown} on line {self._line(behind[0])}",
            f"delete </{name}> on line {end}; the one on line {self._line(right)} is "
            "the right one",
            (early.start, early.end, ""),
        )
        return True

    def _is_of_another(self, early: Token, behind: list[Token]) -> bool:
        """Return whether what follows an element was in a second one of its kind."""
        name, tags = early.name, self.source.tags
        if behind[0].name in _TOP_LEVEL - _BELONGS[name]:
            return True
        begin = max(t.start for t in tags if t.name == name and t.end <= early.start)
        inside = {t.name for t in tags if begin < t.start < early.start}
        again = {child.name for child in behind} & inside & _ONCE
        return bool(again) or (name == "link" and self._missing_link() is not None)

    def _missing_link(self) -> str | None:
        """Return the only link that is the child of a joint, and is nowhere."""
        tags = [tag for tag in self.source.tags if not tag.closes]
        links = {tag.get("name") for tag in tags if tag.name == "link"}
        named = {tag.get("link") or "" for tag in tags if tag.name == "child"}
        missing = {name for name in named - links if name and "$" not in name}
        return missing.pop() if len(missing) == 1 else None

    def _surplus(self, token: Token) -> None:
        """A closing tag that nothing opened."""
        line = self._line(token)
        changes: list[Change] = []
        before = [t for t in self.source.tags if t.end <= token.start]
        twin = next((t for t in reversed(before) if t.name == token.name), None)
        if twin is not None and twin.kind == "empty":
            message = (
                f"</{token.name}> on line {line} closes <{token.name} …/> of line "
                f"{self._line(twin)} again: the slash before > has closed it already"
            )
            hint = (
                f"delete the slash on line {self._line(twin)} if something belongs "
                f"inside, or delete </{token.name}>"
            )
            inside = any(twin.end <= tag.start for tag in before)
            changes = [(token.start, token.end, "")]
            if inside:
                changes = [(twin.end - 2, twin.end, ">")]
        else:
            inner = self.stack[-1].token if self.stack else None
            within = (
                f" inside <{inner.name}> (line {self._line(inner)})" if inner else ""
            )
            message = f"</{token.name}> on line {line}{within} closes nothing"
            hint = f"delete it, or write the <{token.name}> that is missing before it"
            content = self._content(token.name)
            if content is not None:
                opening, is_certain = self._opening(token.name)
                hint = f"write {opening} before {content.shown} on line "
                hint += str(self._line(content))
                if is_certain:
                    changes = [(content.start, content.start, opening)]
        self._add("xml-closing-tag-surplus", token.start, message, hint, *changes)

    def _content(self, name: str) -> Token | None:
        """Return the first tag that is only in an element of a name, and now is not."""
        inner = self.stack[-1] if self.stack else None
        own = _CONTENT.get(name) or _BELONGS.get(name, ())
        if inner is None or inner.token.name == name:
            return None
        ends = [end.start for end in inner.ends if end.name == name]
        last = ends[-1] if ends and name in _BELONGS else 0
        behind = (child for child in inner.children if child.start > last)
        return next((child for child in behind if child.name in own), None)

    def _opening(self, name: str) -> tuple[str, bool]:
        """Return an opening tag, and whether all of it is certain."""
        if name == "link" and (missing := self._missing_link()):
            return f'<link name="{missing}">', True
        attributes = {"joint": ' name="…" type="…"'}.get(name, ' name="…"')
        return (
            (f"<{name}{attributes}>", False)
            if name in _BELONGS
            else (f"<{name}>", True)
        )

    def _after_root(self, root: Token, root_end: Token, rest: list[Token]) -> None:
        """Report tags after the end of the root element."""
        if not rest:
            return
        token, last = rest[0], rest[-1]
        name, end, line = root.name, self._line(root_end), self._line(token)
        if token.name == name and not token.closes:
            self._add(
                "xml-two-robots",
                token.start,
                f"a second <{name}> begins on line {line} after the first was closed "
                f"on line {end}: a file has only one",
                f"move its content into the first <{name}>, or into another file",
            )
            return
        if token is last and token.closes:
            self._add(
                "xml-closing-tag-surplus",
                token.start,
                f"</{token.name}> on line {line} closes nothing: </{name}> on line "
                f"{end} has already closed the root element",
                f"delete </{token.name}> on line {line}",
                (token.start, token.end, ""),
            )
            return
        deleted, at_end = (root_end.start, root_end.end, ""), self._at_end(f"</{name}>")
        changes = [deleted, at_end]
        begins = f"the content that starts with {token.shown} on line {line}"
        message = f"line {end} closes </{name}> too early, before {begins}"
        if root_end.kind == "empty":
            message = f"<{name} …/> on line {end} is closed by its slash, before "
            message += begins
            hint = f"write > instead of /> on line {end} and </{name}> as the last line"
            changes = [(root_end.end - 2, root_end.end, ">"), at_end]
        elif last.closes and last.name == name:
            right = f"the one on line {self._line(last)} is the right one"
            hint = f"delete </{name}> on line {end}; {right}"
            changes = [deleted]
        else:
            hint = f"move </{name}> from line {end} to the last line of the file"
        # The place is the early tag, because that is what has to be changed.
        self._add("xml-root-closed-early", root_end.start, message, hint, *changes)

    def _at_end(self, written: str) -> Change:
        """Return the change that adds a line to the file."""
        end = len(self.source.text.rstrip())
        return (end, end, f"\n{written}")

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
            *([] if names[1:] else [self._at_end(ends)]),
        )
