"""Unsaved texts that outlive the program.

Other programs run the files of a model, so an end does not save them: a draft lies
beside each until its text is saved, and the next program begins with it.
"""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.files import read_limited, write_atomically
from sambot_viz.session.editor.buffer import Buffer
from sambot_viz.session.editor.file_text import FileText

_PIECES = 20
"""Bytes that a character takes in the two texts of a draft, at most."""


def draft_path(path: Path) -> Path:
    """Return the path of the draft of a file."""
    return path.with_name(f".{path.name}.draft")


def keep_draft(buffer: Buffer) -> None:
    """Write the text of an editor beside its file.

    Raises:
        OSError: the folder takes no file.
    """
    made = {"base": buffer.disk.text, "text": buffer.text}
    write_atomically(draft_path(buffer.path), json.dumps(made).encode())


def take_draft(buffer: Buffer) -> bool:
    """Continue with the draft of a file that was just opened, if there is one.

    Changes that another program has saved since are merged as if the text had been in
    an editor meanwhile.
    """
    base, text = _read(draft_path(buffer.path))
    now = buffer.disk
    if now.why or text is None or text == now.text:
        return False
    with suppress(UsageError):
        if base != now.text:
            # No bytes: they differ from those on disk, which are to be merged.
            buffer.disk = FileText(b"", base, now.encoding)
        buffer.take(text)
        buffer.look()
        return True
    buffer.disk, buffer.text = now, now.text
    return False


def _read(path: Path) -> tuple[str, str | None]:
    """Return the text that a draft was made from, and its text; None without one."""
    try:
        read: Any = json.loads(read_limited(path, _PIECES * limits.EDITED_TEXT.value))
        base, text = read["base"], read["text"]
    except (OSError, ValueError, LookupError, TypeError):
        return "", None
    return (
        (base, text) if isinstance(base, str) and isinstance(text, str) else ("", None)
    )


def forget_draft(path: Path) -> None:
    """Remove the draft of a file, if there is one."""
    with suppress(OSError):
        draft_path(path).unlink()
