"""Rules about parameter files and the parameters of well-known nodes."""
