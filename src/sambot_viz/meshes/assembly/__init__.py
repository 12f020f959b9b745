"""From the content of a mesh file to triangles that can be drawn."""
