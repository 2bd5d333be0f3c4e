"""The strategies of the paper, their runs and bounds."""
