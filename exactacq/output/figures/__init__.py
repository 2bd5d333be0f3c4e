"""Figures of scenes and runs."""

from exactacq.output.figures.draw import figure, save, save_side_by_side, svg

__all__ = ["figure", "save", "save_side_by_side", "svg"]
