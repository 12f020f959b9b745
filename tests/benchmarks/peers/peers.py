"""The programs that are measured beside this one, and those that cannot be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

DRIVERS = Path(__file__).with_name("drivers")


@dataclass(frozen=True, slots=True)
class Viewer:
    """A viewer of robots.

    Attributes:
        name: as its makers write it.
        packages: of PyPI, for its environment.
        driver: the program in `drivers` that shows a robot with it.
        modules: packages of npm.
        version_of: the package whose version is told.
        websocket: a raw client can take part, so that bytes and delays are measured
            without a browser; its path is in `socket_path`.
        socket_path: of the websocket that pictures come through.
        note: what a reader of the table must know.
        debian: programs that Debian's packages bring; it then has a window and no page.
    """

    name: str
    packages: tuple[str, ...]
    driver: str
    modules: tuple[str, ...] = ()
    version_of: str = ""
    websocket: bool = False
    socket_path: str = "/"
    note: str = ""
    debian: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Its name on the command line, and that of its environment."""
        return self.driver.partition("_")[0] if self.is_ours else self.driver

    @property
    def is_ours(self) -> bool:
        """Whether it is this program."""
        return self.driver == "this_program"


@dataclass(frozen=True, slots=True)
class Checker:
    """A program that says what is wrong with a model.

    Attributes:
        name: of the program.
        packages: of PyPI.
        command: the words before the model; the first is a program of its environment.
        debian: the package of Debian that brings it, in place of PyPI's.
    """

    name: str
    packages: tuple[str, ...]
    command: tuple[str, ...]
    debian: str = ""


OURS = Viewer("sambot-viz", (), "this_program", version_of="sambot-viz", websocket=True)
VISER_URDF = Viewer(
    "viser ViserUrdf",
    ("viser", "yourdfpy"),
    "viser_urdf",
    version_of="viser",
    websocket=True,
)
VIEWERS = (
    OURS,
    VISER_URDF,
    Viewer(
        "viewurdf",
        ("viewurdf",),
        "viewurdf_program",
        version_of="viewurdf",
        websocket=True,
        note="moves its hidden skeleton, too, once for every slider",
    ),
    Viewer(
        "mjviser",
        ("mjviser",),
        "mjviser_scene",
        version_of="mjviser",
        websocket=True,
        note="MuJoCo refuses links without mass; shown without a simulation",
    ),
    Viewer(
        "MeshCat + Pinocchio",
        ("meshcat", "pin"),
        "meshcat_pinocchio",
        version_of="meshcat",
        websocket=True,
    ),
    Viewer(
        "Drake ModelVisualizer",
        ("drake",),
        "drake_visualizer",
        version_of="drake",
        websocket=True,
        note="refuses joints without inertia",
    ),
    Viewer(
        "rerun web viewer",
        ("rerun-sdk",),
        "rerun_web",
        version_of="rerun-sdk",
        note="gRPC, so only browsers can take part; the page computes the links' poses",
    ),
    Viewer(
        "RViz (ROS 1)",
        (),
        "rviz_window",
        debian=("rviz", "robot_state_publisher"),
        note="on a virtual screen, drawn by the processor as Chromium's pages",
    ),
    Viewer(
        "jupyterlab-urdf",
        ("jupyterlab", "jupyterlab-urdf"),
        "jupyterlab_urdf_page",
        version_of="jupyterlab-urdf",
    ),
    Viewer(
        "urdf-loader (npm)",
        (),
        "urdf_loader_page",
        modules=("urdf-loader", "three"),
        version_of="urdf-loader",
        note="a library; in the smallest page of our own, which moves the robot itself",
    ),
)
CHECKERS = (
    Checker("sambot-viz check", (), ("-m", "sambot_viz", "check")),
    Checker("urdf-validator", ("urdf-validator",), ("urdf_validate",)),
    Checker(
        "isaaclab-robot-doctor",
        ("isaaclab-robot-doctor",),
        ("isaaclab-robot-doctor", "check"),
    ),
    Checker("check_urdf (urdfdom)", (), ("check_urdf",), "liburdfdom-tools"),
)
CANNOT_RUN = {
    "RViz 2": "needs an installed ROS 2, which neither pip, npm nor Debian brings",
    "rviz-web": "needs a ROS 2 bridge beside it",
    "Lichtblick": "a desktop program or a container's page; no package of pip or npm",
    "urdf-viz": "needs a screen with OpenGL, and Rust to build it",
}
"""Known, and not measured, with the reason."""
