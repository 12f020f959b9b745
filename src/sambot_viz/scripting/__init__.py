"""What a program asks of the sessions: camera, displays, links, events."""
