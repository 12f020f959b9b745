"""The RViz displays: one per file, each with its properties and its drawing."""
