"""The Displays panel as a browser without a picture meets it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer

ROBOT = """
<robot name="two">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="arm"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}
    - {Class: rviz_default_plugins/TF, Name: Frames of it, Enabled: true}
    - Class: rviz_common/Group
      Name: Ground
      Enabled: true
      Displays:
        - {Class: rviz_default_plugins/Grid, Name: Floor, Enabled: true}
    - {Class: my_plugins/Radar, Name: Radar, Enabled: true, Gain: 3}
  Global Options: {Fixed Frame: base}
"""


class Page:
    """One browser and the session it sees."""

    def __init__(self, viz: Visualizer, client: ProtocolClient, config: Path) -> None:
        self.viz = viz
        self.client = client
        self.config = config
        self.session = session_of(viz)

    def settle(self) -> None:
        self.client.settle(viser_server(self.viz))

    def set(self, label: str, value: object) -> None:
        self.client.set_value(self.client.uuid_of(label), value)
        self.settle()

    def press(self, label: str) -> None:
        """Press a button, alone or in a row of buttons."""
        rows = [
            message
            for message in self.client.messages
            if message.type == "GuiButtonGroupMessage"
            and label in message.fields["props"]["options"]
        ]
        uuid = rows[-1].fields["uuid"] if rows else self.client.uuid_of(label)
        self.client.set_value(uuid, label if rows else True)
        self.settle()

    def names(self) -> list[str]:
        return [display.name for display in self.session.config.displays]


@pytest.fixture
def page(tmp_path: Path, protocol: Callable[[int], ProtocolClient]) -> Iterator[Page]:
    model, config = tmp_path / "two.urdf", tmp_path / "two.rviz"
    model.write_text(ROBOT)
    config.write_text(CONFIG)
    with Visualizer(model, config) as viz:
        client = protocol(urlsplit(viz.url).port or 0)
        page = Page(viz, client, config)
        page.settle()
        yield page


def test_a_link_is_chosen_from_a_list_and_changed(page: Page) -> None:
    page.set("Link", "arm")
    page.set("Show Trail", True)
    robot = page.session.displays[0].config
    assert robot.dynamic(("Links", "arm")) == {"Show Trail": "true"}
    page.set("Link", "no such link")
    assert page.client.value_of("Link") == "arm"


def test_a_frame_is_switched_off_alone(page: Page) -> None:
    page.set("Frame", "arm")
    # The last of the boxes with this label is the one of the frames.
    page.set("Enabled", False)
    frames = page.session.displays[1].config.dynamic("Frames")
    assert frames["arm"] == {"Value": "false"}


def test_a_display_is_added_at_the_end_and_drawn(page: Page) -> None:
    page.set("Type", "Axes")
    page.press("Add")
    assert page.names()[-1] == "Axes"
    assert page.session.displays[-1].shown
    assert "Length [m]" in page.client.widgets


def test_displays_that_stay_are_not_sent_again(page: Page) -> None:
    mark = page.client.mark()
    page.set("Type", "Axes")
    page.press("Add")
    drawn = [
        message.fields["name"]
        for message in page.client.since(mark)
        if message.type.endswith("MeshMessage") or message.type == "BoxMessage"
    ]
    assert not any("v0" in name for name in drawn)


def test_displays_are_named_copied_moved_and_removed(page: Page) -> None:
    page.set("Display", "Frames of it")
    page.set("Name", "TF")
    assert page.names() == ["Robot", "TF", "Ground", "Radar"]
    page.press("Up")
    assert page.names() == ["TF", "Robot", "Ground", "Radar"]
    page.press("Up")
    page.press("Down")
    assert page.names() == ["Robot", "TF", "Ground", "Radar"]
    page.press("Duplicate")
    assert page.names() == ["Robot", "TF", "TF (2)", "Ground", "Radar"]
    page.set("Display", "TF (2)")
    page.press("Remove")
    assert page.names() == ["Robot", "TF", "Ground", "Radar"]


def test_a_display_goes_into_a_group_and_out_again(page: Page) -> None:
    page.set("In group", "Ground")
    ground = page.session.config.displays[1]
    assert [d.name for d in ground.displays] == ["Floor", "Robot"]
    page.set("In group", "no group")
    assert page.names() == ["Frames of it", "Ground", "Radar", "Robot"]


def test_a_group_does_not_go_into_itself(page: Page) -> None:
    page.set("Display", "Ground")
    page.set("In group", "Ground")
    assert page.names() == ["Robot", "Frames of it", "Ground", "Radar"]


def test_a_change_is_marked_and_saved_into_the_opened_file(page: Page) -> None:
    def title() -> bool:
        return any("two.rviz *" in str(m.fields) for m in page.client.since(mark))

    mark = page.client.mark()
    page.set("Marker Scale", 0.5)
    assert title()
    page.press("Save")
    assert "Marker Scale: 0.5" in page.config.read_text()
    assert "Gain: 3" in page.config.read_text()
    assert not page.session.config.modified


def test_another_name_is_written_beside_the_opened_file(page: Page) -> None:
    page.press("Save as …")
    page.set("File name", "other")
    page.press("Save under this name")
    # The browser that saves gives its view.
    assert (page.config.parent / "other.rviz").read_text().startswith(CONFIG)
    page.press("Save as …")
    page.set("File name", "two")
    page.press("Save under this name")
    assert page.config.read_text().startswith(CONFIG)


@pytest.mark.parametrize("name", ["../up", "a/b", "C:\\a", "", ".hidden", "x\ny"])
def test_a_browser_cannot_write_elsewhere(page: Page, name: str) -> None:
    before = sorted(page.config.parent.iterdir())
    page.press("Save as …")
    page.set("File name", name)
    page.press("Save under this name")
    assert sorted(page.config.parent.iterdir()) == before


def test_a_name_that_is_too_long_is_refused_with_words(page: Page) -> None:
    page.press("Save as …")
    page.set("File name", "ä" * 150)
    mark = page.client.mark()
    page.press("Save under this name")
    answers = [str(message.fields) for message in page.client.since(mark)]
    assert any("at most 200 bytes" in answer for answer in answers)
    assert page.session.problems.of_saves == {}


def test_the_document_can_be_downloaded(page: Page) -> None:
    mark = page.client.mark()
    page.press("Download")
    types = page.client.types(mark)
    assert types["FileTransferStartDownload"] == 1


def test_a_private_page_can_only_download(
    tmp_path: Path, protocol: Callable[[int], ProtocolClient]
) -> None:
    (tmp_path / "two.urdf").write_text(ROBOT)
    with Visualizer(tmp_path / "two.urdf", session="private") as viz:
        client = protocol(urlsplit(viz.url).port or 0)
        client.wait_until(lambda: client.types()["GuiButtonGroupMessage"] > 0)
        rows = [
            tuple(message.fields["props"]["options"])
            for message in client.messages
            if message.type == "GuiButtonGroupMessage"
        ]
        assert ("Download",) in rows
        assert not any("Save" in row for row in rows)
