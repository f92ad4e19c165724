"""Compile the sketch as the Arduino IDE does, with Debian's avr-gcc and Arduino core; keep the result for next time."""

import functools
import hashlib
import os
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

SKETCH = Path(__file__).parents[2] / "ir50p_lab/bench/firmware/ir50p_board"
ARDUINO = Path("/usr/share/arduino/hardware/arduino/avr")
PACKAGES = "gcc-avr avr-libc binutils-avr arduino-core-avr libsimavr2"

# as in boards.txt and platform.txt of the Arduino core; this gcc needs DECIMAL_DIG told
_MACHINE = (
    "-mmcu=atmega2560 -DF_CPU=16000000L -DARDUINO=10819 -DARDUINO_AVR_MEGA2560 -DARDUINO_ARCH_AVR "
    f"-DDECIMAL_DIG=__DECIMAL_DIG__ -I{ARDUINO}/cores/arduino -I{ARDUINO}/variants/mega "
    "-Os -g -ffunction-sections -fdata-sections -flto"
).split()
_CXX = "-std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics".split()
_STRICT = "-Wall -Wextra -Werror".split()


def require():
    """Skip the calling test where compiler or emulator are absent (CI counts a skip as a failure)."""
    missing = [tool for tool in ("avr-gcc", "avr-g++", "avr-objcopy") if not shutil.which(tool)]
    missing += [] if (ARDUINO / "cores/arduino/Arduino.h").exists() else ["the Arduino core"]
    if missing:
        pytest.skip(f"no {', '.join(missing)}; on Debian or Ubuntu: sudo apt-get install {PACKAGES}")


@functools.cache
def firmware(*flags):
    """Path of the sketch as ELF file, compiled with all warnings as errors. flags: e.g. "-DHANG_ON_REQUEST"."""
    require()
    sources = sorted(SKETCH.iterdir())
    state = repr([flags, _MACHINE, _CXX, _STRICT, [path.read_bytes() for path in sources]])
    elf = _folder() / f"board-{hashlib.sha1(state.encode()).hexdigest()[:16]}.elf"
    if not elf.exists():
        with tempfile.TemporaryDirectory(dir=elf.parent) as scratch:
            part, made = Path(scratch, "sketch.o"), Path(scratch, "board.elf")
            sketch = f"-include Arduino.h -x c++ -c {SKETCH / 'ir50p_board.ino'} -o {part}".split()
            _call("avr-g++", *_STRICT, *_CXX, *_MACHINE, *flags, *sketch)
            link = "-Os -g -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega2560".split()
            _call("avr-gcc", *link, "-o", made, part, _core(), "-lm")
            made.replace(elf)  # at once: several tests may build at a time
    return elf


def _core():
    """The Arduino core as a library."""
    archive = _folder() / f"core-{hashlib.sha1(repr([_MACHINE, _CXX]).encode()).hexdigest()[:16]}.a"
    if not archive.exists():
        with tempfile.TemporaryDirectory(dir=archive.parent) as scratch, ThreadPoolExecutor(2) as pool:
            sources = [p for p in sorted((ARDUINO / "cores/arduino").iterdir()) if p.suffix in (".c", ".cpp", ".S")]
            objects = list(pool.map(functools.partial(_compile, scratch), sources))
            made = Path(scratch, "core.a")
            _call("avr-gcc-ar", "rcs", made, *objects)
            made.replace(archive)
    return archive


def _compile(folder, source):
    made = Path(folder, source.name + ".o")
    kinds = {
        ".c": ["avr-gcc", "-std=gnu11", "-fno-fat-lto-objects"],
        ".cpp": ["avr-g++", *_CXX],
        ".S": ["avr-gcc", "-x", "assembler-with-cpp"],
    }
    _call(*kinds[source.suffix], "-w", *_MACHINE, "-c", source, "-o", made)
    return made


def _folder():
    folder = Path(tempfile.gettempdir(), f"ir50p-firmware-{os.getuid()}")
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder


def _call(*command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{(done.stdout + done.stderr)[:4000]}"
