"""A recording that is still made, followed over a web server."""
