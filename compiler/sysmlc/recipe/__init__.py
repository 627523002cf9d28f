"""Three-level recipe models: values, what follows from them, and what can be wrong with them."""
