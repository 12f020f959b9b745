"""One reader per mesh format."""
