"""The RViz view controllers: one per file."""
