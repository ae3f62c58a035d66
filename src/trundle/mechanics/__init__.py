"""The physics, written once, generic over its scalars (theory page). It knows nothing of solvers, files or pictures."""
