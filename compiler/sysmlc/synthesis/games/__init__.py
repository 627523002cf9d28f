"""GR(1) games: their turns, the encodings that make them small, and the solver."""
