// A motion: rows of float32 with the time first. Layout of a row: runs = [{label, q, reference, u}], numbers of the first
// of three columns each (reference and u may be null).
import { tip } from "./kinematics.js";

export class Track {
  constructor(bytes, { columns, runs, unit, source }) {
    // a DataView in a notebook, whose start need not be a multiple of four
    const own = bytes.buffer ? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) : bytes;
    this.data = new Float32Array(own);
    const rows = Math.floor(this.data.length / columns);
    const times = Array.from({ length: rows }, (_, row) => this.data[row * columns]);
    Object.assign(this, { columns, runs, unit, source, rows, times, start: times[0], end: times.at(-1) });
  }

  // The last row at or before t.
  row(t) {
    return Math.max(this.times.findLastIndex((time) => time <= t), 0);
  }

  // Three columns at time t, linear between the rows.
  at(t, first) {
    const a = this.row(t), b = Math.min(a + 1, this.rows - 1), span = this.times[b] - this.times[a];
    const part = span > 0 ? Math.min(Math.max((t - this.times[a]) / span, 0), 1) : 0;
    return [0, 1, 2].map((i) => this.value(a, first + i) * (1 - part) + this.value(b, first + i) * part);
  }

  value(row, column) {
    return this.data[row * this.columns + column];
  }

  // Where the tip has been, m: at every so many rows, and at the last.
  path(lengths, first, every = 1) {
    const rows = Array.from({ length: Math.ceil(this.rows / every) }, (_, k) => this.rows - 1 - every * k).reverse();
    return rows.map((row) => tip(lengths, [0, 1, 2].map((i) => this.value(row, first + i))));
  }
}

// Where the pose touches what it should not: a stop of a joint, the table. limits: null for an arm in space.
export function contacts(lengths, limits, q) {
  if (!limits) return { stops: [false, false, false], table: false };
  const stops = q.map((value, i) => value <= limits[i][0] + 0.01 || value >= limits[i][1] - 0.01);
  const elbow = lengths[0] + lengths[1] * Math.sin(q[1]);
  return { stops, table: Math.min(tip(lengths, q)[2], elbow) < 0.003 };
}
