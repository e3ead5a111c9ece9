"""The user study of keyposes, ready to be run with people: its plans, page, server, answers and figures."""
