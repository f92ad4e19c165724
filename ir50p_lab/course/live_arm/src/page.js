// The pieces of a view's page: everything around the canvas.
import CSS from "./style.css";

export function make(tag, properties = {}, attributes = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// Names with their colours, null for a name without: [[colour, name], ...].
export function showLegend(element, entries) {
  element.replaceChildren(...entries.filter(([, name]) => name).map(([colour, name]) =>
    make("span", {}, {}, ...(colour ? [make("i", { style: `background:${colour}` })] : []), name)));
}

const degrees = (rad) => (rad * 180) / Math.PI;

export function layout(badge) {
  const parts = {
    canvas: make("canvas", { tabIndex: 0 }, { role: "img" }),
    badge: make("span", { className: `la-badge${badge === "yours" ? " yours" : ""}`, textContent: badge, title: "whose code moves this arm" }),
    legend: make("span", { className: "la-legend" }),
    keys: make("span", { className: "la-legend" }),
    tip: make("span", { className: "la-tip" }),
    layers: make("div"),
    note: make("div", { className: "la-note" }, { "aria-live": "polite" }),
    side: make("div", { className: "la-side", hidden: true }),
    player: make("div", { className: "la-bar", hidden: true }),
    joints: make("div", { className: "la-bar" }),
  };
  const menu = make("details", { className: "la-layers" }, {}, make("summary", { textContent: "Layers" }), parts.layers);
  const top = make("div", { className: "la-top" }, {}, parts.badge, parts.legend, parts.keys, parts.tip, menu);
  parts.stage = make("div", { className: "la-stage" }, {}, parts.canvas, top, parts.note);
  const view = make("div", { className: "la-view" }, {}, parts.stage, parts.player, parts.joints);
  // JupyterLab takes keys for itself, unless told; here they belong to sliders and view
  parts.box = make("div", { className: "la" }, { "data-lm-suppress-shortcuts": "true" },
    make("style", { textContent: CSS }), make("div", { className: "la-main" }, {}, view, parts.side));
  parts.box.addEventListener("keydown", (event) => event.stopPropagation());
  return parts;
}

// Switches of the layers, which keep the set `on`; changed: called after each; clear: of the button.
export function fillMenu(menu, names, on, clear, changed) {
  for (const name of names) {
    const tick = make("input", { type: "checkbox", checked: on.has(name) });
    tick.addEventListener("change", () => {
      on[tick.checked ? "add" : "delete"](name);
      changed();
    });
    menu.append(make("label", {}, {}, tick, ` ${name}`));
  }
  const button = make("button", { textContent: "clear trail" });
  button.addEventListener("click", clear);
  menu.append(button);
}

// Sliders of the joints in whole degrees; moved(joint, rad). Returns show(q).
export function jointSliders(bar, limits, moved) {
  const rows = limits.map(([low, high], i) => {
    const range = make("input", { type: "range", step: 1, min: Math.ceil(degrees(low)), max: Math.floor(degrees(high)) },
      { "aria-label": `joint ${i + 1} in degrees` });
    const read = make("span", { className: "la-read" });
    range.addEventListener("input", () => moved(i, (range.value * Math.PI) / 180));
    bar.append(make("label", {}, {}, `joint ${i + 1}`, range, read));
    return { range, read };
  });
  return (q) => rows.forEach(({ range, read }, i) => {
    range.value = degrees(q[i]);
    read.textContent = degrees(q[i]).toFixed(0).replace("-", "\u2212") + "°";
  });
}

// Play, time, speed. orders: {toggle, seek, speed}. Returns show({t, start, end, playing, live, rate}).
export function playerBar(bar, orders) {
  const button = make("button", { className: "la-play" }, { "aria-label": "play or pause" });
  const scrub = make("input", { type: "range", min: 0, max: 1000, step: 1 }, { "aria-label": "time" });
  const clock = make("span", { className: "la-read" });
  const speed = make("select", {}, { "aria-label": "speed" }, ...[0.1, 0.25, 0.5, 1, 2, 5].map((v) => make("option", { value: v, textContent: `${v}×` })));
  bar.append(button, make("label", { style: "flex: 4 1 200px" }, {}, scrub, clock), speed);
  button.addEventListener("click", orders.toggle);
  scrub.addEventListener("input", () => orders.seek(scrub.value / 1000));
  speed.addEventListener("change", () => orders.speed(+speed.value));
  return ({ t, start, end, playing, live, rate }) => {
    button.textContent = playing ? "❚❚" : "▶";
    button.disabled = scrub.disabled = live;
    scrub.value = end > start ? (1000 * (t - start)) / (end - start) : 0;
    clock.textContent = live ? `live, ${t.toFixed(1)} s` : `${t.toFixed(2)} of ${end.toFixed(2)} s`;
    speed.value = rate;
  };
}
