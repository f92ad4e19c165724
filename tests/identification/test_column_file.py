"""Files of other programs: separators, names, units, comments; what cannot be read is refused in words."""

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.errors import RecordingError
from ir50p_lab.identification import fit_joint, read_columns

T = np.arange(400) * 0.01
Q = np.sin(2 * T) + 0.3 * np.sin(5 * T)
V, A = 2 * np.cos(2 * T) + 1.5 * np.cos(5 * T), -4 * np.sin(2 * T) - 7.5 * np.sin(5 * T)
U = 0.5 * A + 2 * V + 0.6 * np.sign(V) + 0.1


def table(*columns, separator=",", form="%.8g", comma="."):
    rows = (separator.join(form % x for x in row).replace(".", comma) for row in zip(*columns, strict=True))
    return "\n".join(rows) + "\n"


FILES = {
    "plain": "t,q,u\n" + table(T, Q, U),
    "spaces, savetxt header": "# t q u\n" + table(T, Q, U, separator=" "),
    "tabs, microseconds, degrees": "time_us\tpos_deg\tcurrent\n" + table(1e6 * T, np.degrees(Q), U, separator="\t"),
    "Excel, German": "Zeit;t;q;u\n" + table(T + 99, T, Q, U, separator=";", comma=","),
    "units below": "time,angle,torque\n[ms],[deg],[Nm]\n" + table(1e3 * T, np.degrees(Q), U),
    "units in brackets": '"Time [ms]","Position (mrad)","Torque [Nm]"\n' + table(1e3 * T, 1e3 * Q, U),
    "preamble": "Robot log, v1.2\nserial 0815\nt,q,u\n" + table(T, Q, U),
    "extra columns": "n,t,temp,q,qd,u,note\n" + table(T, T, T, Q, V, U, T),
    "comments between": "% made by hand\nt,q,u\n# begin\n" + table(T, Q, U) + "# end\n",
    "stamps": "timestamp, position, pwm\r\n" + table(1.7e9 + T, Q, U, form="%.4f").replace("\n", "\r\n"),
}


@pytest.mark.parametrize("text", FILES.values(), ids=FILES)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_a_table_is_read_whoever_wrote_it(tmp_path, text, encoding):
    path = tmp_path / "log.csv"
    path.write_bytes(text.encode(encoding))
    found = read_columns(path)
    assert np.allclose(found.t - found.t[0], T, atol=2e-4) and np.allclose(found.q[:, 0], Q, atol=1e-4)
    assert np.allclose(found.u[:, 0], U, atol=1e-3)
    assert fit_joint(found).inertia == pytest.approx(0.5, rel=0.05)


def test_what_is_asked_for_is_taken(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(table(1e3 * T, np.degrees(Q), U))  # no names
    by_number = read_columns(path, t=0, q=1, u=2, time_unit="ms", angle_unit="deg")
    assert np.allclose(by_number.t, T) and np.allclose(by_number.q[:, 0], Q, atol=1e-6)
    path.write_text("t,a_deg,b_deg,x,y\n" + table(T, np.degrees(Q), np.degrees(V), U, -U))
    two = read_columns(path, q=("a_deg", "B_DEG"), u=("x", "y"))
    assert np.allclose(two.q, np.column_stack([Q, V]), atol=1e-5) and two.u.shape == (400, 2)
    assert "q from 'a_deg' in deg" in two.notes


def test_our_own_recordings_too(tmp_path):
    with SimulatedBench(record_to=tmp_path) as bench:
        for _ in bench.run(0.5):
            bench.drive([10, 0, 0])
    found = read_columns(next(tmp_path.glob("*.csv")))
    assert np.allclose(found.q, bench.recording.q, atol=1e-6) and np.allclose(found.u, bench.recording.u)


@pytest.mark.parametrize("lost", [1, 20, 200])
def test_empty_cells_are_no_numbers_and_lines_of_text_are_counted(tmp_path, lost):
    lines = FILES["plain"].splitlines()
    lines[5 : 5 + lost] = ["0.05,,1"] * lost
    lines.insert(300, "restarted")
    (tmp_path / "log.csv").write_text("\n".join(lines))
    found = read_columns(tmp_path / "log.csv")
    assert np.isnan(found.q).sum() == lost and len(found.t) == 400 and "1 line(s)" in found.notes[-1]


BAD = [
    ("", {}, "no line of numbers"),
    ("only words\nand more\n", {}, "no line of numbers"),
    ("a,b,c\n1,2,3\n", {}, "none is called t"),
    ("1,2,3\n4,5,6\n", {}, "none is called t"),
    (FILES["plain"], {"q": "angle"}, "q = 'angle'"),
    (FILES["plain"], {"u": 7}, "u = 7"),
    (FILES["plain"], {"u": True}, "u = True"),
    (FILES["plain"], {"q": ("q", "q")}, "one u for each q"),
    (FILES["plain"], {"time_unit": "hours"}, "time_unit"),
    (FILES["plain"], {"angle_unit": "gon"}, "angle_unit"),
    ("\0\1\2\0", {}, "no line of numbers"),
]


@pytest.mark.parametrize("text, options, words", BAD)
def test_refusals(tmp_path, text, options, words):
    path = tmp_path / "log.csv"
    path.write_text(text)
    with pytest.raises(RecordingError, match=words):
        read_columns(path, **options)


@pytest.mark.parametrize("path", ["no_such_file.csv", "/", None, 3.5, 1, True, "a\0b", object()])
def test_no_file(path):
    with pytest.raises(RecordingError, match="cannot read"):
        read_columns(path)
