"""Models that the standards allow, drawn at random or written by hand: none has an error."""
