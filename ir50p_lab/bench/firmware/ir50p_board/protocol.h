// The same as ir50p_lab/bench/protocol.py: change both; a test compares them.
// The wire: what each name means is explained in ir50p_lab/bench/protocol.py. All numbers are little endian.
#pragma once
#include <stdint.h>

namespace protocol {

const uint8_t VERSION = 2;
const uint32_t BAUD = 500000;
const uint8_t JOINTS = 3;
const uint8_t LIMIT_PWM = 255;
const uint8_t COMMAND_SYNC = 165;
const uint8_t REPLY_SYNC = 90;
const uint8_t HELLO = 72;
const uint8_t NAME = 78;
const uint8_t DRIVE = 68;
const uint8_t STOP = 83;
const uint8_t STATE = 115;
const uint8_t IDENTITY = 104;
const uint8_t GRIPPER = 1;
const uint8_t WATCHDOG_TRIPPED = 1;
const uint8_t HELLO_NEEDED = 16;
const uint8_t HARDWARE_RESET = 32;
const uint8_t WATCHDOG_MS = 100;
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

struct __attribute__((packed)) Identity {  // board to computer: answer to HELLO and NAME
  uint8_t sync, seq, type;
  char magic[2];
  uint8_t protocol, firmware[2], board_id[3];
  uint16_t boot;
  uint8_t reset_cause;
  uint32_t crc;
};

static_assert(sizeof(Command) == COMMAND_SIZE, "Command differs from protocol.py");
static_assert(sizeof(State) == REPLY_SIZE, "State differs from protocol.py");
static_assert(sizeof(Identity) == REPLY_SIZE, "Identity differs from protocol.py");

const uint32_t CRC_POLYNOMIAL = 0xEDB88320;  // CRC-32 of zlib, lowest bit first

}  // namespace protocol
