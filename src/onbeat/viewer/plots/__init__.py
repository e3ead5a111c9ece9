"""Figures for reports: each drawn without a screen, the same bytes for the same numbers."""
