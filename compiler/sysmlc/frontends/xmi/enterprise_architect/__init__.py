"""Content of the extension elements that Enterprise Architect writes."""
