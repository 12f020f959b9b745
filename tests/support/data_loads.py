"""Data that are large or fast: from a robot on the network, and by viser alone.

    python tests/support/data_loads.py robot            # prints its address
    python tests/support/data_loads.py viser clouds     # prints the address of the page

Each line on the standard input begins to send: the robot wants ``SECONDS LOAD…``, viser
``SECONDS``. When it is through, it prints "said".
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

POINTS, CELLS, PATCH, MARKERS, POSES = 100_000, 4_000, 100, 1_000, 10_000
WIDTH, HEIGHT = 640, 480
VARIANTS = 5
"""So many messages of each kind are made before, and sent in turn."""
UPDATE = """std_msgs/Header header
int32 x
int32 y
uint32 width
uint32 height
int8[] data
"""
"""The definition of map_msgs/OccupancyGridUpdate, which rosbags lacks."""
CONFIG = """
Visualization Manager:
  Global Options: {{Fixed Frame: map, Frame Rate: 30}}
  Displays:
{displays}
"""


@dataclass(frozen=True)
class Load:
    """One kind of data.

    Attributes:
        name: of it.
        kind: of its messages.
        display: RViz's name of the class that draws it.
        rate: messages in a second; 0 for one at the start.
        make: a message of a number.
        show: shows one of a number with viser, as the shortest script does.
    """

    name: str
    kind: str
    display: str
    rate: float
    make: Callable[[Any, int], Any]
    show: Callable[[Any, int], Callable[[int], object]]

    @property
    def topic(self) -> str:
        return f"/{self.name}"

    def entry(self) -> str:
        """The display in a config."""
        return (
            f"    - {{Class: rviz_default_plugins/{self.display}, Name: {self.name}, "
            f"Enabled: true, Topic: {{Value: {self.topic}}}}}"
        )


def header(store: Any) -> Any:
    stamp = store.types["builtin_interfaces/msg/Time"](0, 0)
    return store.types["std_msgs/msg/Header"](stamp, "map")


def pose(store: Any, x: float, y: float, z: float = 0.0) -> Any:
    types = store.types
    return types["geometry_msgs/msg/Pose"](
        types["geometry_msgs/msg/Point"](x, y, z),
        types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
    )


def points_of(number: int) -> np.ndarray[Any, Any]:
    """The points of a scanner on the walls of a hall, (N, 3) float32."""
    rng = np.random.default_rng(number)
    angle = rng.uniform(-np.pi, np.pi, POINTS)
    far = 8.0 + rng.normal(0.0, 0.02, POINTS)
    up = rng.uniform(0.0, 3.0, POINTS)
    columns = (far * np.cos(angle), far * np.sin(angle), up)
    return np.column_stack(columns).astype(np.float32)


def cloud(store: Any, number: int) -> Any:
    field = store.types["sensor_msgs/msg/PointField"]
    rows = np.zeros((POINTS, 4), np.float32)
    rows[:, :3] = points_of(number)
    rows[:, 3] = rows[:, 2]
    return store.types["sensor_msgs/msg/PointCloud2"](
        header(store),
        1,
        POINTS,
        [
            field(name, 4 * n, 7, 1)
            for n, name in enumerate(("x", "y", "z", "intensity"))
        ],
        False,
        16,
        16 * POINTS,
        rows.view(np.uint8).reshape(-1),
        True,
    )


def show_cloud(server: Any, _: int) -> Callable[[int], object]:
    colors = np.full((POINTS, 3), 200, np.uint8)
    clouds = [points_of(number) for number in range(VARIANTS)]
    return lambda n: server.scene.add_point_cloud(
        "/cloud", clouds[n % VARIANTS], colors, point_size=0.01
    )


def cells_of(number: int) -> np.ndarray[Any, Any]:
    """Rooms and corridors, (CELLS, CELLS) int8."""
    cells = np.full((CELLS, CELLS), -1, np.int8)
    cells[200:-200, 200:-200] = 0
    cells[200:-200:150, 200:-200] = 100
    cells[200:-200, 200 + number : -200 : 210] = 100
    clutter = np.random.default_rng(number).random(cells.shape, np.float32) < 0.005
    cells[clutter] = 100
    return cells


def grid(store: Any, number: int) -> Any:
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    about = types["nav_msgs/msg/MapMetaData"](
        stamp, 0.05, CELLS, CELLS, pose(store, -100.0, -100.0)
    )
    cells = cells_of(number).reshape(-1)
    return types["nav_msgs/msg/OccupancyGrid"](header(store), about, cells)


def update(store: Any, number: int) -> Any:
    """A square of the map in the middle of it."""
    at = CELLS // 2 + 10 * number
    cells = np.full(PATCH * PATCH, 10 * number, np.int8)
    kind = store.types["map_msgs/msg/OccupancyGridUpdate"]
    return kind(header(store), at, at, PATCH, PATCH, cells)


def show_map(server: Any, _: int) -> Callable[[int], object]:
    def show(number: int) -> None:
        grey = 255 - 2 * cells_of(number % VARIANTS).astype(np.uint8)
        server.scene.add_image("/map", np.dstack([grey] * 3), 200.0, 200.0)

    return show


def markers(store: Any, number: int) -> Any:
    types = store.types
    marker, vector = (
        types["visualization_msgs/msg/Marker"],
        types["geometry_msgs/msg/Vector3"],
    )
    color, duration = (
        types["std_msgs/msg/ColorRGBA"],
        types["builtin_interfaces/msg/Duration"],
    )
    compressed = types["sensor_msgs/msg/CompressedImage"](
        header(store), "", np.zeros(0, np.uint8)
    )
    mesh = types["visualization_msgs/msg/MeshFile"]("", np.zeros(0, np.uint8))
    rows = [
        marker(
            header(store),
            "cubes",
            n,
            1,
            0,
            pose(store, n % 40 * 0.5, n // 40 * 0.5, 0.1 * (number % VARIANTS)),
            vector(0.2, 0.2, 0.2),
            color(0.2, 0.7, 0.3, 1.0),
            duration(0, 0),
            False,
            [],
            [],
            "",
            compressed,
            [],
            "",
            "",
            mesh,
            False,
        )
        for n in range(MARKERS)
    ]
    return types["visualization_msgs/msg/MarkerArray"](rows)


def show_markers(server: Any, _: int) -> Callable[[int], object]:
    boxes = [
        server.scene.add_box(
            f"/m/{n}",
            (50, 180, 80),
            (0.2, 0.2, 0.2),
            position=(n % 40 * 0.5, n // 40 * 0.5, 0.0),
        )
        for n in range(MARKERS)
    ]

    def show(number: int) -> None:
        for n, box in enumerate(boxes):
            box.position = (n % 40 * 0.5, n // 40 * 0.5, 0.1 * (number % VARIANTS))

    return show


def line_of(number: int) -> np.ndarray[Any, Any]:
    along = np.linspace(0.0, 60.0, POSES)
    return np.column_stack([along, np.sin(along + 0.1 * number), 0.0 * along])


def path(store: Any, number: int) -> Any:
    stamped, head = store.types["geometry_msgs/msg/PoseStamped"], header(store)
    rows = [stamped(head, pose(store, *row)) for row in line_of(number).tolist()]
    return store.types["nav_msgs/msg/Path"](head, rows)


def show_path(server: Any, _: int) -> Callable[[int], object]:
    def show(number: int) -> None:
        line = line_of(number % VARIANTS).astype(np.float32)
        server.scene.add_line_segments(
            "/path", np.stack([line[:-1], line[1:]], axis=1), (25, 255, 0)
        )

    return show


def pixels_of(number: int) -> np.ndarray[Any, Any]:
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    return np.dstack([x % 256, y % 256, (x + y + 40 * number) % 256]).astype(np.uint8)


def image(store: Any, number: int) -> Any:
    kind = store.types["sensor_msgs/msg/Image"]
    pixels = pixels_of(number).reshape(-1)
    return kind(header(store), HEIGHT, WIDTH, "rgb8", 0, 3 * WIDTH, pixels)


def show_image(server: Any, _: int) -> Callable[[int], object]:
    shown = server.gui.add_image(pixels_of(0), format="jpeg")

    def show(number: int) -> None:
        shown.image = pixels_of(number % VARIANTS)

    return show


LOADS: dict[str, Load] = {
    load.name: load
    for load in (
        Load(
            "cloud", "sensor_msgs/msg/PointCloud2", "PointCloud2", 10, cloud, show_cloud
        ),
        Load("map", "nav_msgs/msg/OccupancyGrid", "Map", 0, grid, show_map),
        Load(
            "map_updates", "map_msgs/msg/OccupancyGridUpdate", "", 2, update, show_map
        ),
        Load(
            "markers",
            "visualization_msgs/msg/MarkerArray",
            "MarkerArray",
            10,
            markers,
            show_markers,
        ),
        Load("path", "nav_msgs/msg/Path", "Path", 2, path, show_path),
        Load("image", "sensor_msgs/msg/Image", "Image", 15, image, show_image),
    )
}


def config_of(names: Sequence[str]) -> str:
    """A config that shows some loads."""
    shown = [LOADS[name] for name in names if LOADS[name].display]
    return CONFIG.format(displays="\n".join(load.entry() for load in shown))


def at_their_rates(
    seconds: float, actions: Sequence[tuple[float, Callable[[int], object]]]
) -> None:
    """Call each action with 0, 1, …, so many times in a second; 0 is once."""
    start = time.perf_counter()
    counts = [0] * len(actions)
    while actions:
        due = [
            (count / rate if rate else 0.0 if not count else seconds)
            for count, (rate, _) in zip(counts, actions, strict=True)
        ]
        which = due.index(min(due))
        if due[which] >= seconds:
            break
        time.sleep(max(0.0, start + due[which] - time.perf_counter()))
        actions[which][1](counts[which])
        counts[which] += 1
    time.sleep(max(0.0, start + seconds - time.perf_counter()))


def robot() -> None:
    """Publish what each line of the standard input asks for."""
    import foxglove
    from live_peers import FoxglovePeer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg(UPDATE, LOADS["map_updates"].kind))
    peer = FoxglovePeer()
    channels: dict[str, foxglove.Channel] = {}
    made: dict[str, list[bytes]] = {}
    for load in LOADS.values():
        text = store.generate_msgdef(load.kind, ros_version=2)[0].encode()
        schema = foxglove.Schema(name=load.kind, encoding="ros2msg", data=text)
        channels[load.name] = foxglove.Channel(
            load.topic, schema=schema, message_encoding="cdr", context=peer.context
        )
    print(peer.uri, flush=True)
    for line in sys.stdin:
        seconds, *names = line.split()
        for name in names:
            if name not in made:
                count = VARIANTS if LOADS[name].rate else 1
                made[name] = [
                    bytes(
                        store.serialize_cdr(
                            LOADS[name].make(store, n), LOADS[name].kind
                        )
                    )
                    for n in range(count)
                ]
        print("begins", flush=True)

        actions = [
            (LOADS[name].rate, logger(channels[name], made[name])) for name in names
        ]
        at_their_rates(float(seconds), actions)
        print("said", flush=True)


def logger(channel: Any, messages: Sequence[bytes]) -> Callable[[int], object]:
    """Publish messages in turn."""
    return lambda number: channel.log(messages[number % len(messages)])


def alone(names: Sequence[str]) -> None:
    """Show loads with viser alone, with no robot in between."""
    import rich
    import viser

    rich.get_console().quiet = True
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    actions = [(LOADS[name].rate, LOADS[name].show(server, 0)) for name in names]
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    for line in sys.stdin:
        print("begins", flush=True)
        at_their_rates(float(line), actions)
        print("said", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "robot":
        robot()
    else:
        alone(sys.argv[2:])
