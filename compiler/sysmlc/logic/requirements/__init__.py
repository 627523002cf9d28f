"""What requirements assume and demand of their subjects, as contracts."""
