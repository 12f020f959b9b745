"""Names that look alike: one user must not pass for another."""

from __future__ import annotations

import unicodedata

_LIKE_LATIN = str.maketrans(
    # Cyrillic, Greek, Armenian, then small capitals.
    "авгезиіјкмнопрстухьѕԁһԛԝӏѵԍαβγεηικνορτυχωζոօսհցᴀʙᴄᴅᴇɢʜɪᴊᴋʟᴍɴᴏᴘʀꜱᴛᴜᴠᴡʏᴢɑıɩ",
    "abre3uijkmhonpctyxbsdhqwlvgabyenikvoptuxwznouhgabcdeghijklmnoprstuvwyzaii",
)


def same_form(name: str) -> str:
    """Return a key that is equal for names that look alike to a person.

    Letters of other scripts count as the Latin ones that they look like; invisible
    characters do not count.
    """
    form = unicodedata.normalize("NFKC", name).casefold().translate(_LIKE_LATIN)
    return " ".join("".join(c for c in form if c.isprintable()).split())
