"""The program of the child process that grades."""
