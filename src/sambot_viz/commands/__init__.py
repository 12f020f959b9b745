"""The commands of the command line: one per file, with ``run(words) -> exit code``."""
