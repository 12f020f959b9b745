"""The newest pictures of cameras, on their way to the panels that show them.

Displays put them here in the worker; each page's channel takes the ones that its page
shows and lacks, when its connection is free. So a slow page gets fewer pictures and
never old ones, and pictures that no page shows are not even decoded.
"""

from __future__ import annotations

import json
import threading
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

PICTURE = b"\2"
"""The first byte of a binary frame with a picture: then the length of what follows in
JSON (4 bytes, little endian), that, and the file of the picture."""


@dataclass(frozen=True, slots=True)
class CameraPicture:
    """A picture as browsers read it.

    Attributes:
        type: of its file, such as "image/png"; empty for no picture.
        width: [pixels].
        height: [pixels].
        content: the file.
        view: how the scene is drawn in it, for page/view/scene_camera.js; None where
            it is not.
    """

    type: str
    width: int
    height: int
    content: bytes
    view: Mapping[str, object] | None = None


NO_PICTURE = CameraPicture("", 0, 0, b"")


def packed(key: str, picture: CameraPicture) -> bytes:
    """Return the binary frame with the picture of a display."""
    about = {"id": key, "type": picture.type, "view": picture.view}
    about |= {"width": picture.width, "height": picture.height}
    head = json.dumps(about, allow_nan=False).encode()
    return b"".join((PICTURE, len(head).to_bytes(4, "little"), head, picture.content))


class Pictures:
    """The newest picture of each display that has one, and who looks at which.

    Attributes:
        listeners: called after changes, in the worker.
    """

    def __init__(self) -> None:
        self.listeners: list[Callable[[], object]] = []
        self._lock = threading.Lock()
        self._count = 0
        self._frames: dict[str, tuple[int, bytes]] = {}
        self._wanted: Counter[str] = Counter()
        self._wakes: dict[str, Callable[[], object]] = {}

    # For displays

    def begin(self, key: str, wake: Callable[[], object]) -> None:
        """Register a display with pictures.

        Args:
            key: key of the display.
            wake: called when a page begins to show them.
        """
        if key not in self._wakes:
            self._wakes[key] = wake
            self.put(key, NO_PICTURE)

    def end(self, key: str) -> None:
        """Have no pictures of a display any longer."""
        self._wakes.pop(key, None)
        with self._lock:
            self._frames.pop(key, None)

    def put(self, key: str, picture: CameraPicture) -> None:
        """Show a picture in place of the one before."""
        frame = packed(key, picture)
        with self._lock:
            self._count += 1
            self._frames[key] = (self._count, frame)
        self.tell()

    def is_wanted(self, key: str) -> bool:
        """Return whether some page shows the pictures of a display."""
        return self._wanted[key] > 0

    # For pages

    def __contains__(self, key: str) -> bool:
        """Return whether a display has pictures."""
        return key in self._wakes

    def want(self, key: str) -> None:
        """Look at the pictures of a display: one page more does."""
        self._wanted[key] += 1
        if self._wanted[key] == 1 and key in self._wakes:
            self._wakes[key]()
        self.tell()

    def leave(self, key: str) -> None:
        """Look at them no longer."""
        self._wanted[key] -= 1
        if self._wanted[key] <= 0:
            del self._wanted[key]

    def tell(self) -> None:
        """Tell the listeners that there is something new."""
        for listener in tuple(self.listeners):
            listener()

    def frames(self, keys: Sequence[str]) -> dict[str, tuple[int, bytes]]:
        """Return the number and the frame of some displays' pictures."""
        with self._lock:
            found = self._frames
            return {key: found[key] for key in keys if key in found}


class ClientPictures:
    """What one page shows of the pictures, and what it lacks.

    Args:
        pictures: of all displays.

    Attributes:
        listeners: called after changes.
    """

    def __init__(self, pictures: Pictures) -> None:
        self.listeners = pictures.listeners
        self._pictures = pictures
        self._shown: tuple[str, ...] = ()
        self._sent: dict[str, int] = {}
        self._handed = 0

    @property
    def shown(self) -> Sequence[str]:
        """The displays whose pictures are on the screen."""
        return self._shown

    def show(self, key: str, on: bool) -> None:
        """Show the pictures of a display, or do not; called in the worker."""
        if on == (key in self._shown):
            return
        if on:
            self._shown = (*self._shown, key)
            self._sent.pop(key, None)
            self._pictures.want(key)
        else:
            self._shown = tuple(one for one in self._shown if one != key)
            self._pictures.leave(key)

    def close(self) -> None:
        """Show nothing any longer."""
        for key in self._shown:
            self.show(key, False)

    # For the channel

    @property
    def version(self) -> int:
        """The number of the last frame, or of the next one to send."""
        return self._handed + bool(self._lacking())

    def since(self, version: int) -> tuple[int, bytes | None]:
        """Return the number of the next frame and the frame, if the page lacks one.

        Args:
            version: the last number; 0 for a page that has none.
        """
        if version == 0:
            self._sent.clear()
        lacking = self._lacking()
        if not lacking:
            return self._handed, None
        # That which has waited longest: a fast camera does not keep others away.
        key, (number, frame) = min(lacking.items(), key=lambda item: item[1][0])
        self._sent[key] = number
        self._handed += 1
        return self._handed, frame

    def _lacking(self) -> dict[str, tuple[int, bytes]]:
        found = self._pictures.frames(self._shown)
        return {k: f for k, f in found.items() if self._sent.get(k) != f[0]}
