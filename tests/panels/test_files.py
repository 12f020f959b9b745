"""The File menu's rows: saving, opening, downloading, for whom and where."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import files_of, session_of
from lower_limit import lower
from panel_rows import edit, panel_of
from protocol_client import ProtocolClient

from sambot_viz import UsageError, Visualizer, bundled, load_config
from sambot_viz.export.page_file import ask_page
from sambot_viz.panels.files_panel import FilesPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Row
from sambot_viz.panels.saved_pictures import PicturesPanel
from sambot_viz.panels.unfolded import keep_expanded
from sambot_viz.session import Session

CONFIG = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Floor
"""


def names_in(file: Path) -> list[str]:
    return [display.name for display in load_config(file).displays]


class Page:
    """A browser's File menu: its rows, what it was told, what was unfolded."""

    def __init__(self, viz: Visualizer, session: Session, disk: bool = True) -> None:
        self.sentences: list[str] = []
        self.unfolded: set[str] = set()
        (client,) = session.clients.all.values()
        more = {
            "files": files_of(viz) if disk else None,
            "ask_page": ask_page,
            "keep_unfolded": self.unfolded.update,
            "say": lambda words, level: self.sentences.append(f"{level}: {words}"),
            "remake": self.remade,
        }
        self.panel = panel_of(FilesPanel, session, client, **more)
        self.pictures = panel_of(PicturesPanel, session, client, **more)
        self.remade(self.panel)

    @property
    def items(self) -> set[str]:
        panels = (self.panel, self.pictures)
        return {item.id for panel in panels for item in panel.items()}

    def remade(self, panel: Panel) -> None:
        self.data = {data.id: data.json() for data in panel.data()}

    def act(self, command_id: str, *values: Any) -> None:
        pictures = command_id in ("file/picture", "file/page")
        edit(self.pictures if pictures else self.panel, command_id, list(values))
        self.remade(self.panel)

    def value(self, data_id: str) -> Any:
        return self.data[data_id].get("value")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "mine.rviz").write_text(CONFIG, "utf-8")
    (tmp_path / "other.rviz").write_text(CONFIG.replace("Floor", "Ground"), "utf-8")
    (tmp_path / "notes.txt").write_text("no config", "utf-8")
    return tmp_path


@pytest.fixture
def viz(folder: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    return make_viz(config=folder / "mine.rviz")


@pytest.fixture
def peer(viz: Visualizer, protocol: Callable[..., ProtocolClient]) -> ProtocolClient:
    peer = protocol(viz.viser.get_port())
    peer.settle(viz.viser)
    peer.wait_until(lambda: bool(session_of(viz).clients.all))
    return peer


@pytest.fixture
def page(viz: Visualizer, peer: ProtocolClient) -> Page:
    return Page(viz, session_of(viz))


def test_a_name_and_enter_save_a_new_file_beside_the_opened_one(
    page: Page, folder: Path
) -> None:
    assert page.value("file/state")["folder"] == str(folder)
    page.act("file/save-as", " my look ", False, [])
    assert page.value("file/answer")["done"] == "my look.rviz"
    assert page.sentences == [f"ok: Saved my look.rviz in {folder}"]
    assert names_in(folder / "my look.rviz") == ["Floor"]
    assert page.value("file/state")["name"] == "my look.rviz"


def test_an_existing_file_is_replaced_only_after_a_question(
    page: Page, folder: Path
) -> None:
    before = (folder / "other.rviz").read_text("utf-8")
    page.act("file/save-as", "other", False, [])
    assert page.value("file/answer")["exists"] == "other.rviz"
    assert (folder / "other.rviz").read_text("utf-8") == before
    page.act("file/save-as", "other", True, [])
    assert page.value("file/answer")["done"] == "other.rviz"
    assert names_in(folder / "other.rviz") == ["Floor"]


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("", "enter a name"),
        (".rviz", "enter a name"),
        ("../up", "without a folder"),
        ("a\\b", "without a folder"),
        ("/etc/passwd", "without a folder"),
        ("CON", "Windows keeps"),
        ("lpt1.old", "Windows keeps"),
        ("what?", "cannot contain ?"),
        ("a:b.rviz", "cannot contain :"),
        (".hidden", "would be hidden"),
        ("end.", "end with a dot"),
        ("x" * 300, "too long"),
        ("ä" * 150, "too long"),
    ],
)
def test_a_name_that_cannot_be_written_is_refused_with_the_folder(
    page: Page, folder: Path, name: str, reason: str
) -> None:
    before = sorted(os.listdir(folder))
    with pytest.raises(UsageError, match=reason) as refused:
        page.act("file/save-as", name, False, [])
    assert str(folder) in str(refused.value)
    assert sorted(os.listdir(folder)) == before


def test_a_name_may_be_as_long_as_file_systems_take(
    page: Page, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "CONFIG_NAME", 11)
    page.act("file/save-as", "äbcd", False, [])
    assert (folder / "äbcd.rviz").exists()
    with pytest.raises(UsageError, match=r"name is too long .*11 bytes at most"):
        page.act("file/save-as", "äbcdef", False, [])


def test_a_picture_has_no_side_above_the_limit(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "PAGE_PICTURE", 1000)
    for width, height in ((1001, 1000), (1000, 1001)):
        with pytest.raises(UsageError, match="to 1,000 pixels on a side"):
            page.act("file/picture", width, height)
    page.act("file/picture", 1000, 1000)


def test_a_browser_cannot_fill_the_disk_with_configs(
    page: Page, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "CONFIG_NAMES", 3)
    page.act("file/save-as", "third", False, [])
    with pytest.raises(UsageError, match="remove one first"):
        page.act("file/save-as", "fourth", False, [])
    assert not (folder / "fourth.rviz").exists()
    page.act("file/save-as", "third", True, [])
    page.act("file/save", [])


def test_the_disk_is_asked_no_more_for_many_configs_than_for_few(
    page: Page, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    resolved: list[Path] = []
    resolve = Path.resolve

    def counted(path: Path, strict: bool = False) -> Path:
        resolved.append(path)
        return resolve(path, strict)

    monkeypatch.setattr(Path, "resolve", counted)
    counts: list[int] = []
    for many in (5, 200):
        for number in range(many):
            (folder / f"config{number}.rviz").write_text(CONFIG)
        resolved.clear()
        page.act("file/list")
        counts.append(len(resolved))
    assert counts[0] == counts[1]


def test_what_a_killed_program_has_left_is_neither_listed_nor_kept(
    page: Page, folder: Path
) -> None:
    old, new = folder / ".mine.rviz.0123abcd", folder / ".mine.rviz.89abcdef"
    others = [folder / ".mine.rviz", folder / ".mine.rviz.backup", new]
    for file in (old, *others):
        file.write_text(CONFIG)
    for file in (old, *others[:2]):
        os.utime(file, (1e9, 1e9))
    page.act("file/list")
    assert ".mine.rviz" not in str(page.value("file/names"))
    page.act("file/save", [])
    assert not old.exists()
    assert all(file.exists() for file in others)


def test_a_file_that_cannot_be_written_is_reported_and_nothing_is_lost(
    page: Page, folder: Path, viz: Visualizer
) -> None:
    (folder / "taken.rviz").mkdir()
    session_of(viz).document.set_option("Frame Rate", 7)
    with pytest.raises(UsageError, match="Nothing is lost") as refused:
        page.act("file/save-as", "taken", True, [])
    assert str(folder) in str(refused.value)
    page.remade(page.panel)
    assert page.value("file/state")["modified"]
    assert page.value("file/state")["name"] == "mine.rviz"


def test_saving_takes_the_mark_for_unsaved_changes_away(
    page: Page, folder: Path, viz: Visualizer
) -> None:
    assert not page.value("file/state").get("modified")
    session_of(viz).document.set_option("Frame Rate", 7)
    page.remade(page.panel)
    assert page.value("file/state")["modified"]
    page.act("file/save", ["d1", "d1/Offset"])
    assert not page.value("file/state").get("modified")
    assert page.unfolded == {"d1", "d1/Offset"}
    assert load_config(folder / "mine.rviz").global_options.get("Frame Rate") == 7


def test_opening_offers_the_files_of_the_folder_and_takes_no_other(
    page: Page, viz: Visualizer
) -> None:
    page.act("file/list")
    of_program = "urdf_config.rviz (comes with the program)"
    assert page.value("file/names") == ["mine.rviz", "other.rviz", of_program]
    with pytest.raises(UsageError, match="no file"):
        page.act("file/open", "notes.txt")
    page.act("file/open", "other.rviz")
    assert [d.name for d in session_of(viz).document.config.displays] == ["Ground"]
    assert page.value("file/state")["name"] == "other.rviz"
    assert not page.value("file/state").get("modified")


def test_a_link_is_a_file_of_the_folder_only_if_it_does_not_lead_out_of_it(
    page: Page, folder: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "theirs.rviz").write_text(CONFIG, "utf-8")
    (folder / "out.rviz").symlink_to(elsewhere / "theirs.rviz")
    (folder / "dangling.rviz").symlink_to(elsewhere / "new.rviz")
    (folder / "inside.rviz").symlink_to(folder / "other.rviz")
    page.act("file/list")
    assert page.value("file/names")[:-1] == ["inside.rviz", "mine.rviz", "other.rviz"]
    for name in ("out", "dangling"):
        with pytest.raises(UsageError, match="link to another folder"):
            page.act("file/save-as", name, True, [])
    assert sorted(os.listdir(elsewhere)) == ["theirs.rviz"]
    page.act("file/save-as", "inside", True, [])
    assert names_in(folder / "other.rviz") == ["Floor"]


def test_a_workspace_of_links_to_its_sources_opens_and_saves_these(
    folder: Path,
    tmp_path_factory: pytest.TempPathFactory,
    protocol: Callable[..., ProtocolClient],
) -> None:
    installed = tmp_path_factory.mktemp("install")
    for file in folder.glob("*.rviz"):
        (installed / file.name).symlink_to(file)
    with Visualizer(config=installed / "mine.rviz", port=0) as viz:
        protocol(viz.viser.get_port()).settle(viz.viser)
        page = Page(viz, session_of(viz))
        page.act("file/list")
        assert page.value("file/names")[:-1] == ["mine.rviz", "other.rviz"]
        page.act("file/save-as", "other", True, [])
        assert names_in(folder / "other.rviz") == ["Floor"]


def test_the_config_of_the_program_is_opened_again_and_fits_the_robot(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    model, config = tmp_path / "r.urdf", tmp_path / "mine.rviz"
    model.write_text('<robot name="r"><link name="trunk"/></robot>', "utf-8")
    config.write_text(CONFIG, "utf-8")
    with Visualizer(model, config, port=0) as viz:
        protocol(viz.viser.get_port()).settle(viz.viser)
        page = Page(viz, session_of(viz))
        page.act("file/list")
        page.act("file/open", page.value("file/names")[-1])
        assert names_in(bundled.config_path()) == [
            display.name for display in session_of(viz).document.config.displays
        ]
        assert (
            session_of(viz).document.config.global_options.get("Fixed Frame") == "trunk"
        )
        assert page.sentences[-1] == "ok: Opened urdf_config.rviz from the program"
        with pytest.raises(UsageError, match="save it under a name"):
            page.act("file/save", [])


def test_a_broken_file_is_not_opened_and_the_reason_has_its_line(
    page: Page, folder: Path, viz: Visualizer
) -> None:
    (folder / "bad.rviz").write_text("Panels: [\n", "utf-8")
    with pytest.raises(UsageError, match=r"bad.rviz cannot be opened: line \d"):
        page.act("file/open", "bad.rviz")
    assert [d.name for d in session_of(viz).document.config.displays] == ["Floor"]


def test_saving_and_downloading_take_the_view_of_the_browser(
    page: Page, peer: ProtocolClient, folder: Path, viz: Visualizer
) -> None:
    (client,) = session_of(viz).clients.all.values()
    client.view.set("Distance", 4.5)
    mark = peer.mark()
    page.act("file/download")
    peer.wait_until(lambda: peer.types(mark)["FileTransferPart"] == 1)
    (part,) = (m for m in peer.since(mark) if m.type == "FileTransferPart")
    assert b"Distance: 4.5" in part.fields["content"]
    assert session_of(viz).document.config.view.get("Distance") != 4.5
    page.act("file/save", [])
    assert load_config(folder / "mine.rviz").view.get("Distance") == 4.5


def test_the_config_comes_as_a_download_of_its_name_without_another_click(
    page: Page, peer: ProtocolClient
) -> None:
    mark = peer.mark()
    page.act("file/download")
    peer.wait_until(lambda: peer.types(mark)["FileTransferPart"] == 1)
    (start,) = (m for m in peer.since(mark) if m.type == "FileTransferStartDownload")
    assert start.fields["filename"] == "mine.rviz"
    assert start.fields["save_immediately"]


def test_a_visitor_may_download_and_uses_no_disk_of_the_server(
    viz: Visualizer, peer: ProtocolClient, folder: Path
) -> None:
    visitor = Page(viz, session_of(viz), disk=False)
    state = visitor.value("file/state")
    assert state["private"] and "folder" not in state
    assert visitor.items == {
        "file/state",
        "file/download",
        "file/picture",
        "file/page",
        "file/answer",
    }


@pytest.mark.parametrize("how", ["save-as", "open"])
def test_the_file_that_was_saved_or_opened_last_is_followed(
    folder: Path, protocol: Callable[..., ProtocolClient], how: str
) -> None:
    with Visualizer(config=folder / "mine.rviz", port=0, watch=True) as viz:
        peer = protocol(viz.viser.get_port())
        session = session_of(viz)
        peer.wait_until(lambda: bool(session.clients.all))
        page = Page(viz, session)
        page.act(
            f"file/{how}", *(["new", False, []] if how == "save-as" else ["other.rviz"])
        )
        name = page.value("file/state")["name"]
        (folder / name).write_text(CONFIG.replace("Floor", "Changed"), "utf-8")
        peer.wait_until(
            lambda: [d.name for d in session.document.config.displays] == ["Changed"]
        )
        (folder / "mine.rviz").write_text(CONFIG.replace("Floor", "Old"), "utf-8")
        (folder / name).write_text(CONFIG.replace("Floor", "Again"), "utf-8")
        peer.wait_until(
            lambda: [d.name for d in session.document.config.displays] == ["Again"]
        )


@pytest.mark.parametrize("config", [None, bundled.config_path()])
def test_a_bundled_config_is_saved_beside_the_model_or_where_the_program_works(
    tmp_path: Path,
    protocol: Callable[..., ProtocolClient],
    monkeypatch: pytest.MonkeyPatch,
    config: Path | None,
) -> None:
    model = tmp_path / "robots" / "arm.urdf"
    model.parent.mkdir()
    model.write_text('<robot name="arm"><link name="base"/></robot>', "utf-8")
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    for given, folder in ((model, model.parent), (None, work)):
        with Visualizer(given, config=config, port=0) as viz:
            peer = protocol(viz.viser.get_port())
            session = session_of(viz)
            peer.wait_until(lambda session=session: bool(session.clients.all))
            page = Page(viz, session)
            assert page.value("file/state")["folder"] == str(folder)
            with pytest.raises(UsageError, match="no file of its own"):
                page.act("file/save", [])
            peer.close()


def test_unfolded_rows_are_written_as_rviz_names_them(folder: Path) -> None:
    config = load_config(folder / "mine.rviz")
    rows = [
        Row("options", "", "group", "Global Options"),
        Row("status", "", "status", "Global Status"),
        Row("d1", "", "display", "Grid"),
        Row("d1/Offset", "d1", "vector", "Offset"),
        Row("d2", "", "display", "Grid"),
    ]
    keep_expanded(config, rows, {"status", "d1", "d1/Offset", "d2"})
    path = folder / "saved.rviz"
    config.save(path)
    expected = ("/Status1", "/Grid1", "/Grid1/Offset1", "/Grid2")
    assert load_config(path).expanded == expected
    # What only RViz has, below a row that is there, stays; what is gone goes.
    config.expanded = ("/Grid2/Other1", "/Gone1", *expected)
    keep_expanded(config, rows, {"d1"})
    assert config.expanded == ("/Grid2/Other1", "/Grid1")


def test_an_empty_list_of_unfolded_rows_means_that_all_are_folded(
    folder: Path,
) -> None:
    config = load_config(folder / "mine.rviz")
    assert config.expanded is None
    config.expanded = ()
    config.save(folder / "saved.rviz")
    assert load_config(folder / "saved.rviz").expanded == ()


def test_a_page_of_what_has_moved_is_a_download_one_at_a_time(
    viz: Visualizer, page: Page, peer: ProtocolClient
) -> None:
    with pytest.raises(UsageError, match="nothing has moved in the last minute"):
        page.act("file/page", "past", "rviz")
    with pytest.raises(UsageError, match="there is no motion 'jump'"):
        page.act("file/page", "jump", "rviz")
    viz.set_joint_positions({"drivewhl_l_joint": 1.0})
    mark = peer.mark()
    page.act("file/page", "past", "rviz")
    with pytest.raises(UsageError, match="a page is being made already"):
        page.act("file/page", "past", "rviz")
    peer.wait_until(lambda: bool(page.sentences))
    assert page.sentences == ["ok: Saved sam_bot.html, 1.0 MB"]
    peer.wait_until(lambda: peer.types(mark)["FileTransferPart"] == 1)
    (part,) = (m for m in peer.since(mark) if m.type == "FileTransferPart")
    assert b"<title>sam_bot</title>" in part.fields["content"]
