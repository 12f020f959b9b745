"""What a ray or a rectangle meets: displays answer, tools and cameras ask."""
