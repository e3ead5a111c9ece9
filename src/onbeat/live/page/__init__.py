"""The page of a session: its server, who is connected, and what goes over the wire."""
