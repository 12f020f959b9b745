"""The Joints panel, and the named poses."""
