"""The software renderer: a figure in front of a camera, the same bytes on every machine."""
