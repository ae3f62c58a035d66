"""One printer a target: how it writes the routines that `fields.routines` traced, and a module of them."""
