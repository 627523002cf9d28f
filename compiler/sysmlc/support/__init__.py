"""Small helpers without a subject of their own: file names, escapes, suggestions, resources."""
