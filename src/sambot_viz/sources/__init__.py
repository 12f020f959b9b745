"""Where recorded and live messages come from: bags, and robots on the network."""
