"""dance."""
