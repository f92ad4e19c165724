// In the notebook of a browser tab: what is written is saved at once; the picture beside a view whose kernel has gone.
const WIDGET = "application/vnd.jupyter.widget-view+json";
const PICTURES = ["image/png", "image/jpeg", "image/svg+xml"];
const open = () => globalThis.jupyterapp?.shell.currentWidget;
let seen = null;

function save() {
  const context = open()?.context;
  if (context?.isReady && context.model.dirty && !saving) {
    saving = context.save().finally(() => { saving = null; });
  }
}

function showPictures(panel) {
  for (const cell of panel.content.widgets.filter((one) => one.model.type === "code")) {
    const outputs = cell.model.outputs.toJSON();
    const views = outputs.filter((one) => one.data?.[WIDGET]);
    for (const { data } of views) {
      const pictured = PICTURES.some((kind) => data[kind]);
      delete data[WIDGET];
      if (!pictured) data["text/plain"] = "(Sliders and moving views come back when you run this cell again.)";
    }
    if (views.length) cell.model.outputs.fromJSON(outputs);
  }
}

let saving = null;
setInterval(() => {
  const panel = open();
  if (panel?.context?.isReady && panel !== seen) {
    seen = panel;
    showPictures(panel);
  }
  save();
}, 1000);
document.addEventListener("visibilitychange", save);
addEventListener("pagehide", save);
// A link to a notebook leads there in this very tab: the kernel of the page that is left ends with it.
document.addEventListener("click", async (event) => {
  const words = event.target.closest?.("a")?.dataset.commandlinkerArgs;
  const { path } = words ? JSON.parse(words) : {};
  if (!path?.endsWith(".ipynb")) return;
  event.preventDefault();
  event.stopImmediatePropagation();
  await open().context.save();
  location.assign(`?path=${encodeURIComponent(path)}`);
}, true);
