"""The file of a recording: what goes in comes out, and what is wrong in a file is named."""

import errno
import io
import os
import re
import threading

import matplotlib.image
import numpy as np
import pytest
from refusals import refused

from ir50p_lab.bench import recorder as recorder_module
from ir50p_lab.bench.base import Sample
from ir50p_lab.bench.recorder import Recorder
from ir50p_lab.bench.recording import Recording, RecordingWarning
from ir50p_lab.bench.recording_file import COLUMNS
from ir50p_lab.bench.simulated import SimulatedBench
from ir50p_lab.errors import RecordingError
from ir50p_lab.modelling import IR50P

HEAD = {"kind": "simulated", "bench": "simulated IR50P", "simulated": "true", "period_s": "0.01"}


def fill(recorder, n, *, first=0, reference=(1.57, 1.5, -1.05)):
    rng = np.random.default_rng(1)
    for k in range(first, first + n):
        q = np.array([0.5, 0.2, -0.3]) + 0.001 * rng.standard_normal(3)
        counts = np.array([512.0, 600.25, 234.75])
        recorder.write(Sample(0.01 * k, q, counts, k // 50), np.array([-255.0, 0.0, 12.0]), reference, k % 2 == 1)
    return recorder.recording


def same(a, b, tolerance=1e-6):
    for name in ("t", "q", "counts", "u", "reference", "gripper", "missed"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=0, atol=tolerance, err_msg=name)


def file_of(tmp_path, text):
    path = tmp_path / "other.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


# ---- what goes in comes out


@pytest.mark.parametrize("reference", [(1.57, 1.5, -1.05), None, np.array([0.1, 0.2, 0.3])])
def test_file_and_memory_agree(tmp_path, reference):
    recorder = Recorder(HEAD, tmp_path)
    live = fill(recorder, 120, reference=reference)
    recorder.close()
    loaded = Recording.load(live.path)
    assert len(loaded) == len(live) == 120 and loaded.header == live.header
    same(loaded, live)
    assert loaded.simulated and loaded.period == 0.01
    assert np.isnan(loaded.reference).all() == (reference is None)
    assert live.q.shape == live.counts.shape == live.u.shape == live.reference.shape == (120, 3)
    assert not live.q.flags.writeable


def test_a_recording_grows_with_the_run_and_is_on_disk_at_once(tmp_path):
    recorder = Recorder(HEAD, tmp_path)
    live = recorder.recording
    assert len(live) == 0 and len(Recording.load(live.path)) == 0
    for n in (1, 2, 3):
        fill(recorder, 1, first=n)
        assert len(live) == len(live.t) == n == len(Recording.load(live.path))  # not closed, not flushed
    recorder.close()
    recorder.close()


def test_the_same_rows_come_from_write_and_from_write_block(tmp_path):
    one, block = Recorder(HEAD, tmp_path), Recorder(HEAD, tmp_path)
    live = fill(one, 50)
    block.write_block(live.t, live.q, live.counts, live.u, live.reference, live.gripper, live.missed)
    without = Recorder(HEAD, tmp_path)
    without.write_block(live.t, live.q, live.counts, live.u)
    for recorder in (one, block, without):
        recorder.close()
    texts = [recorder.path.read_text().splitlines()[-50:] for recorder in (one, block)]
    assert texts[0] == texts[1]
    assert np.isnan(Recording.load(without.path).reference).all()


def test_saving_what_was_loaded_changes_nothing(tmp_path):
    recorder = Recorder({**HEAD, "note": "Größe, \\x41; α = 40°\nzweite Zeile C:\\users\\x"}, tmp_path)
    fill(recorder, 5)
    recorder.close()
    loaded = Recording.load(recorder.path)
    assert loaded.header["note"] == "Größe, \\x41; α = 40° zweite Zeile C:\\users\\x"
    again = loaded.save(tmp_path / "again.csv")
    assert again.read_bytes() == recorder.path.read_bytes()


def test_a_view_may_be_taken_while_another_thread_records():
    recorder = Recorder(HEAD, False)
    thread = threading.Thread(target=fill, args=(recorder, 3000))
    thread.start()
    seen = [0]
    while thread.is_alive():
        table = recorder.recording.q
        assert np.isfinite(table).all()
        seen.append(len(table))
    thread.join()
    assert len(recorder.recording) == 3000 and seen == sorted(seen)


# ---- where it goes


def test_names_tell_when_and_what_and_never_collide(tmp_path):
    paths = [Recorder({**HEAD, "date": "2026-11-21T10:00:00+01:00"}, tmp_path / "new" / "folder").path for _ in "123"]
    assert [path.name for path in paths] == [f"2026-11-21_100000_simulated_{k}.csv" for k in (1, 2, 3)]


def test_default_folder_and_the_environment_variable(tmp_path, monkeypatch):
    monkeypatch.delenv("IR50P_RECORDINGS", raising=False)
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "mine"))
    assert Recorder(HEAD).path.parent == tmp_path / "mine" / "recordings"
    monkeypatch.setenv("IR50P_RECORDINGS", str(tmp_path / "other"))
    assert Recorder(HEAD).path.parent == tmp_path / "other"


def test_a_folder_that_cannot_be_is_said_with_the_remedy(tmp_path):
    (tmp_path / "file").write_text("")
    said = r"cannot record in .*file.*record_to=.*IR50P_HOME"
    refused(said, Recorder, HEAD, tmp_path / "file" / "below", error=RecordingError)


# ---- a full disk


def full_after(monkeypatch, room):
    """A disk with `room` bytes left: os.write takes what fits, then refuses."""
    left, real = [room], os.write

    def write(file, data):
        if left[0] <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        taken = real(file, data[: left[0]])
        left[0] -= taken
        return taken

    monkeypatch.setattr(recorder_module.os, "write", write)


@pytest.mark.parametrize("room", [600, 650])
def test_a_full_disk_loses_nothing_that_was_recorded(tmp_path, monkeypatch, room):
    recorder = Recorder(HEAD, tmp_path)
    fill(recorder, 3)
    full_after(monkeypatch, room)
    refused(r"No space left.*safe.*Make room", fill, recorder, 100, first=3, error=RecordingError)
    loaded = Recording.load(recorder.path)  # no warning: the file ends with a whole line
    n = len(loaded)
    assert n == len(recorder.recording) - 1 and n > 3
    np.testing.assert_allclose(loaded.t, 0.01 * np.arange(n), atol=1e-9)


def test_no_room_even_for_the_head(tmp_path, monkeypatch):
    full_after(monkeypatch, 10)
    refused("No space left", Recorder, HEAD, tmp_path, error=RecordingError)


def test_a_reference_that_is_none_is_refused():
    recorder = Recorder(HEAD, False)
    for wrong in (np.zeros((3, 3)), [1.0, 2.0], 5.0, "abc"):
        refused("reference", fill, recorder, 1, reference=wrong)
    assert len(recorder.recording) == 0


# ---- files that are cut off, were saved by a spreadsheet, or are wrong

ROW = "0.5,0.2,-0.3,512,600,234,-255,0,12,1,1,1,0,0"


def ours(*rows):
    head = "# ir50p_lab recording: 1\n# period_s: 0.01\n" + ",".join(COLUMNS) + "\n"
    return head + "".join(f"{row}\n" for row in rows)


@pytest.mark.parametrize("cut", [1, 2, 29])
def test_a_cut_off_last_line_is_left_out_with_a_warning(tmp_path, cut):
    text = ours(f"0.00,{ROW}", f"0.01,{ROW}", f"0.02,{ROW}")[:-cut]
    with pytest.warns(RecordingWarning, match=r"last line \(6\) .* left out"):
        loaded = Recording.load(file_of(tmp_path, text))
    assert loaded.t.tolist() == [0.0, 0.01]


def test_zeros_at_the_end_after_a_power_cut(tmp_path):
    with pytest.warns(RecordingWarning, match="last line"):
        loaded = Recording.load(file_of(tmp_path, ours(f"0.00,{ROW}", f"0.01,{ROW}").encode()[:-5] + bytes(5)))
    assert len(loaded) == 1


def test_what_a_spreadsheet_saved_again(tmp_path):
    text = (
        '"# ir50p_lab recording: 1",,,,,,\n"# note: a, b",,,,,,\n'
        + ",".join(COLUMNS)
        + f"\n0,{ROW}\n,,,,,\n0.02,{ROW}\n"
    )
    text += '"# event: 0.015 s: kp = 2, ki = 3",,,\n,,,,\n'
    loaded = Recording.load(file_of(tmp_path, text))
    assert loaded.t.tolist() == [0.0, 0.02] and loaded.period == pytest.approx(0.02)
    np.testing.assert_allclose(loaded.q, [[0.5, 0.2, -0.3]] * 2)
    assert loaded.header == {"note": "a, b"} and loaded.events == [(0.015, "kp = 2, ki = 3")]


def saved_again(text, separator, encoding, quote=""):
    """The file as a spreadsheet with decimal commas saves it: lines of the head padded, another separator."""
    lines = []
    for line in text.splitlines():
        cells = (
            [line] if line.startswith("#") else [f"{quote}{cell.replace('.', ',')}{quote}" for cell in line.split(",")]
        )
        lines.append(separator.join(cells + [""] * (len(COLUMNS) - len(cells))))
    return ("\r\n".join(lines) + "\r\n").encode(encoding)


@pytest.mark.parametrize(("separator", "quote"), [(";", ""), (";", '"'), ("\t", ""), ("\t", '"'), (",", '"')])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_what_a_spreadsheet_with_decimal_commas_saved_again(tmp_path, separator, encoding, quote):
    run = fill(Recorder(HEAD, tmp_path), 30)
    text = (lambda path: path.read_text(encoding="utf-8"))(run.save(tmp_path / "run.csv"))
    loaded = Recording.load(file_of(tmp_path, saved_again(text, separator, encoding, quote)))
    same(run, loaded)
    assert loaded.simulated and loaded.period == run.period


def test_a_file_of_utf_16_that_was_cut_within_a_letter_is_read_as_far_as_it_goes(tmp_path):
    text = saved_again(ours(f"0,{ROW}", f"0.01,{ROW}"), "\t", "utf-16")
    with pytest.warns(RecordingWarning, match="cut off"):
        assert len(Recording.load(file_of(tmp_path, text[:-41])).t) == 1


@pytest.mark.parametrize("unit", [1e3, 1e6, 1 / 60])
def test_times_in_another_unit_than_the_head_says_are_refused(tmp_path, unit):
    for begin in (0.0, 7.0):
        rows = [f"{unit * (begin + k / 100):.7f},{ROW}" for k in range(20)]
        head = "# period_s: 0.01\n" + ",".join(COLUMNS) + "\n"
        said = rf"period_s: 0.01 in its head: .* divide it by {re.escape(f'{unit:.4g}')},"
        path = file_of(tmp_path, head + "\n".join(rows) + "\n")
        refused(said, Recording.load, path, error=RecordingError)


def test_what_is_not_known_is_an_empty_cell(tmp_path):
    loaded = Recording.load(file_of(tmp_path, f"{','.join(COLUMNS)}\n0,1,1,1{',' * 11}\n1,1,1,1{',' * 11}\n"))
    assert np.isnan(loaded.u).all() and np.isnan(loaded.counts).all() and np.isnan(loaded.missed).all()
    assert not loaded.simulated and "unknown origin" in repr(loaded)


def test_letters_beyond_ascii(tmp_path):
    head = "# bench: Küche … C:\\xy".encode()
    text = head + b"\n# event: 0.005 s: " + head[9:] + b"\n" + ",".join(COLUMNS).encode() + f"\n0,{ROW}\n".encode()
    loaded = Recording.load(file_of(tmp_path, text))
    assert loaded.header["bench"] == loaded.events[0][1] == "Küche … C:\\xy"


def test_arrays_that_do_not_fit_are_refused():
    refused("of one length", Recording.from_arrays, np.arange(3), np.zeros((4, 3)))


@pytest.mark.parametrize(
    ("t", "q", "u", "words"),
    [
        ([0, 1], [[0, 0, 0], [0, 31, 0]], 0, "sample 1: an angle of 31 rad; angles are in rad, were they degrees"),
        ([0, 1], np.zeros((2, 3)), 300, "sample 0: u = 300; PWM counts"),
    ],
)
def test_arrays_that_cannot_be_are_refused(t, q, u, words):
    refused(words, Recording.from_arrays, t, q, u=u, error=RecordingError)


def spoilt(cell):
    """A file as a spreadsheet with decimal commas saves it, an angle of its first row changed."""
    text = ours(*(f"{k / 100:.2f},0.500000,{ROW.split(',', 1)[1]}" for k in range(5)))
    return saved_again(text, ";", "utf-8").decode().replace("0,500000", cell, 1)


WRONG = [
    *((spoilt(cell), r"line 4: .* is not a number; repair") for cell in ("1.500.000", "01. Mai", "0,5 0,2")),
    (spoilt("1.234"), r"'1.234' beside decimal commas is not a number; repair"),
    (ours(f"0,0.5,{ROW.split(',', 1)[1]}", f"########,{ROW}"), "'########' is not a number; repair"),
    (ours(f"0.00,{ROW}", "0.01,0.5,0.2", f"0.02,{ROW}"), r"line 5: 3 values for 15 columns .*delete that line"),
    (ours(f"0.00,{ROW}", f"0.01,{ROW}".replace("600", "6o0"), f"0.02,{ROW}"), r"line 5: '6o0' is not a number"),
    (ours(f"0.00,{ROW}", f"0.02,{ROW}", f"0.01,{ROW}"), r"line 6: t = 0.01 s is not later"),
    (ours(f"0.00,{ROW}", f"0.01,{ROW}".replace("0.2", "")), r"line 5: t or an angle is missing"),
    (ours(f"0.00,{ROW}", f"0.01,{ROW}".replace("600", "inf")), r"line 5: a value is infinite"),
    (ours(f"0.00,{ROW}", f"0.01,{ROW}".replace("-255", "-256")), r"line 5: u = -256; PWM counts are -255..255"),
    (ours(f"0.00,{ROW}", f"0.01,{ROW}".replace("0.5", "20")), r"line 5: an angle of 20 rad; .* degrees"),
    (ours(f"0.00,{ROW}").replace("0.5", "0,5"), r"line 4: 16 values for 15 columns \(.*decimal commas"),
    ("0,1,1,1\n0.01,1,1,1\n", r"line 1: '0,1,1,1' where the columns .* pandas, Recording.from_arrays"),
    ("# ir50p_lab recording: 1\n# period", r"ends before its first sample"),
    (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", r"line 1: .* where the columns"),
]


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_what_is_wrong_is_named_with_file_and_line(tmp_path, text, message):
    assert "other.csv" in refused(message, Recording.load, file_of(tmp_path, text), error=RecordingError)


def test_places_where_nothing_is_or_can_be_written(tmp_path):
    refused(r"nothing.csv.*check the path", Recording.load, tmp_path / "nothing.csv", error=RecordingError)
    said = r"cannot write .*nowhere.*give a file in a folder of yours"
    refused(said, step_answer().save, tmp_path / "nowhere" / "run.csv", error=RecordingError)


# ---- what it says


def step_answer():
    t = 0.01 * np.arange(1000)
    q = np.outer(1 - np.exp(-3 * t) * np.cos(8 * t), [1.0, 0.5, -1.0])
    u = np.outer(255 * np.exp(-t), [1, 1, -1])
    return Recording.from_arrays(t, q, u=u, reference=np.tile([1.0, 0.6, -1.0], (1000, 1)), header=HEAD)


def test_between_keeps_times_and_says_that_it_is_a_part():
    part = step_answer().between(2.0, 3.0)
    assert (part.t[0], part.t[-1], len(part)) == (pytest.approx(2.0), pytest.approx(3.0), 101)
    assert part.header["cut"] == "2 to 3 s" and part.simulated
    assert len(step_answer().between(50, 60)) == 0


def test_plot_shows_itself_and_says_simulated():
    figure = step_answer().plot()
    assert "simulated" in figure.get_suptitle()
    upper, lower = figure.axes[:3], figure.axes[3:]
    assert [ax.get_xlabel() for ax in lower] == ["t [s]"] * 3
    assert upper[0].get_ylabel() == "angle [rad]" and "PWM" in lower[0].get_ylabel()
    angle, target = upper[1].get_lines()
    assert (angle.get_linestyle(), target.get_linestyle()) == ("-", "--")
    assert target.get_ydata()[0] == 0.6 and "100 mrad" in upper[1].get_title()
    png, size = figure._repr_png_()
    image = matplotlib.image.imread(io.BytesIO(png))
    assert image.shape[:2] == (2 * size["height"], 2 * size["width"])


def test_plot_without_reference_without_u_without_samples():
    figure = Recording.from_arrays([0.0, 0.01], np.zeros((2, 3))).plot()
    assert figure.axes[0].get_title() == "joint 1" and "unknown origin" in figure.get_suptitle()
    assert len(figure.axes[0].get_lines()) == 1
    Recording.from_arrays([0.0], np.zeros((1, 3))).plot()
    refused("no sample", Recording.from_arrays([], np.zeros((0, 3))).plot, error=RecordingError)


def test_events_in_the_middle_of_a_run_survive(tmp_path):
    with SimulatedBench(IR50P, record_to=tmp_path) as bench:
        for k, sample in enumerate(bench.run(0.05)):
            bench.drive((0, 0, 0), reference=sample.q)
            if k in (0, 3):
                bench.note(f"kp = {k} 2 3; läuft")
        path = bench.recording.path
    assert bench.recording.events == [(0.0, "kp = 0 2 3; läuft"), (0.03, "kp = 3 2 3; läuft")]
    text = path.read_text("utf-8")
    assert text.index("# event: 0.030 s: kp = 3") < text.index("\n0.030000")  # beside the sample it was noted at
    for copy in (Recording.load(path), Recording.load(Recording.load(path).save(tmp_path / "copy.csv"))):
        assert copy.events == bench.recording.events
        assert np.allclose(copy.q, bench.recording.q, atol=1e-6)
        assert copy.between(0.02, 1.0).events == [(0.03, "kp = 3 2 3; läuft")]


def test_the_period_in_the_head_is_checked_against_the_times(tmp_path):
    recording = Recording.from_arrays(0.01 * np.arange(50), np.zeros((50, 3)), header={"period_s": "0.05"})
    path = recording.save(tmp_path / "wrong_period.csv")
    assert Recording.load(path).period == pytest.approx(0.01)


def test_a_run_most_of_whose_cycles_were_left_out_keeps_its_period(tmp_path):
    t = 0.01 * np.cumsum(np.tile([1, 9, 14], 10))
    recording = Recording.from_arrays(t, np.zeros((30, 3)), missed=np.arange(30) * 8, header={"period_s": "0.01"})
    loaded = Recording.load(recording.save(tmp_path / "late.csv"))
    assert loaded.period == 0.01
