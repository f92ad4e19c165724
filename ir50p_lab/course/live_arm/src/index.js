// LiveArm in the browser: an anywidget's render, and mount() for a page without a kernel.
// State (see view.py): options, q, layers, poses, track, shape.
import { frames, jacobian, reach, tip } from "./kinematics.js";
import { make } from "./page.js";
import * as renderer from "./renderer.js";
import { View } from "./view.js";

// Without WebGL the kernel draws: a picture of the same view.
function picture({ model, el }) {
  const image = make("img", { alt: model.get("description") }, { style: "max-width: 100%" });
  const show = (message, buffers) => {
    if ("picture" in message) image.src = URL.createObjectURL(new Blob([buffers[0]], { type: "image/png" }));
  };
  const ask = () => model.send({ picture: true });
  model.on("msg:custom", show);
  model.on("change:q", ask);
  el.append(image);
  ask();
  return () => { model.off("msg:custom", show); model.off("change:q", ask); };
}

export function render({ model, el }) {
  if (!renderer.possible()) return picture({ model, el });
  const view = new View(model, el);
  return () => view.close();
}

// On a page without a kernel. state: as the widget's, track as base64. Returns whether the view could be made.
export function mount(el, state) {
  if (!renderer.possible()) return false;
  const bytes = Uint8Array.from(atob(state.track), (letter) => letter.charCodeAt(0));
  const values = { ...state, track: bytes };
  const model = {
    isPage: true, get: (name) => values[name], set: (name, value) => { values[name] = value; },
    save_changes() {}, send() {}, on() {}, off() {},
  };
  el.replaceChildren();
  new View(model, el);
  return true;
}

export const inspect = { figures: renderer.figures, frames: (l, q) => frames(l, q).map((T) => T.clone().transpose().toArray()), jacobian, reach, tip };
