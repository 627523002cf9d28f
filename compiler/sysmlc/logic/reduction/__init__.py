"""Reduction of temporal logic to GR(1) with history bits."""
