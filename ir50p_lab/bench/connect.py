"""`connect()`: the board if one answers, else the simulated arm. It says which, why, and how to get the other."""

import os

from ir50p_lab.bench.ports import list_ports
from ir50p_lab.bench.result_files import own_calibration
from ir50p_lab.errors import BoardError, InputError, PortError
from ir50p_lab.home import setting

VARIABLE = "IR50P_BENCH"
_TO_BOARD = f"for a board: connect('PORT') or {VARIABLE}=PORT"
_TO_SIMULATED = f"for the simulated arm: connect('simulated') or {VARIABLE}=simulated"


def connect(port=None, *, arm=None, calibration=None, period=0.01, record_to=None, **simulated):
    """Find the bench, open it, and say which it is, why, and how to get the other.

    The first of these that says something decides: the argument `port`, the environment variable IR50P_BENCH, a board
    that is plugged in (known by its USB id) and answers, and finally the simulated arm.

    Args:
        port: 'simulated', 'replay:FILE', or a serial port ('COM3', '/dev/ttyACM0'); None looks for a board.
        arm: Arm, default `load_arm()`; calibration: counts to rad, by default yours, if one was
        measured on this very bench (`course.results`), else the nominal one; period: s;
        record_to: folder of the recordings, or False for none on disk. simulated: further options of SimulatedBench,
        such as `seed` and `unit`; the other benches ignore them, so that a cell runs on any bench (a replay uses
        `realtime`).

    Returns: an open bench, for `with connect() as bench:`.
    Raises: PortError or BoardError, with the remedy, if the port you asked for does not open or no board of ours
    answers there; RecordingError for a file that is not a recording; InputError for a `port` that is none of the above,
    and for a lab's own file that is wrong (`caps`). If a board was only looked for, nothing else is raised: the line
    says why it was not taken.
    """
    common = {"arm": arm, "calibration": calibration, "period": period, "record_to": record_to}
    if port is None and not setting(VARIABLE):
        return _look_for_a_board(common, simulated)
    wish = setting(VARIABLE) if port is None else port
    reason = f"asked for by {VARIABLE}={wish}" if port is None else f"asked for by connect({port!r})"
    if not isinstance(wish, str | os.PathLike) or not str(wish):
        raise InputError(f"port = {wish!r}: give 'simulated', 'replay:FILE' or the name of a serial port")
    wish = os.fspath(wish)
    if wish.lower() == "simulated":
        return _say(_simulated(common, simulated), reason, _TO_BOARD)
    if wish.lower().startswith("replay:"):
        from ir50p_lab.bench.replay import ReplayBench

        options = {"arm": arm, "record_to": record_to or False, "realtime": simulated.get("realtime", False)}
        return _say(ReplayBench(wish[len("replay:") :], **options).open(), reason, _TO_BOARD)
    return _board(wish, common, reason)


def _look_for_a_board(common, simulated):
    refused = []
    for port in list_ports():
        try:
            if port.board:
                return _board(port.device, common, f"{port.board} found and its firmware answers")
        except (PortError, BoardError) as error:
            refused.append(f"{port.board} was not taken: {error}")
    return _say(_simulated(common, simulated), "; ".join(refused) or "no Arduino Mega found", _TO_BOARD)


def _simulated(common, simulated):
    from ir50p_lab.bench.simulated import SimulatedBench

    bench = SimulatedBench(**common, **simulated)
    bench.calibration = common["calibration"] or own_calibration(bench) or bench.calibration
    return bench.open()


def _board(device, common, reason):
    from ir50p_lab.bench.serial_bench import SerialBench

    bench = SerialBench(device, **common).open()
    known = bench.bench_id or "without an id: python3 -m ir50p_lab bench-test gives it one"
    said = f"{reason}, version {bench.firmware}; {known}; caps: {bench.caps.source or 'none'}"
    return _say(bench, said, _TO_SIMULATED)


def _say(bench, reason, other):
    """The sentence, padded to wipe out what was announced before it; JupyterLab would break one line within a word."""
    print(f"Bench: {bench.name} ({reason}; calibration: {bench.calibration.source};".ljust(80), f"  {other})", sep="\n")
    return bench
