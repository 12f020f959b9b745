"""The Python interface to the sessions: camera, displays, links, events."""
