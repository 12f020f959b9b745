"""Show what one server shows on others, which know nothing but how to pass it on."""
