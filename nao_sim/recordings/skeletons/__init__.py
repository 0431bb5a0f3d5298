"""How points in a file become a person: layouts, units, axes, sides and times."""
