"""Loops out of loose lines and arcs: what all readers of drawings share."""
