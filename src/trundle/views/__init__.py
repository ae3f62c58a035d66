"""How a run is shown: figures, scenes, and the viewer that plays them."""
