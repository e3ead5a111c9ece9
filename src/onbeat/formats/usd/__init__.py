"""Universal Scene Description (USD), written."""
