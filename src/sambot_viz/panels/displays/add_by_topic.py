"""The topics of the Add dialog of one browser, with the displays that show them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from sambot_viz import limits
from sambot_viz.panels.command import FLAG, TEXT, command
from sambot_viz.panels.displays.topic_tree import shown_topics, topic_rows
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Row
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.data.source_topics import SourceTopics
from sambot_viz.session.scene.scene import Scene

NO_SOURCE = (
    "There are no topics without a source: start again with a recording or a live "
    "robot, as in sambot-viz --source FILE.mcap"
)
NOT_SHOWN = "No display shows any of these topics: tick the box below to see them"


class AddByTopicPanel(Panel):
    """The topics that a search finds, as a tree, while the dialog is open.

    Args:
        sources: have the topics.
        scene: has the types of the messages.
        remake: called when other topics are shown.
    """

    name = "add_by_topic"

    def __init__(
        self,
        sources: SessionSources,
        scene: Scene,
        remake: Callable[[Panel], None],
    ) -> None:
        self._sources = sources
        self._topics: SourceTopics | None = None
        self._scene = scene
        self._remake = remake
        self._wanted: tuple[str, bool] | None = None
        self.refresh()

    def refresh(self) -> None:
        """Show the topics of the sources that there are by now."""
        data = self._sources.data
        topics = self._topics = None if data is None else data.topics
        known = () if topics is None else topics.remade_by
        self.remade_by = (self._sources.replaced, *known)

    def data(self) -> Sequence[Data]:
        """Return what the rows were made for: the words, and whether all are shown."""
        return [Data("add_by_topic/shown", self._wanted)]

    def rows(self) -> Sequence[Row]:
        """Return the rows of the tree, or a sentence."""
        return [] if self._wanted is None else [*self._made(*self._wanted)]

    def _made(self, words: str, shows_all: bool) -> Iterator[Row]:
        messages = self._scene.context.messages
        if self._topics is None or messages is None:
            yield _note("none", NO_SOURCE)
            return
        types = messages.types()
        found = shown_topics({n: types[n] for n in types if _has(n, words)})
        shown = [topic for topic in found if shows_all or topic.displays]
        yield from topic_rows(shown[: limits.ADDED_ROWS.value], f"{self.name}/")
        if len(shown) > limits.ADDED_ROWS.value:
            more = f"{len(shown) - limits.ADDED_ROWS.value:,} more: use the search"
            yield _note("more", more)
        elif not types:
            yield _note("none", self._topics.nothing)
        elif not shown:
            yield _note("none", NOT_SHOWN if found else "No name has this in it")

    @command("add_by_topic/show", FLAG, TEXT, FLAG, client_local=True)
    def _show(self, shown: bool, words: str, shows_all: bool) -> None:
        """Show the topics with all these words in their names, or nothing.

        Args:
            shown: whether the dialog is open.
            words: in any order.
            shows_all: whether those are shown that no display shows.
        """
        self._wanted = (words, shows_all) if shown else None
        self._remake(self)


def _has(topic: str, words: str) -> bool:
    return all(word in topic.lower() for word in words.lower().split())


def _note(name: str, sentence: str) -> Row:
    return Row(f"add_by_topic/{name}", "", "note", value=sentence)
