"""The sketch itself, compiled and run in the emulator: pins, limits, watchdogs."""

import pytest
from board_frames import LIMIT_ACTIVE

from ir50p_lab.bench import protocol
from ir50p_lab.bench.protocol import DRIVE, Identity, encode_command
from tests.emulator.build import firmware
from tests.emulator.mega import Mega
from tests.emulator.talk import Talk
from tests.emulator.virtual import HeldArm, VirtualBoard

TICK = 1 / 800  # the timer's resolution, as a share
WATCHDOG = protocol.WATCHDOG_MS / 1000


@pytest.fixture
def board():
    board = VirtualBoard(HeldArm((200, 512, 900)))
    board.sleep(0.05)
    return board


@pytest.fixture
def talk(board):
    talk = Talk(board)
    assert isinstance(talk.hello(), Identity)
    return talk


def drive_for(board, talk, seconds, *pwm):
    """Drive as a computer does, every 10 ms. Returns the last reply and when it came."""
    for _ in range(round(seconds / 0.01)):
        reply = talk.drive(*pwm)
        came = board.now()
        board.sleep(0.01 - 0.0015)
    return reply, came


def when_braked(board):
    """The moment at which the drive of all joints has become and stayed zero."""
    moments = [t for t, pins in board.changes if not any(pins.pwm)]
    last_driven = max(t for t, pins in board.changes if any(pins.pwm))
    return min(t for t in moments if t > last_driven)


def braking(pins):
    return pins.enable == (1, 1, 1) and pins.duty == (0, 0, 0) and pins.direction == (0, 0, 0)


# ---- start and hello


def test_the_sketch_compiles_without_a_warning_and_leaves_room():
    assert firmware().stat().st_size > 0  # -Wall -Wextra -Werror


def test_it_brakes_from_the_start_and_never_drives_while_starting(board):
    assert braking(board.pins())
    assert not any(any(pins.pwm) for _, pins in board.changes)


def test_enable_comes_last(board):
    for _, pins in board.changes:
        if any(pins.enable):
            assert pins.hertz == pytest.approx(20_000)


def test_the_period_is_set_after_the_mode():
    """ICR4 can only be written in a mode that uses it (data sheet, 'Input Capture Register'); the emulator is lenient."""
    mega = Mega(firmware())
    while not mega.register(0xA6):
        mega.run(0.3e-6)
        assert mega.seconds < 0.01
    assert (mega.register(0xA0) & 3, mega.register(0xA1) & 0x18) == (2, 0x18)


def test_hello_says_what_the_board_is(board):
    identity = Talk(board).hello()
    assert identity[1:4] == (protocol.VERSION, protocol.MINIMUM_FIRMWARE, protocol.NO_ID)


def test_an_id_is_given_once_and_survives_a_reset(board, talk):
    assert talk.ask(protocol.NAME, (1, 2, 3)).board_id == 0x030201
    assert talk.ask(protocol.NAME, (7, 7, 7)).board_id == 0x030201
    board.reset()
    board.sleep(0.05)
    assert talk.hello().board_id == 0x030201
    assert board.resets == 1  # the button: writing the id was no hang


def test_naming_brakes(board, talk):
    talk.drive(200, -200, 200)
    talk.ask(protocol.NAME, (1, 2, 3))
    assert braking(board.pins())


def test_before_hello_it_measures_but_does_not_drive(board):
    reply = Talk(board).drive(100, 100, 100)
    assert reply.status == protocol.HELLO_NEEDED
    assert reply.counts == (800, 2048, 3600)
    assert braking(board.pins())


def test_replies_come_within_two_milliseconds(board, talk):
    begin = board.now()
    talk.drive(1, 2, 3)
    assert board.now() - begin < 1.5e-3


# ---- bridges


@pytest.mark.parametrize("pwm", [0, 1, 128, 255])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("joint", [0, 1, 2])
def test_sign_and_magnitude(board, talk, joint, sign, pwm):
    command = [0, 0, 0]
    command[joint] = sign * pwm
    talk.drive(*command)
    board.sleep(0.001)
    pins = board.pins()
    backward = sign < 0 and pwm > 0
    assert pins.direction[joint] == backward
    assert pins.duty[joint] == pytest.approx(1 - pwm / 255 if backward else pwm / 255, abs=1.5 * TICK)
    assert pins.pwm[joint] == pytest.approx(sign * pwm, abs=1.5 * TICK * 255)
    assert [pins.pwm[j] for j in range(3) if j != joint] == [0, 0]
    assert pins.enable == (1, 1, 1)


def test_the_gripper_follows_its_flag_and_survives_a_stop(board, talk):
    talk.drive(0, 0, 0, gripper=True)
    assert board.pins().gripper
    talk.stop()
    assert board.pins().gripper  # it may hold something
    talk.drive(0, 0, 0)
    assert not board.pins().gripper


@pytest.mark.parametrize("ask", [Talk.stop, Talk.hello])
def test_stop_and_hello_brake_at_once(board, talk, ask):
    talk.drive(200, -200, 200)
    assert any(board.pins().pwm)
    ask(talk)
    assert braking(board.pins())


# ---- potentiometers


def test_counts_are_means_of_sixteen(board, talk):
    """Halfway between two steps of the converter the mean tells what a single conversion cannot."""
    board.plant.counts = Flicker(board).counts
    board.sleep(0.02)
    seen = {talk.drive(0, 0, 0).counts[1] for _ in range(20)}
    assert all(2048 < counts < 2052 for counts in seen)


class Flicker:
    """Joint 2 reads 512 and 513 in turn, a millisecond each."""

    def __init__(self, board):
        self.step = 0

    def counts(self):
        self.step += 1
        return (200, 512 + self.step % 2, 900)


@pytest.mark.parametrize("counts", [5, 20, 511, 700, 1003, 1018])
def test_counts_are_right(board, talk, counts):
    board.plant.values = (counts, 512, counts)
    board.sleep(0.01)
    assert talk.drive(0, 0, 0).counts == (4 * counts, 2048, 4 * counts)


# ---- limits


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize(("counts", "outward"), [(8, -1), (1015, 1)])
def test_at_an_end_only_inward_drive(board, talk, joint, counts, outward):
    values, command = [512, 512, 512], [40, 40, 40]
    values[joint], command[joint] = counts, outward * 100
    board.plant.values = values
    board.sleep(0.01)
    status = talk.drive(*command).status
    assert status == LIMIT_ACTIVE[joint]
    assert board.pins().pwm[joint] == 0
    assert sum(map(bool, board.pins().pwm)) == 2  # the others drive on
    command[joint] *= -1
    assert talk.drive(*command).status == 0
    assert board.pins().pwm[joint] == pytest.approx(-outward * 100, abs=0.5)


def test_a_joint_that_reaches_its_end_is_cut_without_a_new_command(board, talk):
    talk.drive(0, 150, 0)
    assert board.pins().pwm[1] > 0
    board.plant.values = (512, 1016, 512)
    board.sleep(0.008)
    assert board.pins().pwm[1] == 0
    board.plant.values = (512, 1000, 512)
    board.sleep(0.008)
    assert board.pins().pwm[1] > 0  # the command still holds


@pytest.mark.parametrize("counts", [0, 1023])
@pytest.mark.parametrize("pwm", [80, -80])
def test_a_broken_wire_stops_its_joint_both_ways(board, talk, counts, pwm):
    board.plant.values = (counts, 512, 512)
    board.sleep(0.01)
    assert talk.drive(pwm, 0, 0).status == LIMIT_ACTIVE[0]
    assert board.pins().pwm[0] == 0


# ---- the watchdog


@pytest.mark.parametrize("phase", [0, 0.0007, 0.0013, 0.0021])
def test_no_command_for_100_ms_and_it_brakes(board, talk, phase):
    board.sleep(phase)
    reply, last = drive_for(board, talk, 0.2, 120, -120, 120)
    assert reply.status == 0
    board.sleep(0.2)
    assert braking(board.pins())
    assert WATCHDOG - 0.002 < when_braked(board) - last < WATCHDOG + 0.010
    for _ in range(3):  # refused and said until the computer has stopped and measured
        assert talk.drive(120, -120, 120).status == protocol.WATCHDOG_TRIPPED
        assert braking(board.pins())
    assert talk.stop().status == protocol.WATCHDOG_TRIPPED
    assert talk.drive(120, -120, 120).status == 0
    assert not braking(board.pins())


def test_a_computer_that_is_only_slow_does_not_trip_it(board, talk):
    for _ in range(5):
        assert talk.drive(90, 90, 90).status == 0
        board.sleep(0.09)
        assert all(board.pins().pwm)


def test_bad_frames_do_not_feed_it(board, talk):
    _, last = drive_for(board, talk, 0.1, 120, 120, 120)
    good = encode_command(9, DRIVE, (120, 120, 120))
    for k in range(30):
        damaged = bytearray(good)
        damaged[1 + k % (len(good) - 1)] ^= 1 << k % 8
        board.write(bytes(damaged))
        board.sleep(0.01)
    assert WATCHDOG - 0.002 < when_braked(board) - last < WATCHDOG + 0.010
    assert talk.drive(0, 0, 0).bad_frames >= 30


def test_a_flood_of_noise_does_not_hold_it_up(board, talk):
    _, last = drive_for(board, talk, 0.1, 120, 120, 120)
    board.write(b"\xa5\x07D" * 4000)  # 240 ms at full speed
    board.sleep(0.25)
    assert WATCHDOG - 0.002 < when_braked(board) - last < WATCHDOG + 0.010


def test_stop_does_not_count_as_a_trip(board, talk):
    talk.drive(10, 10, 10)
    talk.stop()
    board.sleep(0.3)
    assert talk.drive(0, 0, 0).status == 0


# ---- resets and hangs


def test_a_reset_is_noticed(board, talk):
    boot = talk.hello().boot
    drive_for(board, talk, 0.05, 70, 70, 70)
    board.reset()
    board.sleep(0.05)
    reply = talk.drive(70, 70, 70)
    assert reply.status == protocol.HELLO_NEEDED
    assert braking(board.pins())
    assert talk.hello().boot == (boot + 1) % 65536


def test_a_hung_sketch_brakes_and_is_restarted_by_the_hardware(board, talk):
    drive_for(board, talk, 0.05, 150, 150, -150)
    hung = board.now()
    board.hang()
    board.sleep(0.15)
    assert when_braked(board) - hung < 0.035
    assert board.resets == 1
    assert talk.drive(150, 150, 150).status == protocol.HELLO_NEEDED | protocol.HARDWARE_RESET
    assert braking(board.pins())
    talk.hello()
    board.reset()  # by the button: not a hang
    board.sleep(0.05)
    assert talk.drive(0, 0, 0).status == protocol.HELLO_NEEDED


def test_the_hardware_watchdog_resets_even_with_interrupts_off(board, talk):
    """The emulator does not model that case; the data sheet says it of these two bits."""
    wde, wdie = 1 << 3, 1 << 6
    assert board.register(0x60) & (wde | wdie) == wde | wdie


# ---- counters


def test_it_counts_bad_frames_and_its_clock_runs(board, talk):
    first = talk.drive(0, 0, 0)
    board.write(encode_command(0, DRIVE, (300, 0, 0)))
    board.sleep(0.1)
    second = talk.drive(0, 0, 0)
    assert second.bad_frames - first.bad_frames == 1
    assert second.clock_ms - first.clock_ms == pytest.approx(101, abs=3)


def test_sequence_numbers_come_back(board, talk):
    for _ in range(300):
        assert talk.drive(0, 0, 0) is not None  # ask() compares them
