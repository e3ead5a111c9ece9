"""Keyposes: found, learned, used."""
