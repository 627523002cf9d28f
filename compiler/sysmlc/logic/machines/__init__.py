"""State machines: read, checked, stepped, and derived to contracts."""
