"""Which bench `connect()` opens, in which order, and the sentence that it says."""

from importlib import import_module

import pytest
from fake_board import FakeBoard
from refusals import refused

from ir50p_lab.bench import JointCalibration, SerialBench, SimulatedBench, connect, nominal_calibration
from ir50p_lab.bench import ports as port_list
from ir50p_lab.bench.ports import Port
from ir50p_lab.course.lab_book.results import add
from ir50p_lab.errors import BoardError, PortError, RecordingError
from ir50p_lab.modelling import IR50P

MEGA = "Arduino Mega 2560"
CLONE = "CH340 chip, as on clones of the Mega"


@pytest.fixture(autouse=True)
def computer(monkeypatch, tmp_path):
    """A computer without any port, unless a test plugs something in: computer({name: (board, what is there)})."""
    monkeypatch.chdir(tmp_path)
    for variable in ("IR50P_BENCH", "IR50P_ARM", "IR50P_RECORDINGS"):
        monkeypatch.delenv(variable, raising=False)
    opened = []

    def plug_in(things):
        def open_port(name, baud):
            opened.append(name)
            there = things.get(name, (None, PortError(f"{name} does not exist")))[1]
            if isinstance(there, Exception):
                raise there
            return there

        finder, serial_bench = (import_module(f"ir50p_lab.bench.{name}") for name in ("connect", "serial_bench"))
        monkeypatch.setattr(finder, "list_ports", lambda: [Port(name, board) for name, (board, _) in things.items()])
        monkeypatch.setattr(serial_bench, "open_port", open_port)
        clocks = [there for _, there in things.values() if hasattr(there, "now")]
        if clocks:
            monkeypatch.setattr(serial_bench, "Clock", CommonClock(clocks))
        return opened

    plug_in({})
    return plug_in


class CommonClock:
    """One clock for several boards on virtual time."""

    def __init__(self, boards):
        self.boards = boards

    def now(self):
        return max(board.now() for board in self.boards)

    def sleep(self, seconds):
        until = self.now() + seconds
        for board in self.boards:
            board.sleep(until - board.now())


def board(**faults):
    made = FakeBoard(nominal_calibration(IR50P))
    for name, value in faults.items():
        setattr(made, name, value)
    return made


@pytest.fixture
def said(capsys):
    """The sentence, in one line, without what was wiped out before it."""

    def read():
        out = capsys.readouterr().out
        assert out.count("\n") == 2 and out.endswith("\n")
        return " ".join(out.split("\r")[-1].split())

    return read


# ---- nothing is asked for


def test_no_board_gives_the_simulated_arm(said):
    with connect() as bench:
        assert isinstance(bench, SimulatedBench)
        assert len(list(bench.run(0.1))) == 10
    assert said() == (
        "Bench: simulated IR50P, unit 0 (no Arduino Mega found; calibration: nominal, not measured; "
        "for a board: connect('PORT') or IR50P_BENCH=PORT)"
    )


@pytest.mark.parametrize("name", [MEGA, CLONE])
def test_a_board_that_answers_is_taken(computer, said, name):
    there = board()
    opened = computer({"COM1": (None, board()), "COM7": (name, there)})
    with connect() as bench:
        assert isinstance(bench, SerialBench) and bench.port == "COM7" and opened == ["COM7"]
        for _ in bench.run(0.1):
            bench.drive([20, 0, 0])
        assert there.q[0] > 0
    line = said()
    assert line.startswith(f"Bench: board on COM7 for IR50P ({name} found and its firmware answers, version 1.1; ")
    assert "calibration: nominal, not measured" in line
    assert line.endswith("; for the simulated arm: connect('simulated') or IR50P_BENCH=simulated)")


@pytest.mark.parametrize(
    ("first", "words"),
    [
        (PortError("COM3 is busy: another program holds it"), "COM3 is busy"),
        (board(dead=True), "no firmware of ours answers"),
    ],
    ids=["busy", "silent"],
)
def test_a_board_that_cannot_be_used_is_named_and_the_next_tried(computer, said, first, words):
    opened = computer({"COM3": (MEGA, first), "COM4": (CLONE, board())})
    assert connect().port == "COM4"
    assert opened == ["COM3", "COM4"]
    said()
    computer({"COM3": (MEGA, first)})
    assert isinstance(connect(), SimulatedBench)
    line = said()
    assert f"({MEGA} was not taken: " in line and words in line
    assert line.endswith("; for a board: connect('PORT') or IR50P_BENCH=PORT)")


# ---- something is asked for


def test_the_simulated_arm_although_a_board_is_there(computer, said, monkeypatch):
    opened = computer({"COM3": (MEGA, board())})
    assert isinstance(connect("Simulated"), SimulatedBench)
    assert "(asked for by connect('Simulated'); calibration: " in said()
    monkeypatch.setenv("IR50P_BENCH", "simulated")
    assert isinstance(connect(), SimulatedBench)
    assert "(asked for by IR50P_BENCH=simulated; calibration: " in said()
    assert not opened


def test_a_port(computer, said):
    """Also one whose USB id nobody knows."""
    computer({"COM1": (MEGA, board()), "COM5": (None, board())})
    assert connect("COM5").port == "COM5"
    assert "(asked for by " in said()


def test_what_is_asked_for_and_fails_raises(computer, capsys):
    computer({"COM3": (MEGA, board(dead=True))})
    refused("no firmware of ours answers", connect, "COM3", error=BoardError)
    refused("COM9 does not exist", connect, "COM9", error=PortError)
    refused(r"nowhere\.csv", connect, "replay:nowhere.csv", error=RecordingError)
    assert "Bench:" not in capsys.readouterr().out


@pytest.mark.parametrize("port", ["", 7, b"COM3"])
def test_a_port_that_is_none(port):
    refused("give 'simulated', 'replay:FILE' or the name of a serial port", connect, port)


# ---- what is handed on


def test_options_go_to_the_bench(computer, said, tmp_path):
    bench = connect("simulated", arm=IR50P, period=0.02, record_to=tmp_path, seed=3)
    assert bench.plant.seed == 3 and bench.period == 0.02
    assert len(list(bench.run(0.1))) == 5
    assert bench.recording.path.parent == tmp_path
    said()
    computer({"COM3": (MEGA, board())})
    bench = connect(period=0.02, record_to=False, seed=3, realtime=True)  # which a board cannot help
    assert bench.period == 0.02
    said()


def test_a_board_takes_only_a_calibration_measured_on_it(computer, said, monkeypatch, tmp_path):
    """Neither one of the simulated arm, nor one of another board; and none while the board has no id."""
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    nominal, mine = nominal_calibration(IR50P), board()
    for k, where in enumerate(("simulated-unit-0", "board-0a0b0c")):
        zero = tuple(z + 5 + k for z in nominal.zero)
        about = {"arm": "IR50P", "bench": where, "unit": "", "seed": "", "simulated": k == 0}
        add("calibration", JointCalibration(nominal.slope, zero, source="x").save, bench_id=where, **about)
    computer({"COM3": (MEGA, mine)})
    with connect() as bench:
        assert bench.calibration == nominal and "calibration: nominal, not measured" in said()
        here = bench.give_id()
    zero = tuple(z + 9 for z in nominal.zero)
    measured = JointCalibration(nominal.slope, zero, source="on Monday")
    add("calibration", measured.save, **about | {"bench_id": here})
    mine.is_open = True
    with connect() as bench:
        assert bench.calibration.zero == zero and "calibration: yours, calibration-3 (on Monday)" in said()
    with connect("simulated") as bench:
        assert bench.calibration.zero == tuple(z + 5 for z in nominal.zero)


# ---- ports


def test_list_of_ports(monkeypatch):
    from serial.tools import list_ports
    from serial.tools.list_ports_common import ListPortInfo

    def info(device, vid, pid):
        port = ListPortInfo(device, skip_link_detection=True)
        port.vid, port.pid = vid, pid
        return port

    found = [info("COM1", None, None), info("COM9", 0x1A86, 0x7523), info("COM11", 0x2341, 0x0042)]
    monkeypatch.setattr(list_ports, "comports", lambda: found)
    assert port_list.list_ports() == [Port("COM11", MEGA), Port("COM9", CLONE), Port("COM1", None)]
