"""Expanding xacro with the real xacro package, in a child process."""
