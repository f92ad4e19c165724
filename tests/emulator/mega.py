"""An Arduino Mega 2560 inside this process: simavr, the emulator of the processor, driven through ctypes.

The processor runs the compiled sketch instruction by instruction; the pins' waveforms are not modelled, so what the
bridges get is read from the registers of the timer and the ports.
"""

import ctypes as c
import os
from typing import NamedTuple

import pytest

_F = 16_000_000
_p, _u8, _u16, _u32, _u64 = c.c_void_p, c.c_uint8, c.c_uint16, c.c_uint32, c.c_uint64
_NOTIFY = c.CFUNCTYPE(None, _p, _u32, _p)
_SLEEP = c.CFUNCTYPE(None, _p, _u64)
_RESET = c.CFUNCTYPE(None, _p)
_LOG = c.CFUNCTYPE(None, _p, c.c_int, _p, _p)
_RUNNING, _SLEEPING = 2, 3


class _IO(c.Structure):
    _fields_ = [(name, _p) for name in ("irq", "read", "read_arg", "write", "write_arg")]


class _Shared(c.Structure):
    _fields_ = [("used", c.c_int), ("callbacks", _p * 8)]


class _Avr(c.Structure):  # head of avr_t in sim_avr.h of simavr 1.6; _check() makes sure
    _fields_ = [
        *[("mmcu", c.c_char_p), ("ioend", _u16), ("ramend", _u16), ("flashend", _u32), ("e2end", _u32)],
        *[("vector_size", _u8), ("signature", _u8 * 3), ("fuse", _u8 * 6), ("lockbits", _u8), ("rampz", _u16)],
        *[("eind", _u16), ("address_size", _u8), ("reset_flags", _u32 * 4), ("codeend", _u32), ("state", c.c_int)],
        *[("frequency", _u32), ("vcc", _u32), ("avcc", _u32), ("aref", _u32)],
        *[("cycle", _u64), ("run_cycle_count", _u64), ("run_cycle_limit", _u64), ("sleep_usec", _u32)],
        *[("time_base", _u64), ("init", _p), ("reset", _p), ("custom", _p * 3), ("run", _p), ("sleep", _p)],
        *[("irq_count", c.c_int), ("irqs", _p), ("sreg", _u8 * 8), ("interrupt_state", c.c_int8), ("pc", _u32)],
        *[("reset_pc", _u32), ("io", _IO * 280), ("shared_count", c.c_int), ("shared", _Shared * 4)],
        *[("flash", _p), ("data", c.POINTER(_u8)), ("io_port", _p)],
    ]


class _Module(c.Structure):  # avr_io_t, then the head of avr_timer_t
    _fields_ = [
        *[("next", _p), ("avr", _p), ("kind", c.c_char_p), ("irq_names", _p), ("ioctl_get", _u32), ("count", c.c_int)],
        *[("irq", _p), ("reset", _p), ("ioctl", _p), ("dealloc", _p)],
        *[("name", c.c_char), ("trace", _u32), ("disabled", _u32), ("r_tcnt", _u16), ("r_icr", _u16)],
        *[("r_tcnth", _u16), ("r_icrh", _u16), ("wgm", _u32 * 4), ("wgm_op", _u32 * 16)],
    ]


class Pins(NamedTuple):
    """What the bridges see. duty: share of the time IN1 is high; direction: IN2; enable; for joints 1, 2, 3."""

    duty: tuple
    direction: tuple
    enable: tuple
    gripper: bool
    hertz: float

    @property
    def pwm(self):
        """Mean motor voltage as PWM counts (3,), -255..255; 0 is braking, or coasting where `enable` is low."""
        states = zip(self.duty, self.direction, self.enable, strict=True)
        return tuple(255 * (duty - direction) if enable else 0.0 for duty, direction, enable in states)


def _ioctl(name):
    return int.from_bytes(name.encode(), "big")


def _library():
    try:
        library = c.CDLL("libsimavr.so.2")
    except OSError:
        pytest.skip("no libsimavr.so.2; on Debian or Ubuntu: sudo apt-get install libsimavr2")
    library.avr_make_mcu_by_name.restype = library.avr_io_getirq.restype = _p
    for name, types in {
        "avr_init": [_p],
        "elf_read_firmware": [c.c_char_p, _p],
        "avr_load_firmware": [_p, _p],
        "avr_io_getirq": [_p, _u32, c.c_int],
        "avr_irq_register_notify": [_p, _NOTIFY, _p],
        "avr_raise_irq": [_p, _u32],
        "avr_ioctl": [_p, _u32, _p],
        "avr_run": [_p],
        "avr_reset": [_p],
        "avr_extint_set_strict_lvl_trig": [_p, _u8, _u8],
    }.items():
        getattr(library, name).argtypes = types
    return library


class Mega:
    """The processor with a sketch in it, at the moment of power-on.

    sent: bytearray, what it has sent; received: bytearray, what is on its way to it (fed in at the line's pace);
    resets: how often it has been reset.
    """

    def __init__(self, elf):
        library = self._library = _library()
        self._patched = None  # place in the program that hang() has overwritten, and what stood there
        self.resets = 0
        self._silent = _LOG(lambda *_: None)
        library.avr_global_logger_set(self._silent)
        self._avr = library.avr_make_mcu_by_name(b"atmega2560")
        library.avr_init(self._avr)
        self._head = head = _Avr.from_address(self._avr)
        self._check()
        image = c.create_string_buffer(1 << 16)  # elf_firmware_t, not looked into
        if library.elf_read_firmware(os.fsencode(elf), image):
            raise OSError(f"{elf} is no firmware for the emulator")
        library.avr_load_firmware(self._avr, image)
        head.frequency, head.vcc, head.avcc, head.aref = _F, 5000, 5000, 5000  # Hz, mV
        self._sleep = _SLEEP(lambda *_: None)
        head.sleep = c.cast(self._sleep, _p).value
        self._reset_core = _RESET(head.reset)
        self._on_reset = _RESET(self._after_reset)
        head.reset = c.cast(self._on_reset, _p).value
        self._make_timers_cheap()
        self._connect_serial()
        self._adc = [library.avr_io_getirq(self._avr, _ioctl("adc "), channel) for channel in range(3)]
        self._data = (_u8 * 0x200).from_address(c.addressof(head.data.contents))
        self._prepare()

    def _check(self):
        h = self._head
        known = (h.mmcu, h.ramend, h.flashend, h.frequency, h.run_cycle_limit)
        if known != (b"atmega2560", 0x21FF, 0x3FFFF, 1_000_000, 1):
            raise RuntimeError("another simavr than 1.6: the layout of its structures must be looked up again")

    def _make_timers_cheap(self):
        """Phase-correct PWM, which the Arduino core sets on all timers, is missing in simavr: they would tick singly."""
        module, found = self._head.io_port, 0
        while module:
            timer = _Module.from_address(module)
            module = timer.next
            if timer.kind == b"timer":
                found += 1
                for mode in (1, 2, 3) if timer.r_icr else (1,):
                    if timer.wgm_op[mode] == 0:
                        timer.wgm_op[mode] = 5 << 24 | (7 + mode) << 16  # fast PWM of 8, 9, 10 bits
        if found != 6:
            raise RuntimeError(f"{found} timers found, a Mega has 6: another simavr than 1.6")

    def _connect_serial(self):
        library = self._library
        self.sent, self.received, self._ready = bytearray(), bytearray(), False
        self._rx, tx, ready, full = (library.avr_io_getirq(self._avr, _ioctl("uar0"), i) for i in range(4))
        self._hooks = [_NOTIFY(self._on_sent), _NOTIFY(self._on_ready), _NOTIFY(self._on_full)]
        for irq, hook in zip((tx, ready, full), self._hooks, strict=True):
            library.avr_irq_register_notify(irq, hook, None)
        library.avr_ioctl(self._avr, _ioctl("uas0"), c.byref(_u32(0)))  # no sleeping while polled, no echo

    def _on_sent(self, irq, value, _):
        self.sent.append(value)

    def _on_ready(self, irq, value, _):
        self._ready = True

    def _on_full(self, irq, value, _):
        self._ready = self._ready and not value

    def _prepare(self):
        for interrupt in range(8):
            self._library.avr_extint_set_strict_lvl_trig(self._avr, interrupt, 0)

    def _after_reset(self, avr):
        self._reset_core(avr)
        self.resets += 1
        self._ready = False
        if self._patched:
            place, word = self._patched
            place[0], self._patched = word, None

    @property
    def seconds(self):
        """Virtual time since power-on."""
        return self._head.cycle / _F

    def reset(self):
        """Press the reset button (or open a real board's port: the DTR line does the same)."""
        self.received.clear()
        self._library.avr_reset(self._avr)
        self._prepare()

    def hang(self, interrupts=True):
        """From now on the sketch jumps on the spot, until a reset; interrupts: whether it is still interrupted."""
        head = self._head
        while not head.sreg[7]:  # not inside an interrupt: there it would hold the others up
            self.run(1e-6)
        head.sreg[7] = interrupts
        place = c.cast(head.flash + head.pc, c.POINTER(_u16))
        self._patched = place, place[0]
        place[0] = 0xCFFF  # rjmp to itself

    def run(self, seconds):
        """Let the processor work for that long, at least one instruction."""
        head, step, avr = self._head, self._library.avr_run, self._avr
        end, resets = head.cycle + max(1, round(seconds * _F)), self.resets
        while (cycle := head.cycle) < end:
            while self._ready and self.received:
                self._library.avr_raise_irq(self._rx, self.received.pop(0))
            head.run_cycle_limit = end - cycle
            state = step(avr)
            if state not in (_RUNNING, _SLEEPING):
                raise RuntimeError(f"the sketch has crashed: state {state}, program counter {head.pc:#x}")
            if self.resets != resets:  # by the hardware watchdog
                self._prepare()
                resets = self.resets

    def set_counts(self, channel, counts):
        """Voltage at A0.. such that the 10-bit converter reads `counts` (rounded to whole ones)."""
        counts = min(max(int(counts + 0.5), 0), 1023)
        self._library.avr_raise_irq(self._adc[channel], -(-counts * 5000 // 1023))  # mV; the emulator rounds down

    def raw_pins(self):
        """The registers behind `pins` as bytes: cheap to compare."""
        data = self._data
        return bytes(data[0x21:0x29] + data[0xA0:0xA2] + data[0xA6:0xAE] + data[0x101:0x103])

    def register(self, address):
        """The register at this place in the data space, e.g. 0x60 for WDTCSR."""
        return self._data[address]

    def pins(self):
        """The present Pins."""
        data = self._data
        ddra, porta, ddrh, porth = data[0x21], data[0x22], data[0x101], data[0x102]
        tccra, tccrb = data[0xA0], data[0xA1]
        top = data[0xA6] | data[0xA7] << 8
        fast = tccra & 3 == 2 and tccrb & 0x18 == 0x18  # fast PWM up to ICR4
        prescaler = {1: 1, 2: 8, 3: 64, 4: 256, 5: 1024}.get(tccrb & 7)
        duty = []
        for j in range(3):
            match, mode = data[0xA8 + 2 * j] | data[0xA9 + 2 * j] << 8, tccra >> (6 - 2 * j) & 3
            if not ddrh >> (3 + j) & 1:
                duty.append(0.0)
            elif not mode:
                duty.append(float(porth >> (3 + j) & 1))
            elif not (fast and prescaler):
                raise RuntimeError(f"timer 4 in a mode that is not foreseen: TCCR4A {tccra:#x}, TCCR4B {tccrb:#x}")
            else:
                high = max(0, top - match) if mode == 3 else min(match, top) + 1
                duty.append(high / (top + 1))
        high = porta & ddra
        return Pins(
            tuple(duty),
            tuple(high >> j & 1 for j in range(3)),
            tuple(high >> (4 + j) & 1 for j in range(3)),
            bool(data[0x28] & data[0x27] & 0x80),
            _F / prescaler / (top + 1) if fast and prescaler else 0.0,
        )
