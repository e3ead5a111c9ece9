"""From what is heard to beats to dance on: trusted, counted in bars, folded to a tempo to dance to."""
