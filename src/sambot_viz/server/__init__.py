"""The running server: its port, its browsers, and the files it follows."""
