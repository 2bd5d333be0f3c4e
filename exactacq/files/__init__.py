"""Scenes from files and to files, the gallery, and scenes at random."""
