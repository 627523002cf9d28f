"""Services: operations and actions by what they need before and promise after."""
