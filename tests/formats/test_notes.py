from onbeat.formats.notes import Note, noted, tell


def test_notes_go_to_who_listens_and_nowhere_else():
    tell("unit", "cm", "nobody hears")
    with noted() as outer:
        tell("up", "z", "first")
        with noted() as inner:
            tell("fps", 30, "second")
        tell("unit", "m", "third")
    assert outer == [Note("up", "z", "first"), Note("unit", "m", "third")]
    assert inner == [Note("fps", "30", "second")]
