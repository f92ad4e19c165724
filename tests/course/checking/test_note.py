"""How the grade of an answer looks in a notebook."""

from ir50p_lab.course.checking.note import Note


def test_note_in_a_notebook():
    shown = Note("mistake", "x-1", "use `R @ v`, not <v>")._repr_html_()
    assert "<code>R @ v</code>" in shown and "&lt;v&gt;" in shown and shown.count("<div") == 1
