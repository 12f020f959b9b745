"""What runs inside the xacro child process."""
