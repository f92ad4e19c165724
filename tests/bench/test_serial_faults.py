"""Everything that goes wrong between the computer and the board, one fault a test."""

import errno
import itertools
import os

import numpy as np
import pytest
import serial
from fake_board import ANSWER, FakeBoard
from refusals import refused

from ir50p_lab.bench import SerialBench, nominal_calibration, ports, protocol, serial_bench
from ir50p_lab.errors import BoardError, BoardLostError, InputError, PauseError, PortError, RunawayError
from ir50p_lab.modelling import IR50P

CALIBRATION = nominal_calibration(IR50P)


@pytest.fixture
def board():
    return FakeBoard(CALIBRATION)


def bench_of(board, **options):
    return SerialBench(board, arm=IR50P, clock=board, record_to=False, **options)


def run(board, seconds=0.5, pwm=(20, -10, 5), **options):
    """Samples of a run and the bench, closed by force: no way to the rest pose."""
    bench = bench_of(board, **options).open()
    samples = []
    for sample in bench.run(seconds):
        samples.append(sample)
        bench.drive(pwm)
    return samples, bench


# ---- the port does not open


def failing_port(monkeypatch, error, platform):
    def fail(*args, **options):
        raise error

    monkeypatch.setattr(serial, "Serial", fail)
    monkeypatch.setattr("sys.platform", platform)
    monkeypatch.setattr(ports, "list_ports", lambda: [ports.Port("COM7", None)])


@pytest.mark.parametrize(
    ("platform", "number", "text", "expected"),
    [
        ("linux", errno.EACCES, "Permission denied", ("no permission", "sudo usermod -aG dialout $USER")),
        ("darwin", errno.EACCES, "Permission denied", ("no permission", "ls -l")),
        ("win32", None, "PermissionError(13, 'Access is denied.', None, 5)", ("busy", "Arduino IDE")),
        ("linux", errno.EBUSY, "Device or resource busy", ("busy", "fuser -v", "ModemManager")),
        ("linux", errno.EAGAIN, "Could not exclusively lock port", ("busy", "other notebooks' kernels")),
        ("darwin", errno.EBUSY, "Resource busy", ("busy", "Arduino IDE")),
        ("linux", errno.ENOENT, "No such file or directory", ("does not exist", "COM7", "dmesg")),
        ("win32", None, "FileNotFoundError(2, 'cannot find the file', None, 2)", ("does not exist", "Device Manager")),
        ("linux", errno.ENOTTY, "Inappropriate ioctl for device", ("does not open", "is it a serial port")),
    ],
)
def test_port_that_does_not_open(monkeypatch, platform, number, text, expected):
    arguments = (text,) if number is None else (number, text)
    failing_port(monkeypatch, serial.SerialException(*arguments), platform)
    with pytest.raises(PortError, match="PORT") as error:
        SerialBench("PORT", arm=IR50P).open()
    for part in expected:
        assert part in str(error.value)


def test_file_that_is_no_port(tmp_path):
    (tmp_path / "file").write_text("text")
    refused("is it a serial port", SerialBench(tmp_path / "file", arm=IR50P).open, error=PortError)


@pytest.fixture
def pty():
    """A pseudo-terminal: the board's end, and the name of the computer's end."""
    openpty = pytest.importorskip("pty").openpty
    ours, theirs = openpty()
    yield ours, os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def test_port_that_another_program_holds(pty):
    first = ports.open_port(pty[1], protocol.BAUD)
    refused("is busy: another program holds it", SerialBench(pty[1], arm=IR50P).open, error=PortError)
    first.close()


def test_a_port_where_nothing_answers_is_given_free(pty, monkeypatch):
    monkeypatch.setattr(serial_bench, "HANDSHAKE", 0.1)
    monkeypatch.setattr(serial_bench, "BOOT_LOADER", 0.0)
    for _ in range(2):  # the second time, too, nothing answers: the port was not left open
        refused("no firmware of ours answers", SerialBench(pty[1], arm=IR50P).open, error=BoardError)
    assert os.read(pty[0], 1000)[2] == protocol.HELLO


@pytest.mark.parametrize("port", [None, "", 3])
def test_no_port(port):
    refused("give the name of a serial port", SerialBench, port, arm=IR50P)


# ---- what answers is not our board


def test_silence(board):
    board.dead = True
    begun = board.t
    said = r"fake: no firmware of ours answers. Is it a Mega 2560\?.*bench/firmware"
    refused(said, bench_of(board).open, error=BoardError)
    assert board.t - begun < 1.1 * serial_bench.HANDSHAKE
    assert board.closed


@pytest.mark.parametrize(
    "bytes_sent",
    [
        b"$GPGGA,123519,4807.038,N",
        b"start\r\necho:Marlin 1.1.9\r\n",
        bytes(range(130, 160)),
        bytes([protocol.REPLY_SYNC]) * 500,
    ],
)
def test_another_device(board, bytes_sent):
    """It talks, whatever we say; to each of our frames the same."""
    board.on_command = lambda n, data: board.say(bytes_sent) or b""
    refused("no firmware of ours answers", bench_of(board).open, error=BoardError)
    assert board.closed


@pytest.mark.parametrize(
    ("identity", "expected"),
    [
        ({"protocol": protocol.VERSION + 1}, f"speaks protocol {protocol.VERSION + 1}"),
        (
            {"firmware": (0, 99)},
            f"firmware is 0.99; this lab book needs protocol {protocol.VERSION} and firmware 1.1 or",
        ),
    ],
)
def test_another_firmware(board, identity, expected):
    board.identity = identity
    with pytest.raises(BoardError, match="put the sketch of ir50p_lab/bench/firmware on the board") as error:
        bench_of(board).open()
    assert expected in str(error.value)
    assert board.closed
    assert not any(command.type == protocol.DRIVE for _, command in board.commands)


def test_an_id_is_given_once_and_known_afterwards(board):
    bench = bench_of(board)
    assert bench.bench_id is None
    refused("open it", bench.give_id, error=BoardError)
    with bench:
        assert bench.bench_id is None
        given = bench.give_id()
        assert given == bench.give_id() == bench.bench_id
        assert given.startswith("board-")
        for _ in bench.run(0.02):
            pass
        assert bench.recording.header["bench_id"] == given
        assert bench.recording.header["firmware"] == bench.firmware
    with bench_of(board) as again:
        assert again.bench_id == given


# ---- opening restarts the board


class Booting(FakeBoard):
    """A board behind a real port: raising DTR starts a boot loader, which takes longer if it hears anything."""

    ready = 0.0

    def __init__(self, boot=1.7):
        super().__init__(CALIBRATION)
        self.boot_time = boot

    @property
    def dtr(self):
        return True

    @dtr.setter
    def dtr(self, value):
        self.restart()
        self.ready = self.t + self.boot_time

    def write(self, data):
        if self.t < self.ready:
            self.ready = self.t + 8.0
        return super().write(data if self.t >= self.ready else b"")


def test_boot_loader_is_waited_out_in_silence(monkeypatch, capsys):
    board = Booting()
    monkeypatch.setattr(serial_bench, "open_port", lambda name, baud: board)
    with SerialBench("COM3", arm=IR50P, clock=board, record_to=False) as bench:
        assert bench.identity.protocol == protocol.VERSION
    assert capsys.readouterr().out == "COM3: the board restarts, its boot loader takes 2 s\r"
    assert 2.0 <= board.commands[0][0] - 100.0 < 2.1


# ---- noise on the wire


def flip(data, k):
    return data[:k] + bytes([data[k] ^ 0x10]) + data[k + 1 :]


@pytest.mark.parametrize("where", ["command", "answer"])
@pytest.mark.parametrize("fault", ["lost", "damaged", "cut short", "noise before"])
def test_one_frame_in_five_is_hit_and_the_run_goes_on(board, where, fault):
    hurt = {
        "lost": lambda data: b"",
        "damaged": lambda data: flip(data, 4),
        "cut short": lambda data: data[:7],
        "noise before": lambda data: b"\x5a\xa5\x00" + data,
    }[fault]
    change = lambda n, data: hurt(data) if n % 5 == 3 else data  # noqa: E731
    setattr(board, f"on_{where}", change)
    samples, bench = run(board)
    assert len(samples) == 50
    np.testing.assert_allclose(np.diff([s.t for s in samples]), 0.01, atol=0.006)  # a repeat comes 4 ms later
    statistics = bench.statistics
    if fault != "noise before":
        assert statistics.repeats > 5
        assert statistics.commands > 100
    if fault in ("damaged", "noise before"):
        assert (statistics.bad_commands if where == "command" else statistics.bad_replies) > 5
    assert board.trips == statistics.watchdog_trips == 0


def test_noise_never_becomes_a_sample(board):
    """Replies are damaged at random; what is taken is what the potentiometers read."""
    rng = np.random.default_rng(4)

    def noise(n, data):
        data = bytearray(data)
        for k in rng.integers(0, len(data), rng.integers(0, 3)):
            data[k] = rng.integers(0, 256)
        return rng.bytes(rng.integers(0, 4)) + bytes(data)

    bench = bench_of(board).open()
    board.on_answer = noise
    taken = 0
    for sample in bench.run(20):
        bench.drive((3, 2, -3))
        assert np.abs(sample.q - board.q).max() < 0.01
        taken += 1
    assert taken > 1000  # a cycle whose answer came late leaves out the next
    assert bench.statistics.bad_replies > 1000


@pytest.mark.parametrize("late", np.arange(500, 540, 5) / 10_000)
def test_an_answer_still_on_its_way_when_a_run_begins_is_no_damaged_one(board, late):
    """A busy computer asks again at the hello; the second answer comes byte by byte, with bytes like a frame's first."""
    byte = 10 / protocol.BAUD

    def say(data):
        begins = board.t + (late if board.hellos == 1 else ANSWER)
        begins = max([begins, *(when + byte for when, _ in board._out)])  # one wire: behind what is on it
        board._out += [(begins + k * byte, data[k : k + 1]) for k in range(len(data))]

    board.say, board.board_id = say, 0x5A5A5A
    samples, bench = run(board, 0.1)
    assert len(samples) >= 9
    assert bench.statistics.repeats >= 1
    assert bench.statistics.bad_replies == 0


def test_a_cable_pulled_before_the_hello(board):
    board.unplugged = True
    refused("went away while we said hello", bench_of(board).open, error=BoardError)
    assert board.closed


# ---- answers that come late


@pytest.mark.parametrize("after", [0.003, 0.006, 0.0095, 0.016])
def test_slow_answers_are_those_of_the_present_cycle(board, after):
    """A naive host stays one reply behind for ever; here the age of a sample never passes the way of its answer."""
    bench = bench_of(board).open()
    board.answer_after = after
    truth = []
    for sample in bench.run(0.5):
        bench.drive((250, -250, 250))
        truth.append((sample.t, sample.q))
    assert len(truth) >= 30 and truth[-1][0] < 0.5  # the run keeps its time
    begun = board.t - truth[-1][0]
    speed = 250 * 0.004
    t, q1 = np.array([t for t, _ in truth]), np.array([q[0] for _, q in truth])
    moving = q1 < IR50P.q_max[0]
    error = np.diff(q1[moving]) - speed * np.diff(t[moving])
    assert np.abs(error[1:]).max() < 2.0 / CALIBRATION.slope[0]  # each angle belongs to its time
    assert begun > 0


# ---- late cycles


def test_late_cycles_are_counted_never_raised(board):
    bench = bench_of(board).open()
    samples = []
    for k, sample in enumerate(bench.run(0.4)):
        samples.append(sample)
        board.sleep(0.035 if k == 10 else 0.004 if k == 20 else 0.0)
        bench.drive((0, 0, 0))
    t = np.array([s.t for s in samples])
    assert samples[10].missed == 0
    assert samples[11].missed in (3, 4)  # three periods are left out, and the cycle itself comes late
    assert samples[-1].missed == samples[11].missed
    assert t[11] - t[10] > 0.035
    assert np.diff(t).min() > 0.003  # never in a rush to catch up
    np.testing.assert_allclose(np.diff(t[12:]), 0.01, atol=1e-3)


# ---- the board is lost


def loses(board, happen, at=30, seconds=1.0):
    """Run until `happen` at a sample; returns the error and the time from the fault to it."""
    bench = bench_of(board)
    with pytest.raises(BoardLostError) as caught, bench:
        for k, _ in enumerate(bench.run(seconds)):
            bench.drive((50, -50, 50))
            if k == at:
                when = board.t
                happen()
    assert board.closed
    return str(caught.value), board.t - when, bench


RESTARTED = "has restarted in the middle of the run"


@pytest.mark.parametrize(
    ("happen", "within", "expected"),
    [
        (lambda board: setattr(board, "unplugged", True), 0.02, ("is gone", "brakes by itself", "USB cable")),
        (lambda board: setattr(board, "dead", True), 0.7, ("has not answered for 0.5 s",)),
        (lambda board: board.restart(), 0.02, (RESTARTED, "supply broke down")),
        (lambda board: board.restart(hung=True), 0.02, (RESTARTED, "hardware watchdog")),
    ],
    ids=["cable pulled", "silent", "supply", "hung"],
)
def test_a_lost_board_is_told_in_time_and_brakes(board, happen, within, expected):
    text, after, bench = loses(board, lambda: happen(board))
    for part in expected:
        assert part in text
    assert after < within
    assert len(bench.recording.t) == 31  # everything up to the fault is there
    board._advance(board.t + 0.15)
    assert (board.pwm == 0).all()


def test_cable_pulled_between_two_commands(board):
    """The port raises in drive()."""
    bench = bench_of(board)
    with pytest.raises(BoardLostError, match="is gone"), bench:
        for k, _ in enumerate(bench.run(1.0)):
            board.unplugged = k == 30
            bench.drive((50, -50, 50))


@pytest.mark.parametrize("nth", [100, 101])  # of a sample's question, or of its command
def test_a_program_that_was_stopped_as_it_wrote_lost_no_board(board, monkeypatch, nth):
    """pyserial calls a write timed out that went well before the stop."""
    write = board.write

    def stopped(data):
        size = write(data)
        if board.writes == nth:
            board.sleep(2.0)
            raise serial.SerialTimeoutException("Write timeout")
        return size

    monkeypatch.setattr(board, "write", stopped)
    refused(r"no command for 2\.0 s", run, board, 5.0, (30, 0, 0), error=PauseError)
    assert board.trips == 1 and (board.pwm == 0).all()


def test_a_command_that_did_not_get_out_in_time_is_not_driven_later(board, monkeypatch):
    """The first of a run: the board has nothing to cut yet."""
    write, kinds = board.write, []

    def late(data):
        if data[2] == protocol.DRIVE and protocol.DRIVE not in kinds:
            kinds.append(protocol.DRIVE)
            board.sleep(2.0)
            raise serial.SerialTimeoutException("Write timeout")
        kinds.append(data[2])
        return write(data)

    monkeypatch.setattr(board, "write", late)
    refused("", run, board, 0.5, (200, 0, 0), error=PauseError)
    assert kinds.count(protocol.DRIVE) == 1 and kinds[kinds.index(protocol.DRIVE) + 1] == protocol.STOP


def test_a_port_that_takes_nothing_is_lost(board, monkeypatch):
    def full(data):
        board.sleep(1.0)
        raise serial.SerialTimeoutException("Write timeout")

    text, after, _ = loses(board, lambda: monkeypatch.setattr(board, "write", full))
    assert "is gone (Write timeout)" in text and after < 12


def test_termios_error_of_a_pulled_cable_is_no_stranger(board, monkeypatch):
    termios = pytest.importorskip("termios")

    def pulled(n=1):
        raise termios.error(5, "Input/output error")

    text, _, _ = loses(board, lambda: monkeypatch.setattr(board, "read", pulled))
    assert "is gone" in text


def test_board_that_restarted_between_two_runs_runs_again(board):
    _, bench = run(board)
    board.restart()
    again = [bench.drive((10, 0, 0)) for _ in bench.run(0.2)]
    assert len(again) == 20
    assert board.pwm[0] == 10


def test_the_watchdog_between_two_runs_is_not_counted(board):
    _, bench = run(board)
    board.sleep(1.0)
    assert board.trips == 1
    assert len(list(bench.run(0.2))) == 20
    assert bench.statistics.watchdog_trips == 0


def test_board_lost_between_two_runs(board):
    _, bench = run(board)
    board.dead = True
    with pytest.raises(BoardLostError, match="does not answer"):
        next(bench.run(0.2))
    bench.abort()
    assert board.closed


@pytest.mark.parametrize(("joint", "reads"), [(0, 0), (1, 1023), (2, 1021)])
def test_broken_wire_of_a_potentiometer(board, joint, reads):
    with pytest.raises(BoardError, match=f"potentiometer of joint {joint + 1} reads") as caught:
        with bench_of(board) as bench:
            for k, _ in enumerate(bench.run(1.0)):
                bench.drive((50, -50, 50))
                if k == 20:
                    q = board.q.copy()
                    q[joint] = (reads - CALIBRATION.zero[joint]) / CALIBRATION.slope[joint]
                    board.q = q
    assert "the drive is off" in str(caught.value)
    assert (board.pwm == 0).all()
    assert len(bench.recording) == 21


# ---- cutting


@pytest.mark.parametrize("dead", [False, True])
@pytest.mark.parametrize("fault", ["command", "tip", "wire"])
def test_no_error_says_that_the_drive_is_off_before_the_board_has(board, fault, dead):
    """The line dies after an answer, before the cut: nobody knows, and the board cuts 0.1 s after the last command."""
    if fault == "tip":
        board.q = np.array([0.0, -0.8, 0.0])

    late = []

    def on_answer(n, data):
        late.extend([n] * int(board.q[0] > 9))  # those after the wire broke: to a command, then with the measurement
        board.dead = dead and len(late) > 1
        return data

    board.on_answer = on_answer
    with pytest.raises((BoardError, InputError, RunawayError)) as caught, bench_of(board) as bench:
        for k, _ in enumerate(bench.run(1.0)):
            if k == 5 and fault == "wire":
                board.q[0] = 10.0  # no potentiometer reads that
            board.dead = dead and fault != "wire" and k == (0 if fault == "tip" else 5)
            bench.drive((np.nan, 0, 0) if fault == "command" and k == 5 else (50, -50, 50))
    assert ("the board has not confirmed the cut: it brakes by itself within 0.1 s" in str(caught.value)) == dead
    assert any(said in str(caught.value) for said in ("drive has been cut", "drive is off")) != dead
    board.sleep(0.1)
    assert not board.pwm.any()


@pytest.mark.parametrize("state", ["well", "dead", "unplugged", "noisy", "closed"])
def test_cut_never_raises_and_never_hangs(board, state):
    _, bench = run(board)
    if state == "noisy":
        lost = itertools.count()
        board.on_command = lambda n, data: data if next(lost) % 3 == 2 else flip(data, 5)
    elif state == "closed":
        bench.abort()
    elif state != "well":
        setattr(board, state, True)
    begun = board.t
    bench.cut()
    assert board.t - begun < 0.06
    if state in ("well", "noisy", "closed"):
        assert (board.pwm == 0).all()


def test_a_second_interrupt_while_cutting_changes_nothing(board, monkeypatch):
    _, bench = run(board)
    read = board.read

    def interrupted(n=1):
        monkeypatch.setattr(board, "read", read)
        raise KeyboardInterrupt

    monkeypatch.setattr(board, "read", interrupted)
    bench.cut()
    assert (board.pwm == 0).all()
