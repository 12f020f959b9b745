"""From what a mesh file says to triangles that can be drawn."""
