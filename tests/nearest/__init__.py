"""The tests nearest to what has changed, for daily work: `make check`, or `python -m tests.nearest`."""
