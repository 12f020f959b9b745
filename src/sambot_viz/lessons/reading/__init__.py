"""Files of YAML, read strictly: each value has a kind, and a fault has a place."""
