"""Meshes: the files a model names, and the unit shapes RViz draws primitives with."""
