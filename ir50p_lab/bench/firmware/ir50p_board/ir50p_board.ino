// IR50P board: the firmware of the robot arm's Arduino Mega 2560.
//
// The computer decides, the board obeys - within limits. It measures three potentiometers, sets three motor bridges
// (L6203) and an optional gripper, and keeps the arm safe when the computer, the cable or this sketch itself fails:
//   1. no drive before the computer has said hello (a board that has restarted waits);
//   2. no valid drive command for 100 ms: brake, and stay so until the computer has stopped and measured;
//   3. a joint at an end of its potentiometer is not driven further out; a broken wire stops its joint altogether;
//   4. the sketch hangs: the processor's own watchdog brakes after 30 ms and restarts the board after 60 ms.
// The wire is described in protocol.py, wiring and first power-on in README.md.

#include <avr/eeprom.h>
#include <avr/wdt.h>
#include <util/atomic.h>
#include "protocol.h"

using namespace protocol;

const uint8_t FIRMWARE[2] = {1, 1};

// ---- pins: all three PWM outputs belong to timer 4, so that one setting gives all of them 20 kHz

const uint8_t PWM_PIN[JOINTS] = {6, 7, 8};           // IN1 of the bridges (OC4A, OC4B, OC4C)
const uint8_t DIRECTION_PIN[JOINTS] = {22, 23, 24};  // IN2
const uint8_t ENABLE_PIN[JOINTS] = {26, 27, 28};     // ENABLE, each with a resistor to ground
const uint8_t POT_CHANNEL[JOINTS] = {0, 1, 2};       // A0, A1, A2
const uint8_t GRIPPER_PIN = 30;                      // high: closed

// ---- state

int16_t command[JOINTS];     // PWM counts asked for, -255..255
bool driving = false;        // a drive command is being carried out: the watchdog counts
uint32_t last_drive;         // ms, when the last drive command came
bool greeted = false;        // the computer has said hello since the board started
bool tripped = false;        // the watchdog has cut the drive, and no stop or hello has come since
uint16_t bad_frames = 0;
uint16_t boot;               // number of this start
uint8_t reset_cause;         // MCUSR as found
uint8_t board_id[3];         // all 0xFF: none was given yet
uint8_t *const ID_PLACE = (uint8_t *)2;  // in the EEPROM, behind `boot`
bool was_hung;               // the last start was by the hardware watchdog

// ---- potentiometers: conversions run on their own, joint after joint; each joint keeps the sum of its last 16

const uint8_t CONVERSIONS = 16;
const uint8_t START_CONVERSION =  // 125 kHz clock, for full accuracy: 0.1 ms a conversion, 5 ms for all joints' 16
    _BV(ADEN) | _BV(ADSC) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);

volatile uint16_t sum[JOINTS];
volatile uint8_t rounds = 0;  // of conversions, one of each joint

ISR(ADC_vect) {
  static uint16_t history[JOINTS][CONVERSIONS];
  static uint8_t joint = 0, place = 0;
  uint16_t value = ADC;
  sum[joint] += value - history[joint][place];  // the newest in, the oldest out
  history[joint][place] = value;
  if (++joint == JOINTS) {
    joint = 0;
    place = (place + 1) % CONVERSIONS;
    rounds++;
  }
  ADMUX = _BV(REFS0) | POT_CHANNEL[joint];  // reference: the 5 V that feed the potentiometers
  ADCSRA = START_CONVERSION;
}

// Mean of the last 16 conversions in quarter counts, 0..4092.
uint16_t counts(uint8_t joint) {
  uint16_t total;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { total = sum[joint]; }
  return (total + CONVERSIONS / SUBCOUNTS / 2) / (CONVERSIONS / SUBCOUNTS);
}

void start_potentiometers() {
  ADMUX = _BV(REFS0) | POT_CHANNEL[0];
  ADCSRA = START_CONVERSION;
  while (rounds < CONVERSIONS) {}  // before that the means are too low
}

// ---- bridges

const int16_t TOP = 799;  // 16 MHz / (TOP + 1) = 20 kHz: above hearing

// IN1 is high for `ticks` (0..TOP) of the TOP + 1 ticks of a period. The output is inverted (low first, high from the
// match on), because then 0 is truly 0; not inverted, the shortest pulse a timer gives is one tick.
void set_high_time(uint8_t joint, uint16_t ticks) {
  volatile uint16_t *match[JOINTS] = {&OCR4A, &OCR4B, &OCR4C};
  *match[joint] = TOP - ticks;
}

static_assert((LIMIT_PWM * 803L >> 8) == TOP, "full drive must be the whole period");

// Sign and magnitude. Forward: IN2 low, IN1 high for that share of the time. Backward: IN2 high, IN1 *low* for that
// share. In the rest of the time both are equal, and the bridge shorts the motor: it brakes, as it does at pwm = 0.
void drive_joint(uint8_t joint, int16_t pwm) {
  uint16_t ticks = (uint32_t)abs(pwm) * 803 >> 8;  // 803/256 is TOP/LIMIT_PWM: this processor divides slowly
  set_high_time(joint, pwm < 0 ? TOP + 1 - ticks : ticks);
  digitalWrite(DIRECTION_PIN[joint], pwm < 0);
}

void start_bridges() {
  TCCR4A = _BV(WGM41) | _BV(COM4A1) | _BV(COM4A0) | _BV(COM4B1) | _BV(COM4B0) | _BV(COM4C1) | _BV(COM4C0);
  TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS40);  // fast PWM up to ICR4, no prescaler
  ICR4 = TOP;                                    // after the mode: in others the processor ignores it
  TCNT4 = 0;
  for (uint8_t j = 0; j < JOINTS; j++) drive_joint(j, 0);
  delayMicroseconds(100);  // two periods: the timer takes new times over at the end of one
  for (uint8_t j = 0; j < JOINTS; j++) {
    pinMode(PWM_PIN[j], OUTPUT);
    pinMode(DIRECTION_PIN[j], OUTPUT);
    pinMode(ENABLE_PIN[j], OUTPUT);
    digitalWrite(ENABLE_PIN[j], HIGH);  // last: only now do the bridges listen
  }
  pinMode(GRIPPER_PIN, OUTPUT);
}

// ---- safety

// All joints brake until the next drive command. The gripper stays as it is: it may hold something.
void cut() {
  driving = false;
  for (uint8_t j = 0; j < JOINTS; j++) {
    command[j] = 0;
    drive_joint(j, 0);
  }
}

bool broken_wire(uint16_t position) {
  return position < BROKEN_COUNTS || position > MAX_COUNTS - BROKEN_COUNTS;
}

// Positive drive raises the counts (the first power-on check of README.md makes it so).
bool limited(uint8_t joint) {
  uint16_t position = counts(joint);
  return broken_wire(position) || (position < LOW_COUNTS && command[joint] < 0) ||
         (position > HIGH_COUNTS && command[joint] > 0);
}

void drive() {
  for (uint8_t j = 0; j < JOINTS; j++) drive_joint(j, limited(j) ? 0 : command[j]);
}

void watch_computer() {
  if (driving && millis() - last_drive >= WATCHDOG_MS) {
    cut();
    tripped = true;
  }
}

// Memory that a reset leaves alone: tells a restart after a hang from other restarts. (MCUSR would, but most boot
// loaders clear it.)
const uint16_t HUNG = 0xDEAD;
uint16_t mark __attribute__((section(".noinit")));

// The loop has not come round for 30 ms. The same time again and the processor is reset; also if this interrupt could
// not run, because the sketch hangs with interrupts off.
ISR(WDT_vect) {
  cut();
  mark = HUNG;
}

void start_hardware_watchdog() {
  wdt_enable(WDTO_30MS);
  WDTCSR |= _BV(WDIE);  // first the interrupt above, then the reset
}

// ---- frames

uint32_t crc_table[256];  // what a byte does to the check: five times as fast as bit by bit

void make_crc_table() {
  for (uint16_t i = 0; i < 256; i++) {
    uint32_t crc = i;
    for (uint8_t bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ CRC_POLYNOMIAL : crc >> 1;
    crc_table[i] = crc;
  }
}

uint32_t crc32(const void *data, uint8_t length) {
  uint32_t crc = 0xFFFFFFFF;
  for (const uint8_t *byte = (const uint8_t *)data; length--; byte++)
    crc = crc >> 8 ^ crc_table[(uint8_t)crc ^ *byte];
  return ~crc;
}

bool valid(const Command &frame) {
  for (uint8_t j = 0; j < JOINTS; j++)
    if (frame.pwm[j] < -LIMIT_PWM || frame.pwm[j] > LIMIT_PWM) return false;
  return frame.flags <= GRIPPER && frame.crc == crc32(&frame, sizeof frame - sizeof frame.crc);
}

// Whether these first `length` bytes are, or may become, a valid command. (Said early: a flood of noise costs no time.)
bool promising(const Command &frame, uint8_t length) {
  if (frame.sync != COMMAND_SYNC) return false;
  if (length > 2 && frame.type != HELLO && frame.type != NAME && frame.type != DRIVE && frame.type != STOP) return false;
  return length < COMMAND_SIZE || valid(frame);
}

// All replies are REPLY_SIZE long; the last four bytes are the check.
void send(void *reply) {
  // Never wait for the line: a loop that waits does not watch. The computer asks again.
  if (Serial.availableForWrite() < REPLY_SIZE) return;
  uint32_t crc = crc32(reply, REPLY_SIZE - sizeof crc);
  memcpy((uint8_t *)reply + REPLY_SIZE - sizeof crc, &crc, sizeof crc);
  Serial.write((const uint8_t *)reply, REPLY_SIZE);
}

void send_identity(uint8_t seq) {
  Identity reply = {REPLY_SYNC, seq, IDENTITY, {MAGIC[0], MAGIC[1]}, VERSION, {FIRMWARE[0], FIRMWARE[1]},
                    {board_id[0], board_id[1], board_id[2]}, boot, reset_cause, 0};
  send(&reply);
}

void send_state(uint8_t seq) {
  State reply = {REPLY_SYNC, seq, STATE, {counts(0), counts(1), counts(2)}, 0, bad_frames, (uint16_t)millis(), 0};
  if (tripped) reply.status |= WATCHDOG_TRIPPED;
  if (!greeted) reply.status |= HELLO_NEEDED;
  if (was_hung) reply.status |= HARDWARE_RESET;
  for (uint8_t j = 0; j < JOINTS; j++)
    if (limited(j)) reply.status |= LIMIT_ACTIVE[j];
  send(&reply);
}

// The board's id is given once: what was measured on this bench is known by it.
void take_name(const Command &frame) {
  if (board_id[0] != 0xFF || board_id[1] != 0xFF || board_id[2] != 0xFF) return;
  for (uint8_t j = 0; j < JOINTS; j++) board_id[j] = frame.pwm[j];
  eeprom_update_block(board_id, ID_PLACE, sizeof board_id);  // 10 ms
}

void obey(const Command &frame) {
  if (frame.type == HELLO || frame.type == NAME) {
    cut();
    if (frame.type == NAME) take_name(frame);
    greeted = true;
    tripped = false;
    send_identity(frame.seq);
    return;
  }
  if (frame.type == STOP) cut();
  if (frame.type == DRIVE && greeted && !tripped) {
    for (uint8_t j = 0; j < JOINTS; j++) command[j] = frame.pwm[j];
    digitalWrite(GRIPPER_PIN, frame.flags & GRIPPER);
    driving = true;
    last_drive = millis();
    drive();
  }
  send_state(frame.seq);
  if (frame.type == STOP) tripped = false;  // told: it may drive again
}

// Drops what is no frame, up to the next sync byte: no good frame is lost to the noise before it. Returns what is left.
uint8_t resynchronise(uint8_t *bytes, uint8_t length) {
  if (bytes[0] == COMMAND_SYNC) bad_frames++;
  uint8_t next = 1;
  while (next < length && bytes[next] != COMMAND_SYNC) next++;
  memmove(bytes, bytes + next, length - next);
  return length - next;
}

void receive() {
  static Command frame;
  static uint8_t length = 0;
  uint8_t *bytes = (uint8_t *)&frame;
  for (uint8_t n = 0; n < COMMAND_SIZE && Serial.available(); n++) {  // not more: the loop must come round
    bytes[length++] = Serial.read();
    while (length && !promising(frame, length)) length = resynchronise(bytes, length);
    if (length == COMMAND_SIZE) {
      obey(frame);
      length = 0;
    }
  }
}

// ---- the sketch

void count_start() {
  was_hung = mark == HUNG;
  mark = 0;
  boot = eeprom_read_word((uint16_t *)0) + 1;
  eeprom_write_word((uint16_t *)0, boot);
}

void setup() {
  reset_cause = MCUSR;
  MCUSR = 0;  // else the watchdog of a hung sketch stays armed, at 15 ms
  wdt_disable();
  start_bridges();
  count_start();
  eeprom_read_block(board_id, ID_PLACE, sizeof board_id);
  make_crc_table();
  start_potentiometers();
  Serial.begin(BAUD);
  start_hardware_watchdog();
}

void loop() {
  static uint8_t last_rounds;
  receive();
  if ((uint8_t)(rounds - last_rounds) < 4) return;  // the rest every 1.25 ms
  last_rounds = rounds;
  wdt_reset();  // here, so that a converter that has stopped also counts as a hang
  watch_computer();
  drive();  // again and again: a joint may reach its limit between two commands
}
