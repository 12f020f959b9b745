"""From URDF elements to links, joints and one tree, with urdfdom's rules."""
