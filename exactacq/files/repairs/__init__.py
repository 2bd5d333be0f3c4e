"""Repairs that a user asks for, each with a proven bound: pure functions on rational data."""
