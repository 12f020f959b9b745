"""What sources over a websocket share: the connection, and what comes over it."""
