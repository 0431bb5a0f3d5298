"""A NAO's joint angles: one file a format, and what writes them."""
