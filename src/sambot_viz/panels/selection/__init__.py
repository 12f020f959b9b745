"""The Selection panel of one client."""
