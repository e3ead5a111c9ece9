"""TRC: marker positions as a table of text."""
