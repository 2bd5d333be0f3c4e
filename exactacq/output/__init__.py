"""Run files, reports and pictures."""
