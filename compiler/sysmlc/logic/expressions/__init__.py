"""The one expression grammar of guards, effects and constraints, and what it means."""
