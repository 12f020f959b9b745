"""Explain why a text is not XML: the cause and the fix, not expat's symptom."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.diagnose.lexer import (
    ATTRIBUTE,
    CURLY,
    LexicalError,
    LexicalErrorKind,
    Token,
)
from sambot_viz.robot.xml.diagnose.prolog import other_file_problem, prolog_problems
from sambot_viz.robot.xml.diagnose.source_text import Change, SourceText
from sambot_viz.robot.xml.diagnose.structure import structure_problems

_MOST = 12
"""Most problems reported: further ones usually follow from the first."""


_UTF16 = "saved as UTF-16"
_LIKENESS = 0.75
"""How like a declared prefix a misspelt one is."""
_KNOWN_PREFIXES = {"xacro": "http://www.ros.org/wiki/xacro"}

_MISLEADING: frozenset[LexicalErrorKind] = frozenset(
    {"quote-not-closed", "comment-not-closed", "comment-nested", "tag-not-ended"}
)
"""After one of these nothing else is reported, because the text after it is a guess."""


def explain_xml(text: str, file: str, fault: XmlFault) -> list[Problem]:
    """Find the cause of an XML error, not its symptom.

    Args:
        text: the file as text; bytes that are not UTF-8 may be in it as U+FFFD or as
            lone surrogates.
        file: the path as the user wrote it.
        fault: what expat reported.

    Returns:
        One or more problems of severity "error", in document order, each with a
        line and a fix. Never empty.
    """
    if fault.message == _UTF16:
        return [_plain(fault, file)]
    other = other_file_problem(text, file)
    if other is not None:
        return [other]
    if len(text) > limits.XML_EXPLAINED.value:
        return [_plain(fault, file)]
    source = SourceText(text.replace("\r\n", "\n"))
    problems = prolog_problems(source, file)
    is_clear = source.read.complete
    for error in source.read.errors[:_MOST]:
        problems.append(lexical_problem(source, file, error))
        if error.kind in _MISLEADING:
            is_clear = False
            break
    if is_clear:
        problems += structure_problems(source, file)
        problems += _prefix_problems(source, file)
    if not problems:
        problems = [_plain(fault, file)]
    return sorted(problems, key=lambda p: p.line or 0)[:_MOST]


def _plain(fault: XmlFault, file: str) -> Problem:
    known = (row for row in _FROM_EXPAT if fault.message.startswith(row[0]))
    _, code, message, hint = next(known, _UNKNOWN)
    message = message.format(fault.message, fault.line)
    return Problem("error", code, message, hint, file, fault.line, fault.column)


_FROM_EXPAT = (
    (
        _UTF16,
        "xml-encoding",
        "the file is saved as UTF-16 (PowerShell's > does that), which ROS cannot read",
        'save the file as UTF-8 and write <?xml version="1.0"?> as its first line',
    ),
    (
        "unknown encoding",
        "xml-encoding",
        "the first line names an encoding that does not exist ({})",
        'save the file as UTF-8 and write <?xml version="1.0"?>',
    ),
    (
        "bytes that are not",
        "xml-encoding",
        "the file is not in the encoding that its first line names ({})",
        'save the file as UTF-8 and write <?xml version="1.0"?>',
    ),
    (
        "external entities",
        "xml-external-entity",
        "the document type would read other files, which is not supported",
        "delete <!DOCTYPE …> and write the content itself, or use xacro:include",
    ),
    (
        "limit on input amplification",
        "xml-external-entity",
        "the entities of the document type grow without end, which is not supported",
        "delete <!DOCTYPE …>",
    ),
    (
        "nested too deeply",
        "xml-not-well-formed",
        "the tags are {0}",
        "look for a tag that is opened repeatedly and never closed",
    ),
    (
        "too many elements",
        "model-too-large",
        "the model has {0}",
        "open the model file itself",
    ),
)
"""Messages of expat and the parser: how they begin, then code, message and hint."""

_UNKNOWN = (
    "",
    "xml-not-well-formed",
    "this is not XML from line {1} on ({0})",
    "look at this line and the one before it: every tag closed, every attribute with a "
    "value in quotes, nothing outside <robot> or <sdf>",
)


def _prefix_problems(source: SourceText, file: str) -> list[Problem]:
    """Report prefixes that are used but not declared."""
    opened = [tag for tag in source.tags if not tag.closes]
    known = {"xml", "xmlns"} | {
        a.name[6:] for t in opened for a in t.attributes if a.name.startswith("xmlns:")
    }
    problems: list[Problem] = []
    for token in opened:
        for name in (token.name, *(a.name for a in token.attributes)):
            prefix = name.partition(":")[0] if ":" in name else ""
            if not prefix or prefix in known:
                continue
            near = nearest(prefix.lower(), sorted({*known, "xacro"}), _LIKENESS)
            if near is not None and near != prefix:
                problems.append(_prefix_misspelt(source, file, token, name, near))
                prefix = near
            if prefix in known:
                continue
            known.add(prefix)
            address = _KNOWN_PREFIXES.get(prefix, f"http://example.org/{prefix}")
            root, line = opened[0], source.line(opened[0].start)
            message = (
                f"the prefix {prefix}: is used (first by {name} on line "
                f"{source.line(token.start)}) but not declared on <{root.name}>"
            )
            hint = f'add xmlns:{prefix}="{address}" to <{root.name}> on line {line}'
            code = "xml-prefix-undeclared"
            problems.append(source.error(file, code, root.start, message, hint))
    return problems


def _prefix_misspelt(
    source: SourceText, file: str, token: Token, name: str, near: str
) -> Problem:
    """Report a name whose prefix was meant to be another: <Xacro:property>."""
    right = f"{near}:{name.partition(':')[2]}"
    hint = f"write <{right} …>" if name == token.name else f"write {right}"
    if name == token.name and token.kind == "open":
        hint += f" and </{right}>"
    changes: list[Change] = []
    if name == token.name:
        spans = [(token.start + 1, token.start + 1 + len(name))]
        closing = source.text.find(f"</{name}>", token.end)
        if token.kind == "open":
            spans.append((closing + 2, closing + 2 + len(name)))
        changes = [(*span, right) for span in spans]
    return source.error(
        file,
        "xml-prefix-undeclared",
        token.start,
        f"the prefix of {name} is not declared; did you mean {near}:?",
        hint,
        changes,
    )


_ROWS: dict[LexicalErrorKind, tuple[str, str]] = {
    "ampersand": ("a bare & is not allowed in XML", "write &amp; instead of &"),
    "attribute-twice": ("<{tag}> has the attribute {text} twice{lacks}", "{keep}"),
    "attributes-run-together": (
        "in <{tag}> the attribute {text} comes directly after the value before it",
        "put a blank before {text}",
    ),
    "comment-double-hyphen": (
        'a comment may not contain "--" or end with "-"',
        "{single_hyphens}",
    ),
    "comment-nested": (
        "the comment opened on line {outer_line} contains another <!--: comments "
        "cannot be inside each other, the first --> ends both",
        "close the first comment with --> before line {line}, or delete the inner "
        "<!-- and its -->",
    ),
    "comment-not-closed": (
        "the comment opened on line {line} is never closed, so it swallows the rest "
        "of the file",
        "end it with -->",
    ),
    "less-than": (
        "a bare < is not allowed in a value of <{tag}>",
        "write &lt; instead of <",
    ),
    "quote-not-closed": (
        "the quote that opens {text} in <{tag}> is never closed",
        "write {quote} at the end of the value",
    ),
    "quotes-curly": (
        "{name} in <{tag}> has curly quotes (“ ”), probably pasted from a web page "
        "or a document",
        'use straight quotes: {name}="{value}"',
    ),
    "quotes-missing": (
        "the value of {name} in <{tag}> has no quotes",
        'write {name}="{value}"',
    ),
    "tag-not-ended": (
        "the tag {first_line} is not ended: its > is missing",
        "write > (or />) at its end",
    ),
}
"""Message and hint of each kind; the words in braces are made in `lexical_problem`."""


def lexical_problem(source: SourceText, file: str, error: LexicalError) -> Problem:
    """Make the problem for a lexical error.

    Args:
        source: the text.
        file: its name, for the place.
        error: an error of that text.
    """
    offset = error.offset
    around = (t.start for t in source.read.tokens if t.start < offset < t.end)
    name, _, value = error.text.partition("=")
    facts = {
        "tag": error.tag,
        "text": error.text,
        "line": source.line(offset),
        "outer_line": source.line(next(around, offset)),
        "name": name,
        "value": value.strip(CURLY),
        "quote": source.text[offset],
        "first_line": error.text.partition("\n")[0][:60],
        "single_hyphens": _single_hyphens(error.text),
    }
    other = _other_attribute(source, error)
    facts["lacks"] = f", and no {other}" if other else ""
    facts["keep"] = f"write {other} for one {name}" if other else f"keep one {name}"
    message, hint = (part.format_map(facts) for part in _ROWS[error.kind])
    changes = [*_repair(source, error, value.strip(CURLY), hint, other)]
    return source.error(file, f"xml-{error.kind}", offset, message, hint, changes)


_ALL_OF = {
    "cylinder": "radius length",
    "inertia": "ixx ixy ixz iyy iyz izz",
    "joint": "name type",
    "limit": "lower upper effort velocity",
    "origin": "xyz rpy",
}
"""Element of URDF → the attributes that it usually has, in their order."""


def _attributes_at(source: SourceText, offset: int) -> list[re.Match[str]]:
    """Return the attributes of the tag around an offset, those that are twice too."""
    tag = next(t for t in source.tags if t.start < offset < t.end)
    return [*ATTRIBUTE.finditer(source.text, tag.start, tag.end)]


def _other_attribute(source: SourceText, error: LexicalError) -> str:
    """Return the attribute that one of two equal ones was meant to be, or ""."""
    if error.kind != "attribute-twice":
        return ""
    names = [each[1] for each in _attributes_at(source, error.offset)]
    missing = [n for n in _ALL_OF.get(error.tag, "").split() if n not in names]
    return missing[0] if len(missing) == 1 else ""


def _repair(
    source: SourceText, error: LexicalError, value: str, hint: str, other: str
) -> Iterator[Change]:
    """Yield what makes XML of a text with a lexical error."""
    text, at, end = source.text, error.offset, error.end
    match error.kind:
        case "ampersand" | "less-than":
            yield at, at + 1, "&amp;" if error.kind == "ampersand" else "&lt;"
        case "attributes-run-together":
            yield at, at, " "
        case "quotes-curly" | "quotes-missing":
            yield at, end, f'"{value}"'
        case "quote-not-closed":
            yield end, end, text[at]
        case "tag-not-ended" if text[end - 1] == "/":
            yield end, end, ">"
        case "tag-not-ended":
            following = re.compile(rf"<(/?){re.escape(error.tag)}[\s/>]").search(
                text, end
            )
            yield end, end, ">" if following and following[1] else "/>"
        case "comment-double-hyphen" if hint.startswith("write <!--"):
            yield text.rindex("<!--", 0, at), end, hint.removeprefix("write ")
        case "attribute-twice":
            yield from _one_of_two(source, error, other)
        case _:
            pass


def _one_of_two(
    source: SourceText, error: LexicalError, other: str
) -> Iterator[Change]:
    """Yield the other name for one of two equal attributes, or delete a copy."""
    found = _attributes_at(source, error.offset)
    same = [n for n, each in enumerate(found) if each[1] == error.text]
    if other:
        place = _ALL_OF[error.tag].split().index(other)
        wrong = found[min(reversed(same), key=lambda number: abs(number - place))]
        yield *wrong.span(1), other
    elif len({found[number][0].split("=")[1] for number in same}) == 1:
        yield *found[same[-1]].span(), ""


def _single_hyphens(comment: str) -> str:
    """Advise what to write for a comment with "--"."""
    words = re.sub("-{2,}", "-", comment.strip("- \n"))
    if words.strip("- ") and "\n" not in comment and len(comment) <= 60:
        return f"write <!-- {words} -->"
    return "use one hyphen, or = signs"
