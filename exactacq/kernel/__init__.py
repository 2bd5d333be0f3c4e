"""Geometry in floats with proven error bounds."""
