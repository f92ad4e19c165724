"""What a page shows in the place of widgets: the pictures they hold, or the 3-D arm without a kernel."""

import html
import json
import re

import nbformat

from ir50p_lab.course.live_arm.view import BUNDLE

_VIEW = "application/vnd.jupyter.widget-view+json"
_SHOWN = ("options", "q", "layers", "poses", "shape")  # of LiveArm's state


def plain_outputs(outputs, widgets, *, live):
    """Outputs without widgets. widgets: model id -> state, as a notebook stores it; live: with the 3-D arm."""
    plain = []
    for output in outputs:
        data = output.get("data", {})
        view = data.pop(_VIEW, None)
        if view is None:
            if "image/png" in data:  # a picture goes before other forms of the same thing
                about = output["metadata"].get("image/png", {})
                words = about.get("alt", data.get("text/plain", ""))
                output["data"] = {"text/html": _image(data["image/png"], words, about.get("width"))}
            plain.append(output)
            continue
        still = data.get("image/png")
        parts = list(_parts(view["model_id"], widgets, still, live))
        if not parts and still:
            parts = [_image(still, data.get("text/plain", ""))]
        if not parts and "text/html" in data:  # words in its place
            parts = [data["text/html"]]
        if parts:
            plain.append(nbformat.v4.new_output("display_data", {"text/html": "\n".join(parts)}))
    return plain


def _parts(model_id, widgets, still, live):
    """The pictures of a widget and of those inside it, in order, as HTML."""
    model = widgets.get(model_id)
    if model is None:
        return
    state, buffers = model["state"], {tuple(one["path"]): one["data"] for one in model.get("buffers", ())}
    if "poses" in state and "shape" in state:
        yield _arm(state, buffers, still) if live else _image(still, state.get("description", ""))
    elif str(state.get("value")).startswith("<svg"):  # a chart
        yield state["value"]
    elif buffers.get(("value",)):
        yield _image(buffers["value",], state["description"])
    inner = [_parts(child.removeprefix("IPY_MODEL_"), widgets, still, live) for child in state.get("children", ())]
    beside = state.get("_model_name") == "HBoxModel"
    yield from ['<div class="row">'] * beside
    for parts in inner:
        yield from parts
    yield from ["</div>"] * beside


def _image(png, words, width=None):
    size = f' width="{width}"' if width else ""
    data = "".join((png or "").split())
    return f'<img src="data:image/png;base64,{data}" alt="{html.escape(words)}"{size}>' if png else ""


def _arm(state, buffers, still):
    """A view of the arm: its picture, which the script at the end of the page replaces."""
    shown = {name: state[name] for name in _SHOWN} | {"track": buffers.get(("track",), "").replace("\n", "")}
    text = json.dumps(shown).replace("</", "<\\/")
    image = _image(still, state.get("description", ""))
    return f'<div data-live-arm>{image}<script type="application/json">{text}</script></div>'


def live_arm_script():
    """The script that brings the views of a page to life."""
    bundle = BUNDLE.read_text(encoding="utf-8")
    mount = re.search(r"(\w+) as mount\b", bundle)[1]
    bundle = re.sub(r"export\s*\{[^}]*\};?", "", bundle).replace("</script", "<\\/script")
    start = (
        f"for (const box of document.querySelectorAll('[data-live-arm]')) {mount}(box, "
        "JSON.parse(box.querySelector('script').textContent));"
    )
    return f'<script type="module">{bundle}\n{start}</script>'
