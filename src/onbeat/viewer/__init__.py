"""Showing a dance: one page for the browser, video, pictures."""
