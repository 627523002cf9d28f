"""Counter-strategies: how the environment wins the game of an unrealizable contract."""
