"""Keep the connections of clients: their limits, and how fast each reads."""
