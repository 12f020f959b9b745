"""From the bytes of an XML file to its text, and the error when it is not XML.

Only the standard library is used here: the xacro child reads this module too and
must start fast.
"""

from __future__ import annotations

import codecs
import re

_DECLARED_ENCODING = re.compile(
    rb"""\s{0,1000}<\?xml\b[^>]{0,1000}?\bencoding\s*=\s*["']([A-Za-z0-9._-]+)["']"""
)
_DECLARATION = re.compile(r"\A<\?xml\b([^<>]{0,1000}?)\?>")
_GOOD_VERSION = re.compile(r"""\s+version\s*=\s*["']1\.[0-9]+["']""")


_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, b"<\0", b"\0<")
"""How a file in UTF-16 begins, with its mark or without."""


class XmlFault(Exception):
    """The text is not well-formed XML.

    Attributes:
        message: expat's message, such as "junk after document element".
        code: expat's error number (`xml.parsers.expat.errors`), 0 for other causes.
        line: line where expat stopped, from 1.
        column: column where expat stopped, from 1.
        text: the whole text that was read.
    """

    def __init__(
        self, message: str, line: int, column: int, text: str, code: int = 0
    ) -> None:
        super().__init__(f"{message}: line {line}, column {column}")
        self.message = message
        self.code = code
        self.line = line
        self.column = column
        self.text = text


def decode(data: bytes) -> str:
    """Decode an XML file: by BOM, then by declared encoding, then as UTF-8.

    Raises:
        XmlFault: the bytes are not in the encoding that the file declares, or they are
            UTF-16, which neither urdfdom nor xacro reads.
    """
    if data.startswith(_UTF16):
        ending = "be" if data[:1] in (b"\xfe", b"\0") else "le"
        text = data.decode(f"utf-16-{ending}", "replace")
        raise XmlFault("saved as UTF-16", 1, 1, text.removeprefix("\ufeff"))
    if data.startswith(codecs.BOM_UTF8):
        return _decoded(data, "utf-8-sig")
    declared = _DECLARED_ENCODING.match(data)
    return _decoded(data, declared[1].decode("ascii") if declared else "utf-8")


def _decoded(data: bytes, encoding: str) -> str:
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = len(before) - (before.rfind(b"\n") + 1) + 1
        message = f"bytes that are not {encoding}"
        text = data.decode("utf-8", "replace")
        raise XmlFault(message, line, column, text) from None
    except (LookupError, UnicodeError):
        text = data.decode("utf-8", "replace")
        raise XmlFault(f"unknown encoding '{encoding}'", 1, 1, text) from None
    return text


def repaired_prolog(text: str) -> str:
    """Give a text a declaration that expat can read, every line in its place.

    Real files have ``<?xml version="0.0" ?>`` or ``<?xml?>``, which urdfdom accepts.
    Only the declaration's own text is replaced.
    """
    match = _DECLARATION.match(text)
    if match is None or _GOOD_VERSION.match(match[1]):
        return text
    return '<?xml version="1.0"' + "\n" * match[1].count("\n") + text[match.end(1) :]


def declared_as_utf8(text: str) -> str:
    """Give a text the declaration that fits when it is written as UTF-8."""
    match = _DECLARATION.match(text)
    if match is None:
        return text
    named = re.sub(r"""(\bencoding\s*=\s*)("[^"]*"|'[^']*')""", r'\1"utf-8"', match[0])
    return named + text[match.end() :]
