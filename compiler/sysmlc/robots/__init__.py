"""Robots on a floor of cells: contracts, controllers and missions (MOOD4I thesis, chapter 4)."""
