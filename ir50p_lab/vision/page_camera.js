// The camera of the computer that shows the page: asked for, shown live; its pictures go to Python, each after an answer.
const A_SECOND = 10; // pictures, at most
const PATIENCE = 30_000; // ms: if Python does not answer for so long, the camera is put off
const INSECURE = "A browser lends its camera only to pages of https and of localhost; this one is neither.";
const VS_CODE = "VS Code lends no camera to a notebook: open it in JupyterLab, or take open_camera(0).";
const WHY = {
  NotAllowedError: "The browser may not use the camera: allow it at the sign beside the address, then press the button.",
  NotFoundError: "The browser finds no camera: plug one in, then press the button.",
  NotReadableError: "The camera is busy: close the other program that has it, then press the button.",
};

function addTo(parent, tag, properties) {
  return parent.appendChild(Object.assign(document.createElement(tag), properties));
}

export default () => {
  const views = new Set(); // of one stream
  const video = Object.assign(document.createElement("video"), { muted: true, playsInline: true });
  const canvas = document.createElement("canvas"); // the picture that Python has, with what is drawn on it
  const pen = canvas.getContext("2d");
  let width, height, send, stream, timer;
  let since = 0; // ms, when the picture was taken that is not answered yet

  function show(says) {
    for (const view of views) {
      view.says.textContent = says;
      view.button.textContent = stream ? "Camera off" : "Camera on";
      view.canvas.width = width; // blank
      view.canvas.getContext("2d").drawImage(canvas, 0, 0);
    }
  }
  function use(other) {
    clearInterval(timer);
    stream?.getTracks().forEach((track) => track.stop());
    stream = video.srcObject = other;
    since = 0;
  }
  function stop(why = "") {
    use(null);
    canvas.width = width; // blank: no picture of it stays
    show(why);
    send({ off: why || "the camera is off: press the button below its picture" });
  }
  async function start() {
    try {
      use(await navigator.mediaDevices.getUserMedia({ video: { width, height } }));
      stream.getTracks()[0].onended = () => stop("The camera was unplugged, or the permission taken back.");
      await video.play();
      timer = setInterval(grab, 1000 / A_SECOND);
      if (!views.size) stop(); // the cell went while the student was asked
    } catch (error) {
      const why = navigator.mediaDevices ? (WHY[error.name] ?? error.message) : INSECURE;
      stop(location.protocol === "vscode-webview:" ? VS_CODE : why);
    }
  }
  async function grab() {
    const now = performance.now();
    if (since && now - since > PATIENCE) return stop("Python has not answered for long: camera off.");
    if (since) return;
    since = now;
    const scale = Math.max(width / video.videoWidth, height / video.videoHeight); // of another shape: its middle
    const [wide, high] = [scale * video.videoWidth, scale * video.videoHeight];
    pen.drawImage(video, (width - wide) / 2, (height - high) / 2, wide, high);
    const jpeg = await new Promise((done) => canvas.toBlob(done, "image/jpeg", 0.95));
    send({ at: performance.timeOrigin + now }, [await jpeg.arrayBuffer()]);
  }
  function draw([name, x, y, radius], index) {
    pen.lineWidth = 3;
    pen.font = "20px sans-serif";
    pen.strokeStyle = pen.fillStyle = ["#fff", "#f0e442", "#56b4e9"][index % 3];
    pen.beginPath();
    pen.arc(x, y, Math.abs(radius), 0, 2 * Math.PI);
    pen.stroke();
    pen.fillText(name, x + 0.8 * radius, y - 0.8 * radius - 22 * index);
  }
  function heard(message) {
    if ("start" in message) return message.start ? start() : stop();
    since = 0;
    message.circles.forEach(draw); // on the picture that they were found in, not on a later one
    if (stream) show(message.says);
  }
  return {
    initialize({ model }) {
      [width, height] = [canvas.width, canvas.height] = model.get("size");
      send = (message, buffers) => model.send(message, undefined, buffers);
      model.on("msg:custom", heard);
      model.on("comm_live_update", () => stop("Python has ended: camera off."));
    },
    render({ el }) {
      const style = "display: block; max-width: 100%; background: #222";
      const canvas = addTo(el, "canvas", { width, height, style, role: "img", ariaLabel: "The live picture of the camera" });
      const onclick = () => (stream ? stop() : start());
      const button = addTo(el, "button", { className: "jupyter-button", style: "margin: 4px 8px 4px 0", onclick });
      const view = { canvas, button, says: addTo(el, "span", { role: "status" }) };
      views.add(view);
      show("");
      send({ shown: true });
      return () => {
        views.delete(view);
        setTimeout(() => views.size || stop(), 1000);
      };
    },
  };
};
