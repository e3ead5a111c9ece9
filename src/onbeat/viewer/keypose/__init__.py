"""A sheet of a dance's keyposes: rows like lines of music, and pictures of the poses."""
