"""Temporal logic as GR(1), with history bits for what games have no other words for."""
