"""The links of a reference that differ from the robot, drawn as a ghost."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import viser

from sambot_viz.displays.robot_model.shape_nodes import ShapeNode
from sambot_viz.displays.robot_model.shape_solids import ShapeLook
from sambot_viz.displays.scene.frame_nodes import any_gone, position_of, remove_all
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Matrix, Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.robot.ghost_links import GhostLink
from sambot_viz.robot.joint_tree import free_positions
from sambot_viz.robot.model import Robot, asset_of
from sambot_viz.robot.parts import Box, Capsule, Cylinder, MeshFile, Shape, Sphere
from sambot_viz.session.scene.scene import Scene
from sambot_viz.viser_private import set_poses

COLOR: Rgb = (255, 64, 200)
_SMALLER = 0.998

_Pose = tuple[Wxyz, Vector3]


class ReferenceGhost:
    """Draws the ghost below the nodes of the robot's links, so that it moves with them.

    Not thread-safe: the session holds the lock, and sends the drawing.

    Args:
        scene: the scene to draw in.
        given: returns the positions of the robot's joints [rad or m].
    """

    def __init__(self, scene: Scene, given: Callable[[], Mapping[str, float]]) -> None:
        self._context = scene.context
        self._given = given
        self._reference: Robot | None = None
        self._links: Sequence[GhostLink] = ()
        self._nodes: dict[str, viser.FrameHandle] = {}
        self._poses: dict[str, _Pose] = {}
        self._shapes: dict[tuple[str, int], ShapeNode] = {}
        # Those that joints move by themselves, by the joint, and where the joints were.
        self._moving: dict[str, GhostLink] = {}
        self._drawn_at: dict[str, float] = {}

    def take(self, reference: Robot | None, links: Sequence[GhostLink]) -> None:
        """Take other links; `draw` draws them."""
        self._reference, self._links = reference, links
        self._moving = {
            joint.name: each
            for each in links
            if (joint := each.joint) is not None and joint.movable
        }

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to draw, and nothing drawn."""
        return not (self._links or self._nodes)

    @property
    def is_still(self) -> bool:
        """Whether it only moves with the links that it hangs below."""
        return not self._moving

    def path(self, link: str) -> str | None:
        """Return the name of the node of a link; None where none is drawn."""
        node = self._nodes.get(link)
        return None if node is None else node.name

    def draw(self, alpha: float) -> None:
        """Add missing parts and update others; with 0 draw nothing."""
        reference = self._reference if alpha > 0.0 else None
        links = () if reference is None else self._links
        wanted = {each.link.name for each in links}
        for name in self._nodes.keys() - wanted:
            self._remove(name)
        if reference is None:
            return
        order = {name: number for number, name in enumerate(reference.links)}
        positions = self._drawn_at = self._positions(reference)
        for each in links:
            name = each.link.name
            above = self._above(each)
            if above is None:
                self._remove(name)
                continue
            self._hang(name, f"{above}/~r{order[name]}")
            self._place(each, reference, positions)
            self._draw_shapes(each, reference, alpha)

    def move(self) -> None:
        """Follow the joints; nothing is sent for links that have not moved."""
        if self._reference is None or not self._nodes:
            return
        before, positions = self._drawn_at, self._positions(self._reference)
        for joint, each in self._moving.items():
            if positions[joint] != before.get(joint) and each.link.name in self._nodes:
                self._place(each, self._reference, positions)
        self._drawn_at = positions

    def _positions(self, reference: Robot) -> dict[str, float]:
        given = free_positions(reference, self._given())
        return reference.kinematics.positions(given)

    def _above(self, each: GhostLink) -> str | None:
        if each.of_ghost:
            return self.path(each.above)
        frame = self._context.only_meant(plain_name(each.above))
        return self._context.nodes.path(frame)

    def _hang(self, link: str, path: str) -> None:
        """Make the node of a link, unless it is there."""
        known = self._nodes.get(link)
        if known is not None and known.name == path and not any_gone((known,)):
            return
        self._remove(link)
        self._nodes[link] = self._context.scene.add_frame(path, show_axes=False)

    def _place(
        self, each: GhostLink, reference: Robot, positions: dict[str, float]
    ) -> None:
        name, joint = each.link.name, each.joint
        pose = _pose(
            each.T_above_link
            if joint is None
            else reference.kinematics.joint_transform(joint.name, positions[joint.name])
        )
        if self._poses.get(name) != pose:
            self._poses[name] = pose
            set_poses([(self._nodes[name], *pose)])

    def _draw_shapes(self, each: GhostLink, reference: Robot, alpha: float) -> None:
        link, node = each.link, self._nodes[each.link.name]
        shapes = [_plain(shape) for shape in link.visuals] if each.drawn else []
        look = ShapeLook(visible=True, alpha=alpha, color=COLOR)
        for number, shape in enumerate(shapes):
            asset = asset_of(shape, reference.file_roots)
            known = self._shapes.get((link.name, number))
            if known is None or known.gone or not known.shows(shape, asset):
                if known is not None:
                    known.remove()
                known = ShapeNode(
                    self._context.scene,
                    f"{node.name}/~r_v{number}",
                    shape,
                    asset,
                    self._context.assets,
                )
                self._shapes[link.name, number] = known
            known.draw(look)
        for key in [k for k in self._shapes if k[0] == link.name]:
            if key[1] >= len(shapes):
                self._shapes.pop(key).remove()

    def _remove(self, link: str) -> None:
        for key in [key for key in self._shapes if key[0] == link]:
            self._shapes.pop(key).remove()
        self._poses.pop(link, None)
        node = self._nodes.pop(link, None)
        if node is not None:
            remove_all((node,))


def _plain(shape: Shape) -> Shape:
    """Return a shape for the ghost, which has one colour, slightly smaller.

    Faces of both in one plane would flicker: so those of the robot are in front.
    """
    geometry = shape.geometry
    match geometry:
        case Box((x, y, z)):
            geometry = Box((x * _SMALLER, y * _SMALLER, z * _SMALLER))
        case Sphere(radius):
            geometry = Sphere(radius * _SMALLER)
        case Cylinder(radius, length) | Capsule(radius, length):
            kind = type(geometry)
            geometry = kind(radius * _SMALLER, length * _SMALLER)
        case MeshFile():
            # Its origin may be far outside of it.
            pass
    return replace(shape, geometry=geometry, material=None)


def _pose(T: Matrix) -> _Pose:
    return wxyz_from_matrix(T), position_of(T)
