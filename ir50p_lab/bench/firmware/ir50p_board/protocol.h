// Written by `python -m ir50p_lab.bench.protocol`: change protocol.py, not this file.
// The wire: what each name means is explained in ir50p_lab/bench/protocol.py. All numbers are little endian.
#pragma once
#include <stdint.h>

namespace protocol {

const uint8_t VERSION = 1;
const uint32_t BAUD = 500000;
const uint8_t JOINTS = 3;
const uint8_t LIMIT_PWM = 255;
const uint8_t COMMAND_SYNC = 165;
const uint8_t REPLY_SYNC = 90;
const uint8_t HELLO = 72;
const uint8_t DRIVE = 68;
const uint8_t STOP = 83;
const uint8_t STATE = 115;
const uint8_t IDENTITY = 104;
const uint8_t GRIPPER = 1;
const uint8_t WATCHDOG_TRIPPED = 1;
const uint8_t HELLO_NEEDED = 16;
const uint8_t HARDWARE_RESET = 32;
const uint8_t HAS_GRIPPER = 1;
const uint8_t WATCHDOG_MS = 100;
const uint8_t ADC_BITS = 10;
const uint8_t SUBCOUNTS = 4;
const int16_t MAX_COUNTS = 4092;
const uint8_t LOW_COUNTS = 40;
const int16_t HIGH_COUNTS = 4052;
const uint8_t BROKEN_COUNTS = 12;
const uint8_t COMMAND_SIZE = 14;
const uint8_t REPLY_SIZE = 18;
const uint8_t LIMIT_ACTIVE[JOINTS] = {2, 4, 8};
const char MAGIC[2] = {'I', 'R'};

struct __attribute__((packed)) Command {  // computer to board
  uint8_t sync, seq, type;
  int16_t pwm[JOINTS];
  uint8_t flags;
  uint32_t crc;
};

struct __attribute__((packed)) State {  // board to computer: answer to DRIVE and STOP
  uint8_t sync, seq, type;
  uint16_t counts[JOINTS];
  uint8_t status;
  uint16_t bad_frames, clock_ms;
  uint32_t crc;
};

struct __attribute__((packed)) Identity {  // board to computer: answer to HELLO
  uint8_t sync, seq, type;
  char magic[2];
  uint8_t protocol, firmware[2], joints, adc_bits, features;
  uint16_t boot;
  uint8_t reset_cause;
  uint32_t crc;
};

static_assert(sizeof(Command) == COMMAND_SIZE, "Command differs from protocol.py");
static_assert(sizeof(State) == REPLY_SIZE, "State differs from protocol.py");
static_assert(sizeof(Identity) == REPLY_SIZE, "Identity differs from protocol.py");

// CRC-32 of the sixteen half bytes.
const uint32_t CRC_TABLE[16] = {
  0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC,
  0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
  0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
  0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};

}  // namespace protocol
