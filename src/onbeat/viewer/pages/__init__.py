"""Pages that need nothing but themselves: a dance, its keyposes, a robot, a pupil, a live session, a jury."""
