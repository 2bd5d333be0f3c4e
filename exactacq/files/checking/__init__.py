"""What a file shows before anything is decided: what is wrong with it, what cures that, where to start."""
