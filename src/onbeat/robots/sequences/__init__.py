"""Dances as files that robots' controllers play."""
