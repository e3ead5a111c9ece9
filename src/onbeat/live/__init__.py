"""The sound feedback system: hear music as it happens, follow it, move."""
