"""Robots that dance live: dances prepared, gone over into each other, simulated."""
