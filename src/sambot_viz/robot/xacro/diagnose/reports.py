"""The reports of xacro, and what to say about each."""

from __future__ import annotations

from sambot_viz import limits
from sambot_viz.robot.xacro.diagnose.failed_expansion import CORRECT_PATH

ELEMENT = "the element that xacro was working on"
EXPRESSION = "the expression that failed"
CALL = "the macro call that failed"

ROWS: tuple[tuple[str, str, str, str, str], ...] = (
    (
        r"^missing package (?!\w[\w.-]*$)(.*)",
        "xacro-package-not-found",
        "“{0}” is not the name of a package{x.trail}",
        "write the name that its package.xml has: $(find NAME)",
        r"\$\(\s*find\s+%s",
    ),
    (
        r"^missing package (\S+)",
        "xacro-package-not-found",
        "the package {0} was not found (looked in {x.searched}){x.trail}",
        "{x.near_package}give the folder that holds it (the one with package.xml): "
        "--package-path FOLDER",
        r"\$\(\s*find\s+%s\s*\)|find\(\W*%s\b",
    ),
    (
        r"Undefined parameters \[([^\]]*)\]",
        "xacro-parameter-missing",
        "the call of {x.called} lacks the {x.lacking}{x.declared}",
        "add {x.values}, or give a default where it is declared: "
        'params="… {x.listed[0]}:=1"',
        CALL,
    ),
    (
        r'Undefined block "([^"]*)"',
        "xacro-block",
        "insert_block uses the block {0}, which does not exist{x.trail}",
        "{x.near_block}add *{0} to the params of the macro",
        r"<xacro:insert_block[^>]*name\s*=\s*[\"']%s",
    ),
    (
        r"Not enough blocks",
        "xacro-block",
        "the call of {x.called} contains fewer elements than it takes{x.blocks}",
        "{x.missing_block}",
        CALL,
    ),
    (
        r"No such file or directory: '?(?:[^'\[\n]*/)?(\$?\(?find ([\w.-]+)\)?)/"
        r"([^'\[\n]+)",
        "xacro-substitution",
        "{0}/{2} is read as the name of a file: xacro finds packages by $(find …) only",
        'write filename="$(find {1})/{2}"',
        ELEMENT,
    ),
    (
        r"Xacro conditional \"(\$?\(?(arg|env|optenv|eval) ([^\")]+)\)?)\"",
        "xacro-condition",
        "the condition “{0}” is a text: xacro replaces it only in $( and )",
        'write value="$({1} {2})"',
        ELEMENT,
    ),
    (
        r"No such file or directory: '?[^'\[\n]*?package://([^/'\[\n]+)/(?:[^'\[\n]*/)?"
        r"([^/'\[\n]+)",
        "xacro-include-missing",
        "xacro does not understand package:// in an include ({1})",
        "write $(find {0})/… instead",
        r"(?s)<xacro:include\b[^>]*package://%s",
    ),
    (
        r"No such file or directory: '?((?:[^'\[\n]*/)?([^/'\[\n]+\.ya?ml))",
        "xacro-include-missing",
        "the yaml file {1} was not found: {0} does not exist{x.folder_missing}"
        "{x.trail}",
        CORRECT_PATH,
        r"load_yaml\([^\n]*?%2s",
    ),
    (
        r"No such file or directory: '?((?:[^'\[\n]*/)?([^/'\[\n]+))",
        "xacro-include-missing",
        "the included file {1} was not found: {0} does not exist{x.folder_missing}"
        "{x.trail}",
        CORRECT_PATH,
        r"(?s)<xacro:include\b[^>]*%2s|load_yaml\([^\n]*?%2s",
    ),
    (
        r"The yaml dictionary has no key '([^']*)'",
        "xacro-yaml-key",
        "the yaml file has no key {0}{x.in_expression}{x.trail}",
        "{x.near_key}",
        EXPRESSION,
    ),
    (
        r"circular variable definition: ((\S+) -> [^\n]*)",
        "xacro-circular-property",
        "these properties refer to each other: {0}",
        "give one of them a plain value",
        r"<xacro:property\b[^>]*name\s*=\s*[\"']%2s[\"']",
    ),
    (
        r'Xacro conditional "([^"]*)" evaluated to "\1"',
        "xacro-condition",
        "the condition “{0}” is neither true nor false{x.trail}",
        "write true, false, a number, or a comparison such as ${{x == 'a'}}",
        r"<xacro:(?:if|unless)\b[^>]*%s",
    ),
    (
        r'Xacro conditional "([^"]*)" evaluated to "([^"]*)"',
        "xacro-condition",
        "the condition “{0}”, which became “{1}”, is neither true nor false{x.trail}",
        "write true, false, a number, or a comparison such as ${{x == 'a'}}",
        r"<xacro:(?:if|unless)\b[^>]*%s",
    ),
    (
        r"environment variable '?\"?([A-Za-z_]\w*)",
        "xacro-environment",
        "the environment variable {0} is not set",
        "set it ({0}=… before the command), or write $(optenv {0} default)",
        r"\$\(\s*env\s+%s",
    ),
    (
        r"\$\(env var\) command only accepts one argument \[(env (\S+) ([^\]]+))\]",
        "xacro-substitution",
        "$({0}): env takes no default, and fails where {1} is not set",
        "write $(optenv {1} {2})",
        r"\$\(%s",
    ),
    (
        r"\$\(arg var\) may only specify one arg \[(arg (\S+) ([^\]]+))\]",
        "xacro-substitution",
        "$({0}): arg takes the name only; its default is in <xacro:arg>",
        'write $(arg {1}), and before it <xacro:arg name="{1}" default="{2}"/>',
        r"\$\(%s",
    ),
    (
        r"\$\(find pkg\) accepts exactly one argument \[(find (\S+) ([^\]]+))\]",
        "xacro-substitution",
        "$({0}): find takes the name of the package only",
        "write $(find {1})/{2}",
        r"\$\(%s",
    ),
    (
        r"\[(find|arg|env|optenv)\]$",
        "xacro-substitution",
        "$({0}) lacks a name",
        "add it: $({0} NAME)",
        r"\$\(%s",
    ),
    (
        r"Unknown substitution command \[(find-pkg-share ([^\]]*))\]",
        "xacro-substitution",
        "xacro does not know $({0})",
        "write $(find {1})",
        r"\$\(%s",
    ),
    (
        r"Unknown substitution command \[([^\]]*)\]",
        "xacro-substitution",
        "xacro does not know $({0})",
        "{x.as_expression}xacro knows $(find …), $(arg …), $(env …), $(optenv …), "
        "$(cwd), $(eval …)",
        r"\$\(%s",
    ),
    (
        r"invalid expression: (.*\$\{.*)",
        "xacro-expression-syntax",
        "the expression {0} is not closed{x.trail}",
        "add }}; an expression cannot contain }} before its end",
        "%s",
    ),
    (
        r"invalid expression: (.+)",
        "xacro-expression-syntax",
        "the expression {0} is not closed{x.trail}",
        "add ); an expression cannot contain ) before its end",
        "%s",
    ),
    (
        r"Property names must[^:]*:\s*(\S+)",
        "xacro-property-name",
        "{0} cannot be the name of a property: letters, digits and _ only, and no __ "
        "at the start",
        "write {x.identifier} everywhere",
        r"<xacro:property\b[^>]*name\s*=\s*[\"']%s[\"']",
    ),
    (
        r"(?:xacro:)?(\w+): missing attribute '([^']+)'",
        "xacro-attribute-missing",
        "<xacro:{0}> lacks the attribute {1}",
        'write <xacro:{0} … {1}="…">',
        ELEMENT,
    ),
    (
        r"^RecursionError in (.+?): ",
        "xacro-recursion",
        "the expansion never ends: the macro {0} calls itself",
        "put <xacro:if value=…> around the inner call",
        ELEMENT,
    ),
    (
        r"^RecursionError",
        "xacro-recursion",
        "the expansion never ends: {x.ring}",
        "correct the name of the included file, or delete the include",
        ELEMENT,
    ),
    (
        r"^Refused",
        "xacro-refused",
        "this is not allowed in a file that is not trusted: {x.text}",
        "run without --untrusted if you know the author",
        EXPRESSION,
    ),
    (
        r"^SyntaxError.*: '\(' was never closed",
        "xacro-expression-syntax",
        "a ( is never closed in ${{{x.expression}}}{x.trail}",
        "add ) at the end",
        EXPRESSION,
    ),
    (
        r"^SyntaxError.*: unmatched '\)'",
        "xacro-expression-syntax",
        "a ) closes nothing in ${{{x.expression}}}{x.trail}",
        "delete the ) that is too many",
        EXPRESSION,
    ),
    (
        r"^SyntaxError.*: invalid (?:decimal|imaginary) literal",
        "xacro-expression-syntax",
        "a number is directly before a name in ${{{x.expression}}}{x.trail}",
        "write * between the number and the name",
        EXPRESSION,
    ),
    (
        r"^SyntaxError",
        "xacro-expression-syntax",
        "the expression ${{{x.expression}}} cannot be read ({x.text}){x.trail}",
        "{x.as_substitution}",
        EXPRESSION,
    ),
    (
        r"^TypeError.*: unsupported operand type\(s\) for \^",
        "xacro-expression-syntax",
        "^ is not a power in ${{{x.expression}}}{x.trail}",
        "write ** for ^",
        EXPRESSION,
    ),
    (
        r"^(?:TypeError|ValueError).*: .*(?:str|sequence)",
        "xacro-expression-value",
        "{x.text}{x.in_expression}{x.trail}",
        "one of the values is text where a number is expected: look for a unit, a "
        "comma or several numbers in a property",
        EXPRESSION,
    ),
    (
        r"^(?:TypeError|ValueError)",
        "xacro-expression-value",
        "{x.text}{x.in_expression}{x.trail}",
        "check the values of the properties and arguments in it",
        EXPRESSION,
    ),
    (
        r"^ZeroDivisionError",
        "xacro-division-by-zero",
        "division by zero{x.in_expression}{x.trail}",
        "one of the values is 0: check the properties and arguments in it",
        EXPRESSION,
    ),
    (
        r"^Timeout",
        "xacro-timeout",
        f"expanding takes longer than {limits.XACRO_TIME.value} s and was stopped"
        "{x.trail}",
        "look for a macro or an include that calls itself, or a very long loop",
        ELEMENT,
    ),
    (
        r"^OutputLimit",
        "xacro-too-large",
        f"the expanded robot has more than {limits.XACRO_OUTPUT.value:,} characters, "
        "and was stopped{x.trail}",
        "look for a macro that calls itself, or a very long text in ${{…}}",
        ELEMENT,
    ),
    (
        r"^MemoryError",
        "xacro-too-large",
        f"expanding needs more than {limits.XACRO_MEMORY.value:,} MB of memory and was "
        "stopped{x.trail}",
        "look for a very large number or text in ${{…}}",
        ELEMENT,
    ),
    (
        r"^NotXml",
        "xacro-output-not-xml",
        "the output of xacro is not XML because of {x.text}",
        "look for an expression that gives control characters or markup",
        ELEMENT,
    ),
    (
        "",
        "xacro-failed",
        "xacro cannot expand this: {x.text}{x.in_expression}{x.trail}",
        "look at the element on this line, and at the macros and files named here",
        EXPRESSION,
    ),
)
"""Pattern of "kind in macro: text", code, message, hint, and where to point: one of the
three places above, or a pattern to look for, with the groups as %s and %2s. Sentences
have the groups as {0} and {1}, and properties of `FailedExpansion` as {x.…}. The first
row that fits counts."""
