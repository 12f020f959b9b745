"""An untrusted model reads no file outside the opened folders, whatever it names.

Names and paths are made at random from pieces that mean something to a file system, to
xacro or to the look-up of packages. A failure says the seed that makes them again.
"""

import json
import random
import secrets
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import pytest
import untrusted_reads

from sambot_viz.files import is_below
from sambot_viz.robot.packages.package_index import PackageIndex

ROBOT = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
PLAIN = ROBOT.format('<link name="a"/>')
SECRET = "hunter2"
SHAPES = (
    "<xacro:include filename={}/><link name='a'/>",
    "<xacro:property name='f' value={}/><link name='${{xacro.load_yaml(f)}}'/>",
)
PACKAGES = "<name>{}</name>"


@pytest.fixture
def world(tmp_path: Path) -> Path:
    """A home with a secret, and below it the folder of a model with links out of it."""
    model = tmp_path / "home" / "ws" / "group" / "robot" / "urdf"
    for folder in (model, model / "real", tmp_path / "home" / "ws" / "diary"):
        folder.mkdir(parents=True, exist_ok=True)
    for folder in (tmp_path, tmp_path / "home", tmp_path / "home" / "ws" / "diary"):
        (folder / "secret.yaml").write_text(SECRET)
        (folder / "secret.xacro").write_text(ROBOT.format(f'<link name="{SECRET}"/>'))
    (model.parent / "package.xml").write_text(PACKAGES.format("robot"))
    (model / "own.yaml").write_text("own")
    (model / "own.xacro").write_text(ROBOT.format('<link name="own"/>'))
    for place in (model, model.parent, model.parent.parent):
        (place / "leak").symlink_to(tmp_path / "home")
        (place / "Secret.yaml").symlink_to(tmp_path / "home" / "secret.yaml")
        (place / "Secret.xacro").symlink_to(tmp_path / "home" / "secret.xacro")
    return tmp_path


def names(world: Path, dice: random.Random) -> Iterator[str]:
    """Texts that may stand in $(find …), package names among them."""
    home = str(world / "home")
    pieces = [
        "/", "//", "..", ".", "~", "\\", "*", "?", "%2e%2e", "%2f", " ", "robot",
        "urdf", "leak", "real", "diary", "ws", "group", home, str(world), "etc", "-",
    ]  # fmt: skip
    while True:
        yield "".join(dice.choices(pieces, k=dice.randint(1, 4)))


def files(world: Path, dice: random.Random) -> Iterator[str]:
    """Texts that may stand where a file is named."""
    steps = [
        "..",
        ".",
        "urdf",
        "leak",
        "real",
        "urdf",
        "robot",
        "ws",
        "home",
        "diary",
        "*",
    ]
    ends = ["secret.yaml", "secret.xacro", "SECRET.yaml", "own.yaml", "own.xacro"]
    starts = ["", "", "/", "//", f"{world}/", f"{world}/home/", "file://", "\\"]
    for name in names(world, dice):
        way = "/".join([*dice.choices(steps, k=dice.randint(0, 5)), dice.choice(ends)])
        start = dice.choice([f"$(find {name})/", f"package://{name}/", *starts])
        yield f"{start}{way}"


def test_xacro_opens_nothing_outside_the_opened_folders(world: Path):
    seed = secrets.randbelow(10**6)
    dice = random.Random(seed)
    named = files(world, dice)
    models = [
        ROBOT.format(dice.choice(SHAPES).format(quoteattr(next(named))))
        for _ in range(150)
    ]
    # What an attack begins with, in case chance leaves it out.
    attacks = [
        f"$(find /){world}/home/secret.yaml",
        f"$(find {world}/home)/secret.yaml",
        "$(find diary)/secret.yaml",
        "$(find leak)/secret.yaml",
        "$(find ..)/../../secret.yaml",
        "SECRET.yaml",
    ]
    models += [ROBOT.format(SHAPES[1].format(quoteattr(name))) for name in attacks]
    # These two must go on working, so that refusing everything does not pass.
    good = ["own.yaml", "$(find robot)/urdf/own.yaml"]
    models += [ROBOT.format(SHAPES[1].format(quoteattr(name))) for name in good]
    folder = world / "home" / "ws" / "group" / "robot" / "urdf"
    program = [sys.executable, untrusted_reads.__file__]
    done = subprocess.run(
        program,
        input=json.dumps([_job(folder, model) for model in models]),
        capture_output=True,
        check=True,
        text=True,
    )
    answers: list[dict[str, Any]] = json.loads(done.stdout)
    for model, answer in zip(models, answers, strict=True):
        outside = [
            file
            for file in map(Path, answer["files"])
            if is_below(file, [world])
            and not is_below(file, [folder.parent])
            # Where packages are is looked up around the model.
            and file.name not in ("package.xml", "manifest.xml")
        ]
        assert not outside, f"seed {seed}: {model}"
        assert SECRET not in answer["answer"], f"seed {seed}: {model}"
    assert all('link name=\\"own\\"' in answer["answer"] for answer in answers[-2:])


def _job(folder: Path, text: str) -> dict[str, Any]:
    return {
        "file": str(folder / "m.xacro"),
        "text": text,
        "folder": str(folder),
        "arguments": {},
        "package_path": [],
        "environment": {},
        "untrusted": True,
        "output_limit": 10**6,
    }


class Touched:
    """Counts the files and folders that are looked into inside a `with` block."""

    def __init__(self) -> None:
        self.paths: list[str] = []
        self._on = False
        # There is no way to take it away again.
        sys.addaudithook(self._take)

    def _take(self, event: str, arguments: tuple[Any, ...]) -> None:
        if self._on and event in ("open", "os.listdir", "os.scandir"):
            self.paths.append(str(arguments[0]))

    def __enter__(self) -> None:
        self._on = True

    def __exit__(self, *_: object) -> None:
        self._on = False


def test_what_is_no_name_of_a_package_is_looked_for_nowhere(world: Path):
    seed = secrets.randbelow(10**6)
    folder = world / "home" / "ws" / "group" / "robot" / "urdf"
    index = PackageIndex(folder, [], {"ROS_PACKAGE_PATH": str(world)})
    touched = Touched()
    made = names(world, random.Random(seed))
    asked = [name for name in (next(made) for _ in range(400)) if not _is_name(name)]
    assert len(asked) > 100
    for name in asked:
        with touched:
            assert index.find(name).path is None, f"seed {seed}: {name}"
        assert touched.paths == [], f"seed {seed}: {name}"


def _is_name(text: str) -> bool:
    allowed = all(letter.isalnum() or letter in "_.-" for letter in text)
    return allowed and text[:1] not in (".", "-")
