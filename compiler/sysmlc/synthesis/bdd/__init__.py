"""Decision diagrams: their manager, the order of their variables, numbers and names on them."""
