"""Three-level recipe models: values, derived data, and checks."""
