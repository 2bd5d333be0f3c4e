"""The world: shapes, the rules for them, boundaries, terrains, and the table of all edges."""
