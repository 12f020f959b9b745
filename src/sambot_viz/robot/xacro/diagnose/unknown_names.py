"""Names that xacro does not know: properties, macros, parameters, arguments."""

from __future__ import annotations

import re
from collections import Counter

from sambot_viz.edits import (
    Extent,
    include_before,
    rename_element,
    source_of,
    write,
    write_attribute,
)
from sambot_viz.errors import Fix, Place, Problem, did_you_mean, nearest
from sambot_viz.robot.slips.needs_xacro import OWN_TAGS
from sambot_viz.robot.slips.vocabulary import is_one_slip, meant
from sambot_viz.robot.xacro.diagnose.failed_expansion import (
    FailedExpansion,
    line_in,
    parameters,
)
from sambot_viz.robot.xacro.diagnose.macro_parameters import renamed_parameter
from sambot_viz.robot.xacro.diagnose.source_files import NamedElement, token_place

_BUILT_IN = (
    "acos asin atan atan2 ceil cos cosh degrees e exp fabs float floor fmod hypot inf "
    "int isinf isnan len list log log10 map max min nan pi pow radians range round sin "
    "sinh sqrt str tan tanh tau True False None".split()
)
_NO_NUMPY = "xacro has no numpy; write sin, cos, sqrt and pi without a prefix"
_ELSEWHERE = {
    "abs": ("python.abs", "write python.abs(…): xacro keeps it under python"),
    **dict.fromkeys(("np.", "numpy."), ("", _NO_NUMPY)),
    **dict.fromkeys(("PI", "Pi", "M_PI"), ("pi", "write pi")),
    "true": ("True", "write True"),
    "false": ("False", "write False"),
}
"""Names of other languages → what xacro has for them, and how that is said."""


def undefined_name(failed: FailedExpansion, name: str) -> Problem:
    """Explain a name in ${…} that is not a property, parameter or function."""
    at = failed.expression_place()
    if not failed.expression:
        pattern = rf"\$[({{][^}}]*(?<![\w.]){re.escape(name)}(?!\w)[^}}]*[}})]"
        at = failed.sources.find(pattern, at) or at
    here = failed.pointing_at(at)
    known = [p for p in failed.named("property") if p.name == name]
    unprefixed = next((p for p in known if not p.prefixed), None)
    if unprefixed and not any(p.prefixed for p in known):
        return _prefix_forgotten(here, unprefixed)
    outside = [p for p in known if p.prefixed and not p.inside]
    without_value = next((p for p in outside if _is_block(here, p)), None)
    if without_value:
        return _value_as_text(here, without_value)
    if outside:
        return _defined_after_use(here, outside[0])
    if (called := _namespace_called(here, name)) is not None:
        return called
    later = here.order.later("property", name, at) if not known else None
    if later is not None:
        return _defined_after_use(here, later)
    code = "xacro-undefined-name"
    local = next((p for p in known if p.prefixed and p.inside), None)
    if local:
        return here.error(
            code,
            f"{name} is not defined here: {line_in(local.place, at)} defines it only "
            f"inside the macro {local.inside}{here.trail}",
            'move the property out of the macro, or add scope="parent" to it',
        )
    message = f"{name} is not defined{here.trail}"
    return here.error(code, message, _near_name(here, name))


def _is_block(failed: FailedExpansion, thing: NamedElement) -> bool:
    """Return whether a property has its value as content, and not as value=."""
    tag = failed.sources.tag_at(thing.place, "xacro:property")
    return tag is not None and tag.kind == "open" and tag.get("value") is None


def _value_as_text(failed: FailedExpansion, thing: NamedElement) -> Problem:
    """Report <xacro:property name="x">1</xacro:property>, and blocks in ${…}."""
    source, used = source_of(thing.place.file), line_in(failed.at, thing.place)
    tag = None if source is None else source.tag(source.offset(thing.place))
    text = (
        ""
        if source is None or tag is None
        else source.text[slice(*source.text_behind(tag))]
    )
    end = None if source is None or tag is None else source.end_of(tag)
    here, name = failed.pointing_at(thing.place), thing.name
    message = f"the property {name} has its value as content, so that {used} cannot "
    message += f'calculate with it: only <xacro:insert_block name="{name}"/> sees it'
    inner = "" if source is None or tag is None else source.text[tag.end : end]
    if source is None or tag is None or end is None or inner.count("<") != 1:
        hint = f'write <xacro:insert_block name="{name}"/> there'
        return here.error("xacro-attribute-missing", message, hint)
    whole = Extent(tag.name.start - 1, end)
    right = f'<xacro:property name="{name}" value="{text}"/>'
    fix = Fix(f"write {right}", (source.edit(thing.place, whole, right),))
    return here.error("xacro-attribute-missing", message, fix)


def _near_name(failed: FailedExpansion, name: str) -> str | Fix:
    """Advise what to write for a name that is not defined."""

    def instead(right: str, hint: str, wrong: str = name) -> Fix:
        return failed.rewrite(rf"(?<![\w.]){re.escape(wrong)}(?!\w)", right, hint)

    for wrong in (name, f"{name}."):
        if wrong in _ELSEWHERE:
            right, hint = _ELSEWHERE[wrong]
            pattern = rf"(?<![\w.]){re.escape(wrong)}" + (r"(?!\w)" if right else "")
            return failed.rewrite(pattern, right, hint)
    if any(a.name == name for a in failed.named("arg")):
        return failed.rewrite(
            rf"\$\{{\s*{re.escape(name)}\s*\}}",
            f"$(arg {name})",
            f"{name} is an argument: write $(arg {name}) instead of ${{{name}}}",
        )
    beside = _beside(failed, name)
    if beside:
        return instead(f"({beside})", f"write what {name} is: {beside}")
    things = {p.name: p.place for p in failed.named("property") if p.prefixed}
    own: list[str] = []
    for macro in failed.named("macro"):
        if any(macro.name == running for running, _ in failed.failure.macros):
            own += parameters(macro.params)
            things.update({p: macro.place for p in parameters(macro.params)})
    longer = next((each for each in own if name.startswith(f"{each}_")), None)
    if longer is not None and failed.expression == name:
        right = f"${{{longer}}}{name.removeprefix(longer)}"
        pattern = rf"\$\{{\s*{re.escape(name)}\s*\}}"
        return failed.rewrite(pattern, right, f"write {right}")
    alike = [each for each in things if each.lower() == name.lower()]
    alike += [
        each
        for each in own
        if 1 in (len(each), len(name)) and each[0].lower() == name[0].lower()
    ]
    near = next(iter(alike), None) or nearest(name, [*things, *_BUILT_IN])
    used = _uses(failed)
    if near is None or used[near] or not is_one_slip(name, near):
        # Half a rename leaves a property that nothing uses.
        near = _unused(used, name, set(things).difference(own)) or near
    if near in things:
        where = line_in(things[near], failed.at)
        # The name is used again and again, and the one defined never.
        if near not in own and not used[near] and used[name] > 1:
            hint = f'write name="{name}" on {where}: {near} is used nowhere'
            return write_attribute(things[near], "name", near, name, hint=hint)
        return instead(near, f"did you mean {near} (defined on {where})?")
    if near:
        return instead(near, f"did you mean {near}?")
    if (renamed := renamed_parameter(failed, name)) is not None:
        return renamed
    for macro in failed.named("macro"):
        if name in parameters(macro.params) and not failed.failure.macros:
            return (
                f"write its value: {name} is a parameter of the macro {macro.name}, "
                "and known only in it"
            )
    return f'add <xacro:property name="{name}" value="…"/> before it' + (
        f"; {did_you_mean(name, things)}" if things else ""
    )


def _unused(used: Counter[str], name: str, properties: set[str]) -> str | None:
    """Return the property without a use that alone has the most words of a name."""
    words = set(name.lower().split("_"))
    shared = {
        each: len(words.intersection(each.lower().split("_")))
        for each in properties
        if used[each] == 0
    }
    most = max(shared.values(), default=0)
    found = [each for each, count in shared.items() if count == most]
    return found[0] if most > 1 and len(found) == 1 else None


def _uses(failed: FailedExpansion) -> Counter[str]:
    """Return how often each name is in an expression of the files."""
    return Counter(
        name
        for _, source in failed.sources.sources()
        for expression in re.findall(r"\$\{[^}]*\}", source.text)
        for name in re.findall(r"(?<![\w.])[A-Za-z_]\w*", expression)
    )


def _beside(failed: FailedExpansion, name: str) -> str:
    """Return the expression of the attribute or element beside that has this name."""
    source = failed.sources.get(failed.at.file)
    if source is None or not re.fullmatch("i[xyz][xyz]", name):
        return ""
    at = source.offset(failed.at.line, failed.at.column or 1)
    start = max(
        source.text.rfind("<inertia", 0, at), source.text.rfind("<inertia>", 0, at)
    )
    end = source.text.find("</inertial", at)
    written = source.text[max(start, 0) : end if end >= 0 else at]
    found = re.search(
        rf"""<{name}>\s*\$\{{([^}}]*)\}}|\b{name}\s*=\s*["']\$\{{([^}}]*)\}}""", written
    )
    return (found[1] or found[2]).strip() if found else ""


def _prefix_forgotten(failed: FailedExpansion, thing: NamedElement) -> Problem:
    tag = f'<{thing.kind} name="{thing.name}" …>'
    return failed.pointing_at(thing.place).error(
        "xacro-prefix-forgotten",
        f"{thing.name} is not defined (used on {line_in(failed.at, thing.place)}): "
        f"{tag} on line {thing.place.line} lacks the prefix xacro:, so xacro does "
        "not see it",
        rename_element(
            thing.place,
            thing.kind,
            f"xacro:{thing.kind}",
            f'write <xacro:{thing.kind} name="{thing.name}" …>',
        ),
    )


def _defined_after_use(failed: FailedExpansion, thing: NamedElement) -> Problem:
    code, at = f"xacro-{thing.kind}-after-use", failed.at
    where = line_in(thing.place, at)
    if failed.is_root(at):
        value = _value_of(failed, thing)
        return failed.error(
            code,
            f"{thing.name} is used in the root tag but defined only on {where}: xacro "
            "evaluates the root tag before anything inside it",
            f"give it on the command line: {thing.name}:={value}"
            if thing.kind == "arg"
            else f"write the value of {thing.name} itself in the root tag",
        )
    known_as = failed.order.known_as(thing, at)
    if known_as != thing.name:
        return _namespace_forgotten(failed, thing, known_as)
    use, definition = failed.order.meeting(at, thing.place) or (at, thing.place)
    what = "the definition" if definition == thing.place else "the include"
    from_where = f" on {line_in(definition, at)}" if definition != thing.place else ""
    to = "the include on " if use != at else ""
    return failed.error(
        code,
        f"{thing.name} is used here but defined only on {where}: xacro works from top "
        f"to bottom{failed.trail}",
        f"move {what}{from_where} above {to}{line_in(use, at)}",
    )


def _namespace_forgotten(
    failed: FailedExpansion, thing: NamedElement, known_as: str
) -> Problem:
    """Report a name of a file that is included with a namespace, used without it."""
    ns, at = known_as.rpartition(".")[0], failed.at
    message = f"{thing.name} is known here only as {known_as}: {thing.place.file} is "
    message += f'included with ns="{ns}"{failed.trail}'
    if thing.kind == "macro":
        tag, right = f"xacro:{thing.name}", f"xacro:{known_as}"
        fix = rename_element(at, tag, right, f"write <{right} …>")
        return failed.error("xacro-unknown-macro", message, fix)
    wrong = rf"(?<![\w.]){re.escape(thing.name)}(?!\w)"
    fix = failed.rewrite(wrong, known_as, f"write {known_as}")
    return failed.error("xacro-undefined-name", message, fix)


def _namespace_called(failed: FailedExpansion, name: str) -> Problem | None:
    """Explain the call of a namespace, in which xacro looks for the body of a macro."""
    ns, here = failed.called, failed.pointing_at(failed.call_place())
    if here.sources.tag_at(here.at, f"xacro:{ns}") is None and failed.failure.calls:
        ns, file, line = failed.failure.calls[0]
        here = failed.pointing_at(Place(file, line))
    include = next((i for i in here.order.includes if i.ns == ns), None)
    call = here.sources.tag_at(here.at, f"xacro:{ns}")
    source = here.sources.get(here.at.file)
    if name != "body" or include is None or call is None or source is None:
        return None
    here = here.pointing_at(token_place(source, here.at.file, call))
    macros = [m for m in here.named("macro") if m.place.file == include.file]
    given = {attribute.name for attribute in call.attributes}
    fitting = [m for m in macros if given <= {*parameters(m.params)}]
    likely = [m for m in fitting if m.name == ns] or fitting
    message = f"{ns} is no macro: {line_in(include.place, here.at)} gives this "
    message += f"namespace to {include.file}"
    known = ", ".join(f"xacro:{ns}.{m.name}" for m in macros)
    fix: str | Fix = f"call a macro of it: {known}" if known else "call a macro of it"
    if len(likely) == 1:
        right = f"xacro:{ns}.{likely[0].name}"
        fix = rename_element(here.at, f"xacro:{ns}", right, f"write <{right} …>")
    return here.error("xacro-unknown-macro", message, fix)


def _value_of(failed: FailedExpansion, argument: NamedElement) -> str:
    """The default of an argument when it is a plain text, else "…"."""
    tag = failed.sources.tag_at(argument.place, "xacro:arg")
    default = tag.get("default") if tag is not None else None
    return default if default and re.fullmatch(r"[\w./:-]+", default) else "…"


def unknown_macro(failed: FailedExpansion, name: str) -> Problem:
    """Explain a call <xacro:name> of a macro that is not defined."""
    at = failed.at
    if failed.sources.tag_at(at, f"xacro:{name}") is None:
        at = next((place for place, _ in failed.sources.calls(f"xacro:{name}")), at)
    here = failed.pointing_at(at)
    macros = failed.named("macro")
    same = [m for m in macros if m.name == name]
    if same and all(not m.prefixed for m in same):
        return _prefix_forgotten(here, same[0])
    if same:
        return _defined_after_use(here, same[0])
    later = here.order.later("macro", name, at)
    if later is not None:
        return _defined_after_use(here, later)
    elsewhere = failed.sources.neighbours_with_macro(name)
    if elsewhere:
        there = elsewhere[0].place
        return here.error(
            "xacro-include-forgotten",
            f"the macro {name} is not known here: {there.file} defines it on line "
            f"{there.line}, but no file that is read includes that file{here.trail}",
            include_before(here.at, there.file),
        )
    message = f"the macro {name} does not exist{here.trail}"
    return here.error("xacro-unknown-macro", message, _near_macro(here, name))


def _near_macro(failed: FailedExpansion, name: str) -> str | Fix:
    at, tag, own = failed.at, f"xacro:{name}", meant(name, OWN_TAGS)
    macros = [m for m in failed.named("macro") if m.prefixed]
    places = {failed.order.known_as(m, at): m.place for m in macros}
    near = nearest(name, places)
    if near:
        hint = f"did you mean {near} ({line_in(places[near], at)})?"
        return rename_element(at, tag, f"xacro:{near}", hint)
    if own:
        return rename_element(at, tag, f"xacro:{own}", f"write <xacro:{own} …>")
    if not places:
        return (
            f"no macro is defined in the files that were read: include the file with "
            f'<xacro:macro name="{name}"> before the call; this file may be a part '
            "that another file includes"
        )
    known = did_you_mean(name, places)
    return f"include the file that defines it before the call; {known}"


def undefined_argument(failed: FailedExpansion, name: str) -> Problem:
    """Explain $(arg name) without a value."""
    pattern = rf"\$\(\s*arg\s+{re.escape(name)}\s*\)|xacro\.arg\(\W*{re.escape(name)}\b"
    at = failed.sources.find(pattern, failed.at) or failed.at
    here = failed.pointing_at(at)
    known = failed.named("arg")
    same = next((a for a in known if a.name == name), None)
    if same is not None and not same.prefixed:
        return _prefix_forgotten(here, same)
    later = here.order.later("arg", name, at)
    if later is not None:
        return _defined_after_use(here, later)
    near = nearest(name, sorted({a.name for a in known if a.name != name}))
    if same is not None:
        hint = f"{line_in(same.place, at)} declares it where xacro does not get: move "
        hint += "it before all macros and conditions"
        fix: str | Fix = hint
    elif name in failed.names_in_expressions:
        fix = write(at, f"$(arg {name})", f"${{{name}}}", hint=f"write ${{{name}}}")
    else:
        meant_one = f"did you mean $(arg {near})? If not, " if near else ""
        hint = f"{meant_one}give it on the command line: {name}:=…, or a default in "
        hint += f'the file: <xacro:arg name="{name}" default="…"/>'
        fix = write(at, name, near, hint=hint) if near else hint
    return here.error(
        "xacro-argument-missing", f"the argument {name} has no value{here.trail}", fix
    )
