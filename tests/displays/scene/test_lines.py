"""Hairlines as a GLB file."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

from sambot_viz.displays.scene.lines import MOST_PIECES, in_pieces, lines_glb

LINES = np.array([[[0, 0, 0], [10, 0, 0]], [[0, 1, 0], [0, 1, 5]]], dtype=np.float32)


def test_pieces_are_short_and_cover_the_lines() -> None:
    pieces = in_pieces(LINES, 1.0)
    lengths = np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1)
    assert lengths.max() <= 1.0 + 1e-6
    assert lengths.sum() == pytest.approx(15.0)
    assert {tuple(p) for p in pieces.reshape(-1, 3).tolist()} >= {(0, 0, 0), (10, 0, 0)}


def test_a_huge_grid_does_not_become_endless() -> None:
    many = np.repeat(LINES, 5000, axis=0)
    assert len(in_pieces(many, 1e-6)) <= max(MOST_PIECES, len(many))


def test_the_file_says_what_it_holds() -> None:
    glb = lines_glb(LINES, (255, 0, 0), 0.5)
    magic, version, length = struct.unpack_from("<4sII", glb)
    assert (magic, version, length) == (b"glTF", 2, len(glb))
    size = struct.unpack_from("<I", glb, 12)[0]
    document = json.loads(glb[20 : 20 + size])
    material = document["materials"][0]
    assert material["alphaMode"] == "BLEND"
    assert material["pbrMetallicRoughness"]["baseColorFactor"] == [1.0, 0.0, 0.0, 0.5]
    assert document["accessors"][0]["count"] == 4
    assert np.frombuffer(glb[28 + size :], dtype="<f4").size == 12


def test_an_opaque_line_writes_depth() -> None:
    assert b'"OPAQUE"' in lines_glb(LINES, (1, 2, 3), 1.0)
