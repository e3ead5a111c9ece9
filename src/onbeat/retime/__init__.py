"""Faster or slower music, the same dance, inside a body's limits."""
