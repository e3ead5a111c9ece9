"""The studio: a local web app in which songs and motion files become dances, looked at, corrected, and exported."""
