"""Exact numbers and lengths: how they are decided, printed and written."""
