"""The RViz tools: one per file."""
