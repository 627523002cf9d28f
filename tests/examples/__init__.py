"""Tests of the models in the folder ``examples``."""
