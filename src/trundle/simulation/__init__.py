"""Runs: from a system or a scenario to a trajectory, its labelled arrays and its file."""
