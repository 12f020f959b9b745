"""A link that shows the same in another browser."""
