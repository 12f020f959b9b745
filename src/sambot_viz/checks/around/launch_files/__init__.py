"""Rules about launch files: Python, XML and YAML."""
