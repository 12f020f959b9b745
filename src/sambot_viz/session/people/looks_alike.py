"""Names that look alike: one user must not pass for another."""

from __future__ import annotations

import unicodedata

_LIKE_LATIN = str.maketrans(
    # Cyrillic, Greek, Armenian, then small capitals.
    "авгезиіјкмнопрстухьѕԁһԛԝӏѵԍαβγεηικνορτυχωζոօսհցᴀʙᴄᴅᴇɢʜɪᴊᴋʟᴍɴᴏᴘʀꜱᴛᴜᴠᴡʏᴢɑıɩ",
    "abre3uijkmhonpctyxbsdhqwlvgabyenikvoptuxwznouhgabcdeghijklmnoprstuvwyzaii",
)


def same_form(name: str) -> str:
    """Return what names have in common that look alike to a person.

    Letters of other scripts that look like Latin ones count as these, and what is not
    seen counts as nothing.
    """
    form = unicodedata.normalize("NFKC", name).casefold().translate(_LIKE_LATIN)
    return " ".join("".join(c for c in form if c.isprintable()).split())
