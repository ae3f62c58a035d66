"""Scenarios that nobody thought of, run as a user runs them, to see which end badly: `python -m tests.fuzz --help`."""
