"""The folder of named poses: choose, save, remove."""

from __future__ import annotations

from sambot_viz.errors import JointError
from sambot_viz.panels.widgets import add_text, on_click, options, watch
from sambot_viz.session import Session
from sambot_viz.text import html_text, text

START = "(start values)"


class PoseFolder:
    """The rows of the named poses, in the current container.

    Args:
        session: whose joints take the poses.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        gui = session.audience.gui
        path = session.poses.path
        where = f"Kept in {path.name}." if path else "Kept until the program ends."
        with gui.add_folder("Poses", expand_by_default=False):
            self._choice = gui.add_dropdown("Pose", self._offered(), hint=text(where))
            watch(self._session, self._choice, str, self._use)
            self._name = add_text(self._session, "Pose name", "", lambda _: None)
            on_click(self._session, gui.add_button("Save pose"), self._save)
            on_click(self._session, gui.add_button("Remove pose"), self._remove)
            self._said = gui.add_html("")

    def _offered(self) -> tuple[str, ...]:
        return options((START, *self._session.poses.names), START)

    def _offer(self, chosen: str) -> None:
        offered = self._offered()

        def show() -> None:
            self._choice.options = offered
            self._choice.value = chosen

        self._session.worker.on_loop(show)

    def _use(self, name: str) -> None:
        if name not in self._offered():
            raise ValueError("no such pose")
        if name == START:
            self._session.center_joints()
            return
        left_out = self._session.use_pose(name)
        self._say(f"without {', '.join(left_out)}, which cannot be set", bool(left_out))

    def _save(self) -> None:
        name, joints = text(self._name.value, 60).strip(), self._session.joints
        if joints is None:
            return
        try:
            if name == START:
                raise JointError(f"'{START}' always exists; choose another name")
            self._session.poses.save(name, joints.positions)
        except JointError as error:
            self._say(str(error))
            return
        self._offer(name)
        self._say("", False)

    def _remove(self) -> None:
        try:
            self._session.poses.remove(self._choice.value)
        except JointError as error:
            self._say(str(error))
            return
        self._offer(START)
        self._say("", False)

    def _say(self, said: str, wanted: bool = True) -> None:
        note = f'<p class="sambot-note sambot-warn">{html_text(said)}</p>'
        self._said.content = note if wanted else ""
