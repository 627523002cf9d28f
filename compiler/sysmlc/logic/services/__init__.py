"""Services: operations and actions with preconditions and postconditions."""
