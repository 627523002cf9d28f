"""Snapshots of used projects, which MagicDraw stores in its archives."""
