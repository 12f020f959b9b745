"""Strict reading of YAML files: each value has a kind, and each fault a place."""
