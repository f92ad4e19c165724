// Curves over time beside the arm: a plot for each joint, one for the commands, and a cursor that the player shares.
import { contacts } from "./track.js";

const JOINT = ["#0072B2", "#D55E00", "#009E73"], RUN = ["#0072B2", "#009E73"], INK = "#333333";
const LEFT = 46, RIGHT = 14, TOP = 20, GAP = 24, BOTTOM = 34, APART = 11;
const SET_POINT = "set point", STOP = "at its stop", TABLE = "on the table";
const BANDS = { [STOP]: "#E69F0055", [TABLE]: "#56B4E955" };

const niceStep = (span, most) => {
  const scale = 10 ** Math.floor(Math.log10(span / most));
  return [1, 2, 5, 10].map((n) => n * scale).find((step) => span / step <= most);
};
const text = (value) => String(+value.toFixed(6)).replace("-", "\u2212");

export class Curves {
  // seek: called with the time of a press or drag on the curves.
  constructor(limits, lengths, seek) {
    Object.assign(this, { limits, lengths, track: null });
    this.canvas = document.createElement("canvas"); // the curves
    this.canvas.setAttribute("role", "img");
    this.cursor = document.createElement("canvas"); // over them: what moves
    this.cursor.className = "la-cursor";
    const pressed = (event) => {
      if (!this.track || !event.buttons) return;
      const box = this.canvas.getBoundingClientRect();
      const part = (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT);
      seek(this.t0 + Math.min(Math.max(part, 0), 1) * (this.t1 - this.t0));
    };
    this.canvas.addEventListener("pointerdown", pressed);
    this.canvas.addEventListener("pointermove", pressed);
  }

  load(track) {
    this.track = track;
    this.t0 = track.start;
    this.t1 = Math.max(track.end, track.start + 1e-3);
    const angles = [0, 1, 2].map((joint) => ({
      title: `joint ${joint + 1} [deg]`, least: 4,
      lines: track.runs.flatMap((run, k) => [
        ...(run.reference === null ? [] : [{ column: run.reference + joint, colour: INK, dash: [5, 4], scale: 180 / Math.PI }]),
        { column: run.q + joint, colour: track.runs.length > 1 ? RUN[k] : JOINT[joint], scale: 180 / Math.PI },
      ]),
    }));
    const driven = track.runs.filter((run) => run.u !== null).slice(0, 1);
    const commands = driven.map((run) => ({
      title: `command [${track.unit}]` + (track.runs.length > 1 ? `, ${run.label}` : ""), least: 1,
      lines: [0, 1, 2].map((joint) => ({ column: run.u + joint, colour: JOINT[joint], scale: 1, stairs: true, name: `${joint + 1}` })),
    }));
    this.plots = [...angles, ...commands].map((plot) => ({ ...plot, range: this.range(plot) }));
    this.touched = track.times.map((_, row) => contacts(this.lengths, this.limits, [0, 1, 2].map((i) => track.value(row, track.runs[0].q + i))));
    this.key = [
      ...(track.runs.some((run) => run.reference !== null) ? [SET_POINT] : []),
      ...(this.touched.some(({ stops }) => stops.includes(true)) ? [STOP] : []),
      ...(this.touched.some(({ table }) => table) ? [TABLE] : []),
    ];
    const said = track.runs.map((run) => run.label).filter(Boolean).join(" and ");
    this.canvas.setAttribute("aria-label", ["angles of the three joints over time", said, ...this.key].filter(Boolean).join(", "));
    this.drawn = null;
  }

  range({ lines, least }) {
    const values = lines.flatMap(({ column, scale }) => this.track.times.map((_, row) => this.track.value(row, column) * scale));
    const finite = values.filter(Number.isFinite), low = Math.min(...finite), high = Math.max(...finite);
    if (!finite.length) return [-1, 1];
    const spare = 0.08 * Math.max(high - low, least);
    return [low - spare, high + spare];
  }

  // The curves once; then only the cursor moves, on a canvas of its own: copying the curves for each frame is slow.
  draw(t, width, height) {
    const dots = Math.min(window.devicePixelRatio || 1, 2), size = [width, height, dots].join();
    if (this.drawn !== size) {
      this.drawn = size;
      for (const canvas of [this.canvas, this.cursor]) {
        Object.assign(canvas, { width: Math.round(width * dots), height: Math.round(height * dots) });
        Object.assign(canvas.style, { width: width + "px", height: height + "px" });
        canvas.getContext("2d").scale(dots, dots);
      }
      this.drawPlots(this.canvas.getContext("2d"), width, height);
    }
    const pen = this.cursor.getContext("2d");
    pen.clearRect(0, 0, width, height);
    const x = LEFT + ((t - this.t0) / (this.t1 - this.t0)) * (width - LEFT - RIGHT);
    pen.strokeStyle = "#CC79A7";
    pen.lineWidth = 1.6;
    pen.beginPath();
    pen.moveTo(x, TOP - 4);
    pen.lineTo(x, height - BOTTOM);
    pen.stroke();
    const row = this.track.row(t);
    for (const plot of this.plots) {
      for (const { column, colour, scale, dash } of plot.lines) {
        if (dash) continue;
        pen.fillStyle = colour;
        pen.beginPath();
        pen.arc(x, plot.Y(this.track.value(row, column) * scale), 3, 0, 2 * Math.PI);
        pen.fill();
      }
    }
  }

  drawPlots(pen, width, height) {
    const w = width - LEFT - RIGHT, h = (height - TOP - BOTTOM - GAP * (this.plots.length - 1)) / this.plots.length;
    const X = (t) => LEFT + ((t - this.t0) / (this.t1 - this.t0)) * w;
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, width, height);
    const xStep = niceStep(this.t1 - this.t0, 6);
    this.plots.forEach((plot, k) => {
      const y0 = TOP + k * (h + GAP), [low, high] = plot.range;
      plot.Y = (value) => y0 + h - ((value - low) / (high - low)) * h;
      if (k < 3) this.shadeContacts(pen, k, X, y0, h);
      Object.assign(pen, { lineWidth: 1, strokeStyle: "#E6E6E6", fillStyle: "#555555", font: "11px sans-serif", textBaseline: "middle" });
      pen.setLineDash([]);
      const rule = (x1, y1, x2, y2) => { pen.beginPath(); pen.moveTo(x1, y1); pen.lineTo(x2, y2); pen.stroke(); };
      const yStep = niceStep(high - low, Math.max(2, Math.floor(h / 24)));
      pen.textAlign = "right";
      for (let value = Math.ceil(low / yStep) * yStep; value <= high; value += yStep) {
        rule(LEFT, plot.Y(value), LEFT + w, plot.Y(value));
        pen.fillText(text(value), LEFT - 5, plot.Y(value));
      }
      pen.textAlign = "center";
      for (let t = Math.ceil(this.t0 / xStep - 1e-6) * xStep; t <= this.t1 + 1e-6; t += xStep) {
        rule(X(t), y0, X(t), y0 + h);
        if (k === this.plots.length - 1) pen.fillText(text(t), X(t), y0 + h + 10);
      }
      pen.strokeStyle = "#666666";
      rule(LEFT, y0, LEFT, y0 + h);
      rule(LEFT, y0 + h, LEFT + w, y0 + h);
      const ends = plot.lines.map((line) => ({ ...line, y: this.stroke(pen, line, X, plot.Y) }));
      pen.setLineDash([]);
      Object.assign(pen, { fillStyle: INK, textAlign: "left", font: "600 11px sans-serif" });
      pen.fillText(plot.title, LEFT, y0 - 9);
      let below = y0; // names at the ends of curves, none over another
      for (const { name, colour, y } of ends.filter((line) => line.name).sort((a, b) => a.y - b.y)) {
        below = Math.max(y, below + APART);
        pen.fillStyle = colour;
        pen.fillText(name, X(this.t1) + 3, below);
      }
    });
    this.drawKey(pen, height - 9);
    Object.assign(pen, { textAlign: "right", fillStyle: INK, font: "12px sans-serif" });
    pen.fillText("time [s]", LEFT + w, height - 9);
  }

  // What dashes and bands mean, in a line.
  drawKey(pen, y) {
    Object.assign(pen, { textAlign: "left", font: "11px sans-serif", strokeStyle: INK });
    let x = LEFT;
    for (const name of this.key) {
      pen.fillStyle = BANDS[name];
      if (name === SET_POINT) for (const dash of [0, 9]) pen.strokeRect(x + dash, y, 5, 0);
      else pen.fillRect(x, y - 6, 14, 12);
      pen.fillStyle = INK;
      pen.fillText(name, x + 18, y);
      x += 30 + pen.measureText(name).width;
    }
  }

  // Returns where the curve ends.
  stroke(pen, { column, colour, dash = [], scale, stairs }, X, Y) {
    Object.assign(pen, { strokeStyle: colour, lineWidth: dash.length ? 1.3 : 1.8, lineJoin: "round" });
    pen.setLineDash(dash);
    pen.beginPath();
    let last = null;
    for (let row = 0; row < this.track.rows; row++) {
      const x = X(this.track.times[row]), y = Y(this.track.value(row, column) * scale);
      if (stairs && last !== null) pen.lineTo(x, last);
      pen.lineTo(x, y);
      last = y;
    }
    pen.stroke();
    return last;
  }

  // Bands where a joint is at its stop, and under all joints where the arm touches the table.
  shadeContacts(pen, joint, X, y0, h) {
    this.touched.slice(0, -1).forEach(({ stops, table }, row) => {
      const from = X(this.track.times[row]);
      for (const name of [...(stops[joint] ? [STOP] : []), ...(table ? [TABLE] : [])]) {
        pen.fillStyle = BANDS[name];
        pen.fillRect(from, y0, X(this.track.times[row + 1]) - from, h);
      }
    });
  }
}
