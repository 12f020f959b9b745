"""The robots of a lab, one process each: their index page."""
