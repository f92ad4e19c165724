// The browser's side of canvas.py. As a data URL a picture is shown two frames earlier than as a blob, which goes
// through another process of the browser.
function render({ model, el }) {
  const img = Object.assign(document.createElement("img"), { alt: model.get("description"), decoding: "sync", draggable: false });
  const show = () => { img.src = model.get("value"); };
  img.style.cssText = `width:100%;cursor:${model.get("clickable") ? "crosshair" : "default"}`;
  img.addEventListener("click", (event) => {
    const box = img.getBoundingClientRect();
    model.send({ right: (event.clientX - box.left) / box.width, up: (box.bottom - event.clientY) / box.height });
  });
  el.append(img);
  model.set("ratio", Math.min(Math.max(window.devicePixelRatio || 1, 1), 2));
  model.save_changes();
  model.on("change:value", show);
  show();
  return () => model.off("change:value", show);
}

export default { render };
