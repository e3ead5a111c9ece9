"""To whom a session speaks, and what others tell it: OSC, MIDI, lines of text."""
