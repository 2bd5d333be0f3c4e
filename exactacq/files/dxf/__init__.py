"""Scenes from DXF drawings."""
