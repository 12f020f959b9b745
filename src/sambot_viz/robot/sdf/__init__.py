"""From SDF elements to links, joints and one tree, with sdformat_urdf's rules."""
