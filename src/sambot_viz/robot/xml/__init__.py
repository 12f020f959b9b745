"""A strict XML reader that knows the place of every element."""
