"""One adapter an engine: a small program that runs in the engine's own environment, started with `python -m`."""
