"""Who chooses what is danced next: given choreographies, or the best way through a motion graph."""
