"""Splits the page that comes with viser into files.

viser packs its script and its style sheet into one HTML file, as text that each page
unpacks by itself (a third of a second of computing, on a phone more). No browser can
cache the compiled script. Here the server unpacks them once.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass

import numpy as np
import zstandard

_PACKED = re.compile(
    rb'<script data-p="([^"]*)" data-ss="(\d+)" data-cs="(\d+)">(.*?)</script>', re.S
)
_ALPHABET = re.compile(rb'const A="((?:[^"\\]|\\.)*)"')
_UNPACKS = b"const a=de(d.p);"
"""In the loader: the code before it makes the message decoder, which viser needs."""
_RUNS = b"""\
const run=()=>{
  const e=document.createElement("script");
  e.type="module";e.src=d.src;document.head.appendChild(e);
};
if(document.readyState==="loading"){document.addEventListener("DOMContentLoaded",run);}
else{run();}
})();"""
_DIGITS = 5
"""Number of digits of four bytes."""


@dataclass(frozen=True)
class ViserPage:
    """viser's page, with its script in a separate file.

    Attributes:
        html: the page.
        name: name of the script; it changes with the script.
        script: contents of the script.
    """

    html: bytes
    name: str
    script: bytes


def taken_apart(html: bytes, folder: str) -> ViserPage | None:
    """Return viser's page with its script as a file; None for an unknown page format.

    Args:
        html: the page that comes with viser.
        folder: folder of the script, relative to the page.
    """
    packed = _PACKED.search(html)
    if packed is None:
        return None
    alphabet = _ALPHABET.search(packed[4])
    loader, found, _ = packed[4].partition(_UNPACKS)
    if alphabet is None or not found:
        return None
    styles, length = int(packed[2]), int(packed[2]) + int(packed[3])
    content = _decoded(packed[1], alphabet[1].replace(b"\\\\", b"\\"))
    try:
        plain = zstandard.ZstdDecompressor().decompress(content, length)
    except zstandard.ZstdError:
        return None
    script = plain[styles:]
    name = f"viser-{hashlib.sha256(script).hexdigest()[:20]}.js"
    address = f"{folder}{name}".encode()
    element = b'<link rel="modulepreload" href="%s"><script data-src="%s">%s%s</script>'
    filled = element % (address, address, loader, _RUNS)
    before, after = html[: packed.start()], html[packed.end() :]
    # After all others, in viser's order.
    style = b"<style>%s</style></head>" % plain[:styles]
    page = before + filled + after.replace(b"</head>", style, 1)
    return ViserPage(page, name, script)


def _decoded(text: bytes, alphabet: bytes) -> bytes:
    """Decode bytes from text with five digits for every four bytes."""
    values = np.zeros(256, np.uint64)
    values[np.frombuffer(alphabet, np.uint8)] = np.arange(len(alphabet))
    digits = values[np.frombuffer(text, np.uint8)]
    whole = len(digits) // _DIGITS * _DIGITS
    weights = np.array([len(alphabet) ** n for n in range(_DIGITS)][::-1], np.uint64)
    numbers = np.reshape(digits[:whole], (-1, _DIGITS)) @ weights
    rest = 0
    for digit in digits[whole:].tolist():
        rest = rest * len(alphabet) + digit
    left = len(digits) - whole
    return numbers.astype(">u4").tobytes() + rest.to_bytes(max(left - 1, 0), "big")
