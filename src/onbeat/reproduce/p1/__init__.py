"""P1: dancing to music by rhythm and intensity, 2006."""
