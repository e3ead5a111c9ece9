"""Making a library: clips from recordings, twins sorted out, joins, a new generation published."""
