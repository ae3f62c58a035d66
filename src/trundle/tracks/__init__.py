"""Measured data: tracks of bodies in the files that cameras, sensors and other programs write."""
