"""Scenes from grids of cells: images, maps of robots, maps of games."""
