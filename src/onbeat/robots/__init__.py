"""Humanoid robots that dance: their models, retargeting, legs, balance, simulation and export."""
