// The browser's side of canvas.py: a picture that hears clicks, and plots of samples.
const niceStep = (span, most) => {
  const scale = 10 ** Math.floor(Math.log10(span / most));
  return [1, 2, 5, 10].map((n) => n * scale).find((step) => span / step <= most);
};
const digits = (v, step) => (Math.abs(v) < 1e-9 ? 0 : v).toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9))).replace("-", "\u2212");

// As a data URL a picture is shown two frames earlier than as a blob, which goes through another process of the browser.
function dataUrl(bytes) {
  const parts = [];
  for (let k = 0; k < bytes.byteLength; k += 0x8000) {
    parts.push(String.fromCharCode(...new Uint8Array(bytes.buffer, bytes.byteOffset + k, Math.min(0x8000, bytes.byteLength - k))));
  }
  return "data:image/png;base64," + btoa(parts.join(""));
}

function picture(model, el) {
  const img = Object.assign(document.createElement("img"), { alt: model.get("description"), decoding: "sync" });
  const show = () => { img.src = dataUrl(model.get("value")); };
  img.style.cssText = `width:${model.get("width")};max-width:100%;cursor:${model.get("clickable") ? "crosshair" : "default"}`;
  img.addEventListener("click", (event) => {
    const box = img.getBoundingClientRect();
    const at = [(event.clientX - box.left) / box.width, (box.bottom - event.clientY) / box.height];
    model.set("clicked", [...at, event.timeStamp]);
    model.save_changes();
  });
  img.addEventListener("dragstart", (event) => event.preventDefault());
  el.append(img);
  model.set("ratio", Math.min(Math.max(window.devicePixelRatio || 1, 1), 2));
  model.save_changes();
  model.on("change:value", show);
  show();
  return () => model.off("change:value", show);
}

function plot(pen, panel, rows, settings, marks, box, kept) {
  const [x0, y0, w, h] = box, n = rows.length, columns = panel.lines.map((line) => line.column);
  const last = n ? rows[n - 1][0] : 0, t1 = Math.max(last, settings.window), t0 = t1 - settings.window;
  let range = panel.ylim ?? kept.get(panel);
  if (!panel.ylim) {
    const values = rows.flatMap((row) => columns.map((c) => row[c])), low = Math.min(...values), high = Math.max(...values);
    const spare = Math.max(0.08 * (high - low), 2);
    if (n && (!range || low < range[0] || high > range[1] || range[1] - range[0] > 3 * (high - low + 2 * spare))) range = [low - spare, high + spare];
    kept.set(panel, range);
    range ??= [-10, 10];
  }
  const X = (t) => x0 + ((t - t0) / (t1 - t0)) * w, Y = (v) => y0 + h - ((v - range[0]) / (range[1] - range[0])) * h;
  const rule = (a, b, c, d) => { pen.beginPath(); pen.moveTo(a, b); pen.lineTo(c, d); pen.stroke(); };
  Object.assign(pen, { lineWidth: 1, strokeStyle: "#E6E6E6", fillStyle: "#555555", font: "11px sans-serif", textBaseline: "middle", textAlign: "right" });
  pen.setLineDash([]);
  const yStep = panel.yStep ?? niceStep(range[1] - range[0], 6), xStep = niceStep(t1 - t0, w > 400 ? 8 : 5);
  for (let v = Math.ceil(range[0] / yStep) * yStep; v <= range[1]; v += yStep) { rule(x0, Y(v), x0 + w, Y(v)); pen.fillText(digits(v, yStep), x0 - 5, Y(v)); }
  pen.textAlign = "center";
  for (let t = Math.ceil(t0 / xStep - 1e-9) * xStep; t <= t1 + 1e-9; t += xStep) { rule(X(t), y0, X(t), y0 + h); if (panel.times) pen.fillText(digits(t, xStep), X(t), y0 + h + 10); }
  pen.strokeStyle = "#666666";
  rule(x0, y0, x0, y0 + h); rule(x0, y0 + h, x0 + w, y0 + h);
  pen.save(); pen.beginPath(); pen.rect(x0, y0, w, h); pen.clip();
  Object.assign(pen, { strokeStyle: "#C0392B", lineWidth: 1.5 });
  pen.setLineDash([2, 3]);
  for (const t of marks) rule(X(t), y0, X(t), y0 + h);
  for (const { column, colour, dash, stairs, level } of panel.lines) {
    Object.assign(pen, { strokeStyle: colour, lineWidth: dash ? 1.3 : 1.8, lineJoin: "round" });
    if (level != null) { pen.setLineDash([6, 4]); rule(x0, Y(level), x0 + w, Y(level)); }
    pen.setLineDash(dash ? [6, 4] : []);
    pen.beginPath();
    rows.forEach((row, k) => {
      if (stairs && k) pen.lineTo(X(row[0]), Y(rows[k - 1][column]));
      pen.lineTo(X(row[0]), Y(Math.max(-1e6, Math.min(1e6, row[column]))));
    });
    pen.stroke();
  }
  pen.restore();
  pen.setLineDash([]);
  const write = (text, x, y, align, colour, font) => { Object.assign(pen, { textAlign: align, fillStyle: colour, font }); pen.fillText(text, x, y); };
  write(panel.title, x0, y0 - 14, "left", panel.colour, "600 13px sans-serif");
  if (panel.times) write("time [s]", x0 + w / 2, y0 + h + 26, "center", "#333333", "12px sans-serif");
  let side = 0;
  for (const { column, colour, label } of panel.lines) {
    if (!label) continue;
    const value = n ? ": " + rows[n - 1][column].toPrecision(3).replace("-", "\u2212") : "";
    if (settings.side) write(label + value, x0 + w + 12, y0 + 14 + 20 * side++, "left", colour, "12px sans-serif");
    else write(label + value, x0 + w, y0 - 14, "right", colour, "12px sans-serif");
  }
  pen.save(); pen.translate(14, y0 + h / 2); pen.rotate(-Math.PI / 2);
  write(panel.ylabel, 0, 0, "center", "#333333", "12px sans-serif");
  pen.restore();
}

function plots(model, el) {
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d"), kept = new Map();
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", model.get("settings").description);
  el.append(canvas);
  let wanted = false;
  const draw = () => {
    wanted = false;
    const settings = model.get("settings"), bytes = model.get("samples"), dots = window.devicePixelRatio || 1;
    const data = new Float32Array(bytes.buffer ? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) : bytes);
    const rows = Array.from({ length: Math.floor(data.length / settings.columns) }, (_, k) => data.subarray(k * settings.columns, (k + 1) * settings.columns));
    const width = Math.min(Math.max(el.clientWidth, 480), 1060), height = settings.height;
    Object.assign(canvas, { width: width * dots, height: height * dots });
    Object.assign(canvas.style, { width: width + "px", height: height + "px" });
    pen.setTransform(dots, 0, 0, dots, 0, 0);
    pen.fillStyle = "white";
    pen.fillRect(0, 0, width, height);
    const w = width - 62 - (settings.side || 8), h = height - 30 - 38;
    for (const panel of settings.panels) {
      const [left, top, across, down] = panel.place;
      plot(pen, panel, rows, settings, model.get("marks"), [62 + left * w, 30 + top * h, across * w, down * h], kept);
    }
  };
  const soon = () => { if (!wanted) { wanted = true; requestAnimationFrame(draw); } };
  model.on("change:samples", soon);
  const watch = new ResizeObserver(soon);
  watch.observe(el);
  return () => { model.off("change:samples", soon); watch.disconnect(); };
}

export default { render: ({ model, el }) => (model.get("settings").panels ? plots : picture)(model, el) };
