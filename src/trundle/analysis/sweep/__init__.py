"""Whole families of runs: what varies, what is measured, where it is stored."""
