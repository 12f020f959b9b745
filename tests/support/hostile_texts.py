"""Texts that a terminal obeys or does not show, wherever strangers write."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

from made_recording import START, store_of_all, transforms_message, write_messages

FORGED = "sambot-viz: forged"
"""How a line begins that a name has made."""
HOSTILE = {
    "refused by XML": f"\x1b]0;OWNED\x07\x1b[31m\n{FORGED}: all is well\r{FORGED}",
    "taken by XML": "\x7f\x9b31m\x90\x85\u202e\u2066\u200b\u2028\ufeff\u3164\u00ad",
    "half a character": "\udcff",
}
"""What a name may hold → such a text."""

Words = list[str]
Place = Callable[[Path, str], Iterator[Words]]
PLACES: dict[str, Place] = {}
"""Where the text is written → the command lines that could repeat it."""


def place(make: Place) -> Place:
    """Add a place by the name of its function."""
    PLACES[make.__name__.replace("_", " ")] = make
    return make


def save(path: Path, words: str) -> str:
    """Write a file as any program could, and return its path."""
    path.write_bytes(words.encode("utf-8", "surrogateescape"))
    return str(path)


def of_model(path: str) -> Iterator[Words]:
    """Yield the commands that read a model."""
    for words in (["check"], ["check", "--format", "json"], ["expand"], ["frames"]):
        yield [*words, path]


def joined(extra: str, name: str) -> str:
    """Return a URDF with a link of this name below its base."""
    return (
        f'<robot name="r">{extra}<link name="base"/><link name={name}/>'
        f'<joint name={name} type="fixed"><parent link="base"/><child link={name}/>'
        f"</joint></robot>"
    )


@place
def names_in_a_urdf(folder: Path, text: str) -> Iterator[Words]:
    for number, name in enumerate((f'"a{text}"', quoteattr(f"a{text}"))):
        path = save(folder / f"r{number}.urdf", joined("", name))
        yield from of_model(path)
        yield ["echo", path, "base", f"a{text}"]
        yield ["frames", path, "--joint", f"a{text}=1"]
        twice = save(folder / f"t{number}.urdf", joined(f"<link name={name}/>", name))
        yield from of_model(twice)


@place
def names_that_references_make(folder: Path, text: str) -> Iterator[Words]:
    name = '"a' + "".join(f"&#{ord(c)};" for c in text if ord(c) < 0xD800) + '"'
    extra = (
        f"<link name={name}/><joint name={name} type={name}/><material name={name}/>"
    )
    yield from of_model(save(folder / "a.urdf", joined("", name)))
    yield from of_model(save(folder / "b.urdf", joined(extra, name)))


@place
def files_that_a_model_names(folder: Path, text: str) -> Iterator[Words]:
    for number, uri in enumerate(("package://p{}/m.stl", "m{}.stl", "file:///m{}.dae")):
        mesh = f"<mesh filename={quoteattr(uri.format(text))}/>"
        visual = f'<link name="v"><visual><geometry>{mesh}</geometry></visual></link>'
        yield from of_model(save(folder / f"{number}.urdf", joined(visual, '"a"')))


@place
def comments_and_texts_of_a_model(folder: Path, text: str) -> Iterator[Words]:
    extra = f"<!-- a{text} --><gazebo>b{text}<![CDATA[c{text}]]></gazebo>"
    yield from of_model(save(folder / "a.urdf", joined(extra, '"a"')))
    yield from of_model(save(folder / "b.urdf", f"<robot>{text}</link{text}>"))


XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@place
def what_xacro_computes(folder: Path, text: str) -> Iterator[Words]:
    coded = "".join(f"\\u{ord(c):04x}" for c in text)
    for number, inside in enumerate(
        (
            "<xacro:include filename='no${p}.x'/>",
            "<link name='${p}'/><link name='${p}'/>",
            "<xacro:m b='${p}'/>",
            "${p + q}",
            "<xacro:arg name='${p}' default='${p}'/>$(arg n${p})",
            f"<xacro:macro name='m' params='a'/><xacro:m {text.strip()}='1'/>",
        )
    ):
        text_of = f'<xacro:property name="p" value="${{\'{coded}\'}}"/>{inside}'
        xacro = f'<robot name="r" {XACRO}>{text_of}<link name="base"/></robot>'
        yield from of_model(save(folder / f"{number}.xacro", xacro))


@place
def an_sdf_file(folder: Path, text: str) -> Iterator[Words]:
    for number, name in enumerate((f'"a{text}"', quoteattr(f"a{text}"))):
        sdf = (
            f'<sdf version="1.9"><model name={name}><link name={name}/>'
            f"<link name={name}/><joint name={name} type={name}>"
            f"<parent>x{text}</parent><child>y{text}</child></joint></model></sdf>"
        )
        yield from of_model(save(folder / f"{number}.sdf", sdf))


@place
def names_of_files_and_folders(folder: Path, text: str) -> Iterator[Words]:
    inside = folder / f"pk{text}"
    inside.mkdir()
    twice = '<robot name="r"><link name="a"/><link name="a"/></robot>'
    yield from of_model(save(inside / f"a{text}.urdf", twice))
    fine = save(inside / f"b{text}.urdf", '<robot name="r"><link name="a"/></robot>')
    yield from of_model(fine)
    save(inside / f"c{text}.rviz", "Visualization Manager: [")
    save(inside / "package.xml", f"<package><name>p{text}</name></package>")
    (inside / "launch").mkdir()
    save(inside / "launch" / f"d{text}.launch.py", f"a = 'no{text}\nx = (\n")
    yield ["check", str(inside)]
    yield ["check", "--format", "json", str(inside)]
    yield ["config", str(inside / f"c{text}.rviz")]
    yield ["frames", fine, "-o", str(inside / f"no{text}" / f"e{text}.svg")]
    yield ["frames", fine, "-o", f"e{text}.png"]
    yield ["snapshot", fine, "-o", f"e{text}.svg"]
    yield ["export", fine, "-o", str(inside / f"no{text}" / "e.html")]
    for ending in (".mcap", ".db3", ".bag"):
        yield ["topics", save(inside / f"f{text}{ending}", f"no recording {text}")]


@place
def what_does_not_exist(folder: Path, text: str) -> Iterator[Words]:
    del folder
    for ending in ("", ".urdf", ".mcap"):
        for command in ("check", "expand", "topics", "config"):
            yield [command, f"/no{text}{ending}"]
    yield [f"no{text}"]


ARGUMENTS = (
    "--{}", "--joint=x{}=1", "--joint=x{}", "--zeros={}=a", "--joint-state=no{}",
    "--static-transform=0 0 {}", "--static-transform=0 0 0 0 0 0 a{} a{}",
    "--fixed-frame={}", "--look={}", "--source={}", "--source=foxglove://{}",
    "--source=bag:{}", "--at={}", "--for={}", "--package-path={}", "a{}:=1", "gui:={}",
    "--msg-path={}", "--model={}", "--display-config=no{}.rviz", "--debug={}",
)  # fmt: skip
OF_SERVER = (
    "--host={}", "--port={}", "--allow-origin={}", "--base-path={}", "--token={}",
    "--presenter={}", "--trust-user-header={}", "--session={}", "--unix-socket=no/{}",
    "--record={}", "--record-dir={}", "--wheel-radius={}", "--left-wheel={}",
)  # fmt: skip


@place
def words_of_the_command_line(folder: Path, text: str) -> Iterator[Words]:
    model = save(folder / "r.urdf", joined("", '"a"'))
    for word in ARGUMENTS:
        yield ["frames", model, "--for=0.05", word.format(*2 * [text])]
    yield ["echo", model, "base", f"no{text}"]
    yield ["check", model, f"--formt{text}"]
    for word in OF_SERVER:
        # Without --left-wheel the server would start.
        yield [model, word.format(text), "--at=no"]
    yield ["completion", f"bash{text}"]
    yield ["check", "--format", f"json{text}", model]


@place
def recordings(folder: Path, text: str) -> Iterator[Words]:
    path = str(write_hostile_bag(folder / "a.mcap", text))
    for command in ("topics", "frames"):
        yield [command, path]
    yield ["topics", path, "--format", "json"]
    yield ["echo", path, "base", f"a{text}"]
    yield ["echo", path, "base", f"no{text}"]
    bag = folder / "bag"
    bag.mkdir()
    coded = text.encode("ascii", "backslashreplace").decode().replace("\n", "\\n")
    save(
        bag / "metadata.yaml",
        f'rosbag2_bagfile_information:\n  storage_identifier: "a{coded}"\n'
        f'  relative_file_paths: ["no{coded}.mcap"]\n',
    )
    yield ["topics", str(bag)]


@place
def configs(folder: Path, text: str) -> Iterator[Words]:
    coded = "".join(f"\\u{ord(c):04x}" for c in text)
    display = (
        f'    - Class: "rviz_default_plugins/Grid{coded}"\n      Name: "n{coded}"\n'
    )
    other = f'    - Class: rviz_default_plugins/Grid\n      Color: "a{coded}"\n'
    head = "Visualization Manager:\n  Displays:\n"
    for number, config in enumerate(
        (
            head + display,
            head + other,
            f'{head}    - Class: "foo\n {text} [ {{',
            f"{head}{text}: [",
            f"? a{text}",
        )
    ):
        path = save(folder / f"{number}.rviz", config)
        yield ["config", path]
        yield ["config", path, "--format", "json"]


@place
def joint_states(folder: Path, text: str) -> Iterator[Words]:
    model = save(folder / "r.urdf", joined("", '"a"'))
    coded = "".join(f"\\u{ord(c):04x}" for c in text)
    for number, state in enumerate(
        (
            f'name: ["x{coded}"]\nposition: [1.0]\n',
            f'name: ["x{coded}"]\nposition: ["{coded}"]\n',
            f"name: [{text}\nposition",
        )
    ):
        path = save(folder / f"{number}.yaml", state)
        yield ["frames", model, "--joint-state", path]


def write_hostile_bag(path: Path, text: str) -> Path:
    """Write an mcap file with the text in its names, its messages and its robot."""
    store = store_of_all()
    said = store.types["std_msgs/msg/String"]
    text = "".join(c for c in text if not 0xD800 <= ord(c) < 0xE000)
    name = "".join(c for c in text if c >= " ")
    frames: Mapping[str, str] = {f"f{text}": "base", f"a{text}": f"f{text}"}
    robot = joined("<link name='twice'/><link name='twice'/>", f'"a{name}"')
    now = START * 10**9
    return write_messages(
        path,
        [
            (
                "/tf",
                "tf2_msgs/msg/TFMessage",
                now,
                transforms_message(store, 0.0, frames),
            ),
            (f"/t{text}", "std_msgs/msg/String", now, said(f"hi{text}")),
            ("/robot_description", "std_msgs/msg/String", now, said(robot)),
        ],
        {f"/empty{text}": "sensor_msgs/msg/Image"},
    )
