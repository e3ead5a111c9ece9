"""How good a dance is: on the beat, with the music's intensity, on its feet, smooth and varied.

Each module is its own specification, ``validate()``, the metrics as functions of arrays, and ``evaluate()``, which
gives a dictionary of names and numbers, None where a number cannot be had.
"""
