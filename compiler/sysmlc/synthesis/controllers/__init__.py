"""Controllers: strategies taken from won games, machines and tables of them, and their check."""
