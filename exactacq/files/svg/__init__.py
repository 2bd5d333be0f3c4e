"""Scenes from SVG drawings."""
