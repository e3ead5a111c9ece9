"""Harmony: chords and their changes, keys, tones."""
