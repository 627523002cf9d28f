"""Controllers: strategies taken from won games, their machines and tables, and the check of both."""
