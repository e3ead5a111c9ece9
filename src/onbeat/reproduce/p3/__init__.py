"""P3: keyposes, how they are found, what they are good for and who dances them, 2009."""
