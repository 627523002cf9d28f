"""Strategies of won games, their controllers (machines and tables), and verification of these."""
