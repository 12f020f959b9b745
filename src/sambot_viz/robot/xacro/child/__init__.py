"""The modules of the xacro child process."""
