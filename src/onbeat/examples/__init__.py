"""The embedded default: a procedural troupe and a procedural song, with ground truth."""
