"""One step relation for a component: its behaviours, what they perform and call, and its parts."""
