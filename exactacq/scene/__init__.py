"""Scenes: shapes, the rules of legal scenes, boundaries, terrains, and the table of all edges."""
