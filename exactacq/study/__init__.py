"""The claims of the paper as executable statements, tried on scenes."""
