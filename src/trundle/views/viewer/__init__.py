"""A run to be looked at: in a notebook, as a page of its own, as a model for other programs, as a picture."""
