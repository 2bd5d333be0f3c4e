"""The page that plays a run."""
