"""Putting a dance together: the search for the path that fits the music, and the motion made from it."""
