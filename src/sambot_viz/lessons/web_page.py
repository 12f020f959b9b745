"""A lesson as one HTML page for any web server, without scripts or requests.

The page escapes all text from a lesson's files. It is for reading and checks nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape

from sambot_viz.content_policy import policy_element
from sambot_viz.lessons.html_text import block_html
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.markdown import TextBlock, blocks

PICTURES = "pictures"
"""Folder of the pictures, beside the page."""
_STYLE = """
:root { color-scheme: light dark }
body { font: 16px/1.55 system-ui, sans-serif; max-width: 46em; margin: 2em auto;
  padding: 0 1em }
pre { overflow: auto; padding: .7em; border: 1px solid #8886; border-radius: 6px }
img { max-width: 100% }
section { border-top: 1px solid #8886; margin-top: 2.5em }
iframe { width: 100%; height: 26em; border: 1px solid #8886 }
.note { border-left: 4px solid #48c; padding: .1em 1em }
.soft { opacity: .7 }
"""


@dataclass(frozen=True, slots=True)
class StepRobots:
    """The robots of a step, as pages beside the lesson's page; "" for none.

    Attributes:
        start: start state of the student's robot.
        reference: robot that passes.
        broken: whether there is a start that cannot be shown.
    """

    start: str = ""
    reference: str = ""
    broken: bool = False


def lesson_page(
    lesson: Lesson,
    track: str,
    robots: Mapping[str, StepRobots],
    files: Sequence[str],
    ships: str | None,
) -> str:
    """Return the page of a lesson.

    Args:
        lesson: the lesson.
        track: track of the lesson.
        robots: name of a step → its robots.
        files: start files, as addresses relative to the page.
        ships: name of the lesson, if it is bundled with the program.
    """
    title = escape(lesson.title)
    steps = "".join(
        f'<li><a href="#step-{number}">{escape(step.title)}</a></li>'
        for number, step in enumerate(lesson.steps, 1)
    )
    sections = "".join(
        _section(number, step, track, robots.get(step.name, StepRobots()))
        for number, step in enumerate(lesson.steps, 1)
    )
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f"{policy_element('lesson')}"
        f"<title>{title}</title><style>{_STYLE}</style></head><body>\n"
        f"<h1>{title}</h1>\n<p>{escape(' '.join(lesson.about.split()))}</p>\n"
        f"{_note(lesson, track, ships)}{_files(files)}"
        f"<h2>Steps</h2>\n<ol>{steps}</ol>\n{sections}</body></html>\n"
    )


def _note(lesson: Lesson, track: str, ships: str | None) -> str:
    others = [name for name in lesson.tracks if name != track]
    ways = f" This is the track {escape(track)}" if track else ""
    if others:
        ways += f"; {escape(', '.join(others))} is another one"
    whole = "FOLDER is that of the whole lesson: ask whoever gave you this page. "
    return (
        '<div class="note"><p>Here you can read the lesson and turn its robots. '
        "This page cannot check your files or show your robot: that needs the program "
        "sambot-viz on your computer, with Python 3.10 or newer. In a copy of its "
        "repository:</p>\n"
        f"<pre><code>pip install .\nsambot-viz lesson {escape(ships or 'FOLDER')}"
        f"</code></pre>\n<p>{'' if ships else whole}It shows the same steps beside "
        f"your robot.{ways}{'.' if ways else ''}</p></div>\n"
    )


def _files(files: Sequence[str]) -> str:
    if not files:
        return ""
    links = "".join(
        f'<li><a href="{escape(name)}" download>{escape(name)}</a></li>'
        for name in files
    )
    return f"<h2>Files to begin with</h2>\n<ul>{links}</ul>\n"


def _section(number: int, step: LessonStep, track: str, robots: StepRobots) -> str:
    text = f"{step.text}\n\n{dict(step.in_track).get(track, '')}"
    points = f"{step.points:g} point{'' if step.points == 1 else 's'}"
    shown = "".join(_robots(robots))
    hints = "".join(
        f"<details><summary>Hint {count}</summary>{_html(blocks(hint.text))}</details>"
        for count, hint in enumerate(step.shown_hints(track, 10**9), 1)
    )
    return (
        f'<section id="step-{number}"><h2>{number}. {escape(step.title)} '
        f'<span class="soft">{points}</span></h2>\n{_html(blocks(text))}'
        f"{shown}{hints}</section>\n"
    )


def _robots(robots: StepRobots) -> Iterator[str]:
    for words, page in (
        ("The robot to begin with", robots.start),
        ("What it is to become", robots.reference),
    ):
        if page:
            yield (
                f"<details><summary>{words}</summary>"
                f'<iframe src="{escape(page)}" loading="lazy" title="{words}"></iframe>'
                f'<p><a href="{escape(page)}">Open it alone</a></p></details>\n'
            )
    if robots.broken:
        yield (
            '<p class="soft">The robot to begin with has an error, so there is no '
            "picture of it. The program says which.</p>\n"
        )


def _html(found: Iterable[TextBlock]) -> str:
    return "".join(block_html(block, pictures=PICTURES) for block in found)
