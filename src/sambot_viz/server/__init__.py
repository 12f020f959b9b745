"""The running server: its port, its browsers, and following the files."""
