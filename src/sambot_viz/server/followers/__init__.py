"""Show the content of one server on others, which only pass it on."""
