"""The Sightseer Strategy: from obstacle to obstacle."""
