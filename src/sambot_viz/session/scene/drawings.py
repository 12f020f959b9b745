"""What the displays of a scene do with a topic."""

from __future__ import annotations

from sambot_viz.displays.data.topic_display import TopicDisplay
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.rviz.declarations import short_name
from sambot_viz.session.scene.scene import Scene
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Drawing


def drawing_of(scene: Scene, topic: str, type_name: str) -> Drawing:
    """Return whether displays draw a topic, or why none of them does.

    Args:
        scene: has the displays.
        topic: its name.
        type_name: of its messages.
    """
    kind = reasons.drawn_by(topic, type_name)
    usual = [one.config for one in scene.displays if one.config.kind == kind]
    is_of_robot = kind is not None and not issubclass(DISPLAYS[kind], TopicDisplay)
    if is_of_robot and any(config.enabled for config in usual):
        # Whatever their topics are called.
        return Drawing(None)
    of_data = [one for one in scene.displays if isinstance(one, TopicDisplay)]
    named = [one for one in of_data if topic in one.all_topics]
    shown = [one for one in named if one.shown]
    said = [one.unseen() for one in shown if one.is_awake]
    if shown:
        why = said[0] if said and None not in said else None
        return Drawing(why, has_looked=bool(said))
    off = [one.config for one in named] or (usual if is_of_robot else [])
    if off:
        return Drawing(reasons.off(off[0].name))
    return Drawing(None if kind is None else reasons.not_shown(short_name(kind)))
