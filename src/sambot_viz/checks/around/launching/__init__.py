"""Launch files in Python, XML and YAML, read into one form."""
