// The browser's side of canvas.py. As a data URL a picture is shown two frames earlier than as a blob, which goes
// through another process of the browser.
function dataUrl({ buffer, byteOffset, byteLength }) {
  const bytes = new Uint8Array(buffer, byteOffset, byteLength);
  let letters = "";
  for (let k = 0; k < byteLength; k += 0x8000) letters += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return "data:image/png;base64," + btoa(letters);
}

function render({ model, el }) {
  const img = Object.assign(document.createElement("img"), { decoding: "sync", draggable: false });
  const show = () => {
    img.alt = model.get("description");
    img.src = dataUrl(model.get("value"));
  };
  img.style.cssText = `display:block;width:100%;cursor:${model.get("clickable") ? "crosshair" : "default"}`;
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
