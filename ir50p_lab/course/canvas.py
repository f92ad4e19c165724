"""What the live charts share in the browser: a canvas as wide as its cell, drawn once per frame, and round steps."""

__all__ = ["CANVAS"]

CANVAS = """
const niceStep = (span, most) => {
  const scale = 10 ** Math.floor(Math.log10(span / most));
  for (const n of [1, 2, 5, 10, 20, 50, 100]) if (span / (n * scale) <= most) return n * scale;
  return 100 * scale;
};
const decimals = (step) => Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
const fixed = (v, places) => (Math.abs(v) < 1e-9 ? 0 : v).toFixed(places).replace("-", "\\u2212");

// paint(ctx, data, settings, width, height), in CSS pixels, whenever samples, settings or the width have changed
function onCanvas({ model, el }, paint, widest = Infinity) {
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.style.cssText = "width:100%;display:block;background:white;";
  el.style.width = "100%";
  el.appendChild(canvas);
  const ctx = canvas.getContext("2d");
  let wanted = false;

  function draw() {
    wanted = false;
    const settings = model.get("settings"), bytes = model.get("samples");
    const raw = bytes.buffer ? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) : bytes;
    const width = Math.min(Math.max(el.clientWidth, 480), widest), height = settings.height;
    const dpr = window.devicePixelRatio || 1;
    if (canvas.width !== Math.round(width * dpr) || canvas.height !== Math.round(height * dpr)) {
      canvas.width = Math.round(width * dpr); canvas.height = Math.round(height * dpr);
      canvas.style.width = width + "px"; canvas.style.height = height + "px";
    }
    canvas.setAttribute("aria-label", settings.description);
    ctx.setTransform(dpr, 0, 0, dpr, 0, 0);
    ctx.fillStyle = "white"; ctx.fillRect(0, 0, width, height);
    paint(ctx, new Float32Array(raw), settings, width, height);
  }
  const soon = () => { if (!wanted) { wanted = true; requestAnimationFrame(draw); } };
  model.on("change:samples", soon);
  model.on("change:settings", soon);
  const observer = new ResizeObserver(soon);
  observer.observe(el);
  soon();
  return () => { model.off("change:samples", soon); model.off("change:settings", soon); observer.disconnect(); };
}

function sideways(ctx, text, x, y) {
  ctx.save(); ctx.translate(x, y); ctx.rotate(-Math.PI / 2); ctx.textAlign = "center";
  ctx.fillText(text, 0, 0); ctx.restore();
}
"""
