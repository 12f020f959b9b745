"""Names in a macro that lack its parameter, so that all its calls share them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import takewhile

from sambot_viz.errors import Problem
from sambot_viz.robot.xacro.diagnose.failed_expansion import parameters
from sambot_viz.robot.xml.element import Element

_REPEATED = ("link-duplicate", "joint-duplicate", "sdf-name-taken")
_UNKNOWN = ("sdf-frame-unknown", "joint-child-unknown", "joint-parent-unknown")
_OF_VALUES = ("sdf-urdf-habit",)
_MISSING_VALUE = "attribute-missing"
_NO_DOLLAR = re.compile(r"(?<!\$)\{\s*(\w+)\s*\}")
_PARAMETER = re.compile(r"\$\{\s*(\w+)\s*\}")
_MISSING = re.compile(r" link '([^']+)', which does not| frame called ([^ ;]+)")
_OFFER = re.compile(r" \((?:did you mean|known:)[^)]*\)")


def name_with_parameters(
    problems: Sequence[Problem], document: Element
) -> list[Problem]:
    """Return the problems, with the names that macros should build from parameters.

    Args:
        problems: problems of a model that comes from xacro.
        document: root element before xacro.
    """
    codes = (*_REPEATED, *_UNKNOWN, *_OF_VALUES, _MISSING_VALUE)
    if not any(problem.code in codes for problem in problems):
        return list(problems)
    done: set[tuple[str, int | None]] = set()
    found: list[Problem] = []
    made: list[str] = []
    for problem in problems:
        key = (problem.code, problem.line)
        if key in done:
            continue
        group = [p for p in problems if (p.code, p.line) == key]
        if problem.code in _REPEATED:
            better = _repeated(problem, document)
        elif problem.code in _UNKNOWN:
            better = _unknown(group, document)
        elif problem.code == _MISSING_VALUE:
            better = _with_unused(problem, document)
        elif problem.code in _OF_VALUES:
            better = _with_expression(group, document)
        else:
            better = None
        if better is not None:
            done.add(key)
        if better is not None and problem.code in _REPEATED:
            made.append(_made_by(better.hint))
        found.append(better or problem)
    return [p for p in found if not any(_lacks(p, pattern) for pattern in made)]


def _made_by(hint: str) -> str:
    """Return the pattern of the names that a parameter in a name creates."""
    name = re.fullmatch('write name="(.*)"', hint)
    return _pattern(name[1]) if name else "$."


def _pattern(template: str) -> str:
    return re.escape(_PARAMETER.sub("\0", template)).replace("\0", r"[\w.-]+")


def _lacks(problem: Problem, pattern: str) -> bool:
    """Return whether a problem reports a missing name that a macro should create."""
    if problem.code not in _UNKNOWN:
        return False
    name = _MISSING.search(problem.message)
    return name is not None and re.fullmatch(pattern, name[1] or name[2]) is not None


def _repeated(problem: Problem, document: Element) -> Problem | None:
    for element in _at(problem, document):
        name, macro = element.get("name"), _macro_around(element)
        if not name or macro is None or "${" in name:
            continue
        better = _with_parameter(name, element, macro)
        return replace(
            problem,
            message=f"the {element.tag} name {name} is the same in all calls of the "
            f"macro {macro.get('name')}; names must be unique, and ROS refuses the "
            "model",
            hint=f'write name="{better}"'
            if better
            else "put a parameter of the macro into the name",
        )
    return None


def _with_parameter(name: str, element: Element, macro: Element) -> str | None:
    """Return a name in the style of the other names in the macro."""
    known = parameters(macro.get("params") or "")
    bare = _NO_DOLLAR.search(name)
    if bare is not None and bare[1] in known:
        return _NO_DOLLAR.sub(r"${\1}", name)
    templates = [t for t in _templates(macro) if _PARAMETER.match(t)]
    heads = {match[1] for t in templates if (match := _PARAMETER.match(t))}
    if len(heads) != 1 or not heads <= set(known):
        return None
    better = f"${{{heads.pop()}}}_{name.rpartition('_')[2]}"
    same = (e.get("name") for e in macro.iter() if e.tag == element.tag)
    return None if better in same else better


def _unknown(group: Sequence[Problem], document: Element) -> Problem | None:
    """Report once the name that each call repeats in its own problem."""
    first = group[0]
    hints = {problem.hint for problem in group}
    if len(hints) < 2 and not any(_NO_DOLLAR.search(p.message) for p in group):
        return None
    bare = next(filter(_lacks_dollar, document.iter()), None)
    if bare is not None:
        place, name = bare.place, bare.get("name") or ""
        right = _NO_DOLLAR.sub(r"${\1}", name)
        return replace(
            first,
            message=f"the name {name} is a text: xacro replaces it only in ${{ and }}; "
            + first.message.partition(" (")[0],
            hint=f'write name="{right}"',
            file=place.file,
            line=place.line,
            column=place.column,
            edits=(),
        )
    for element in _at(first, document):
        macro = _macro_around(element)
        if macro is None or any("${" in v for v in element.attributes.values()):
            continue
        for template in _templates(macro):
            words = [_word(problem.hint, _pattern(template)) for problem in group]
            if all(words):
                word = words[0] or ""
                return replace(
                    first,
                    message=_OFFER.sub("", first.message),
                    hint=first.hint.replace(word, template),
                    edits=tuple(
                        replace(edit, text=edit.text.replace(word, template))
                        for edit in first.edits
                    ),
                )
    return None


def _with_expression(group: Sequence[Problem], document: Element) -> Problem | None:
    """Report once the value that each call repeats: `<mass>${m}</mass>`."""
    first, hints = group[0], [problem.hint for problem in group]
    if len(set(hints)) < 2 or len({(p.place, p.column) for p in group}) > 1:
        return None
    for element in _at(first, document):
        given = [v for v in element.attributes.values() if "${" in v]
        if len(given) == 1 and _macro_around(element) is not None:
            start = _common(hints, first.hint)
            end = _common([hint[::-1] for hint in hints], first.hint[::-1])
            before, after = first.hint[:start], first.hint[len(first.hint) - end :]
            return replace(first, hint=f"{before}{given[0]}{after}")
    return None


def _with_unused(problem: Problem, document: Element) -> Problem | None:
    """Suggest the only parameter of a macro that its body does not use."""
    for element in _at(problem, document):
        macro = _macro_around(element)
        if macro is None:
            continue
        inner = [e for e in macro.iter() if e is not macro]
        texts = [t for e in inner for t in (e.text, e.tag, *e.attributes.values())]
        used = set(re.findall(r"\w+", " ".join(texts)))
        free = [p for p in parameters(macro.get("params") or "") if p not in used]
        said = re.fullmatch(r'(write \w+=)"[^"]*"', problem.hint)
        if len(free) == 1 and said is not None:
            return replace(problem, hint=f'{said[1]}"${{{free[0]}}}"', edits=())
    return None


def _lacks_dollar(element: Element) -> bool:
    """Return whether a name has a parameter of its macro without the $."""
    macro, bare = _macro_around(element), _NO_DOLLAR.search(element.get("name") or "")
    if macro is None or bare is None:
        return False
    return bare[1] in parameters(macro.get("params") or "")


def _common(hints: Sequence[str], hint: str) -> int:
    """Return the length of the common start of hints, up to a tag's or quote's end."""
    same = takewhile(lambda column: len(set(column)) == 1, zip(*hints, strict=False))
    length = len(list(same))
    while length and hint[length - 1] not in '<>"':
        length -= 1
    return length


def _word(hint: str, pattern: str) -> str | None:
    words = re.findall(r"[\w.-]+", hint)
    return next((word for word in words if re.fullmatch(pattern, word)), None)


def _templates(macro: Element) -> Iterator[str]:
    """Yield the names in a macro that contain a parameter."""
    named = ("link", "joint", "frame")
    names = (e.get("name") or "" for e in macro.iter() if e.tag in named)
    return (name for name in dict.fromkeys(names) if _PARAMETER.search(name))


def _macro_around(element: Element) -> Element | None:
    around = element.parent
    while around is not None and around.tag != "xacro:macro":
        around = around.parent
    return around


def _at(problem: Problem, document: Element) -> Iterable[Element]:
    return [
        element
        for element in document.iter()
        if (element.place.file, element.place.line) == (problem.file, problem.line)
        and problem.column in (None, element.place.column)
    ]
