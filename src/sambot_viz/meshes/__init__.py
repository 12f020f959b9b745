"""Mesh files → triangles, colours and textures → GLB; nothing here knows robots.

`read_mesh.read_mesh` reads one file, `cache.MeshCache` keeps what was read, and
`glb.to_glb` writes what a browser is sent.
"""
