// One WebGL context for all views of a page: each view is drawn off the page and copied to its own 2-D canvas, so that
// twenty views lose no context. The resolution while something moves follows from the time the first frames took.
import { WebGLRenderer } from "three";

const FRAME = 22; // ms that a moving frame may take
const SHOWING = 4.5; // without a GPU, copying and showing a frame takes this many times as long as drawing it
let renderer = null, cost = Infinity, timed = 0; // cost: ms of a frame at one pixel per CSS pixel

function make() {
  renderer = new WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
  renderer.setPixelRatio(1);
  renderer.setScissorTest(true);
  renderer.domElement.addEventListener("webglcontextlost", (event) => event.preventDefault());
  renderer.domElement.addEventListener("webglcontextrestored", () => views.forEach((view) => view.soon()));
}

const views = new Set();
export const enter = (view) => views.add(view);
export const leave = (view) => views.delete(view);

// Whether this browser has WebGL.
export function possible() {
  try {
    renderer ?? make();
    return true;
  } catch {
    return false;
  }
}

export const isSlow = () => timed > 0 && SHOWING * cost > 0.8 * FRAME;
export const figures = () => ({ cost, views: views.size, ratio: ratio(true), lost: renderer?.getContext().isContextLost() });

function ratio(moving) {
  if (timed < 3) return 1;
  if (!moving) return cost < 250 ? 2 : 1; // four samples a pixel: smooth edges
  return Math.min(Math.max(Math.sqrt(FRAME / (SHOWING * cost)), 0.5), 2);
}

// view: {scene, camera, canvas, width, height in CSS pixels}.
export function paint(view, moving) {
  const scale = ratio(moving), w = Math.round(view.width * scale), h = Math.round(view.height * scale);
  const source = renderer.domElement;
  if (source.width < w || source.height < h) {
    renderer.setSize(Math.max(source.width, w), Math.max(source.height, h), false);
  }
  renderer.setViewport(0, 0, w, h);
  renderer.setScissor(0, 0, w, h);
  const began = performance.now();
  renderer.render(view.scene, view.camera);
  if (timed < 4 || !moving) { // the first compiles shaders and does not count; reading a pixel waits for the frame's end
    const gl = renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    const took = performance.now() - began;
    if (timed > 0) cost = Math.min(cost, (took / (w * h)) * view.width * view.height);
    timed += 1;
  }
  const { canvas } = view, dots = Math.min(window.devicePixelRatio || 1, 2);
  // while it moves, the page scales the canvas, which costs nothing; a scaled copy would cost more than the drawing
  const across = moving ? w : Math.round(view.width * dots), down = moving ? h : Math.round(view.height * dots);
  if (canvas.width !== across || canvas.height !== down) Object.assign(canvas, { width: across, height: down });
  const pen = canvas.getContext("2d", { alpha: false });
  pen.imageSmoothingQuality = "high";
  pen.drawImage(source, 0, source.height - h, w, h, 0, 0, across, down);
  if (timed < 4) view.soon();
}
