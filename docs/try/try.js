// What the page to try does beside its views: the first plays by itself, the ball goes along, three play as one.
const views = [...document.querySelectorAll(".la")].map((box) => box.liveArm);
if (!views.length) {
  document.querySelector("h1").insertAdjacentHTML("afterend",
    "<p><b>The arms stand still in this browser, because it offers no WebGL.</b> In another one they move.</p>");
} else {
  const [first, second, ...three] = views;

  // 1: from the moment the fingers close the ball stays between them
  const ball = first.scene.layers.all.ball, lies = ball.position.clone(), closes = 3.2; // s
  const seek = first.player.seek;
  first.player.seek = (t) => {
    seek.call(first.player, t);
    if (t < closes) ball.position.copy(lies);
    else ball.position.set(...first.scene.tipAt);
    first.scene.soon();
  };
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) first.player.play();

  // 2: how far, and when it is done
  const told = second.parts.box.insertAdjacentElement("beforebegin", document.createElement("p"));
  const place = second.options.ball[0][0];
  const show = () => {
    const beside = 1000 * Math.hypot(...place.map((v, k) => v - second.scene.tipAt[k]));
    const there = beside < 35;
    told.className = there ? "there" : "";
    told.textContent = there ? "✓ You touch it." : `The tip is ${beside.toFixed(0)} mm from the middle of the ball.`;
  };
  told.setAttribute("aria-live", "polite");
  const moved = second.moved;
  second.moved = () => { moved.call(second); show(); };
  show();

  // 3: one button for all three
  const button = Object.assign(document.createElement("button"), { className: "all-three", textContent: "▶ all three" });
  three[0].parts.box.closest(".row").insertAdjacentElement("beforebegin", button);
  button.addEventListener("click", () => three.forEach(({ player }) => { player.seek(0); player.play(); }));
}

// Where the site of the browser tab lies beside this page, the page leads there.
if (location.protocol.startsWith("http")) {
  const { ok } = await fetch("lab/index.html", { method: "HEAD" }).catch(() => ({ ok: false }));
  if (ok) document.querySelector("p strong").parentElement.insertAdjacentHTML("beforeend",
    " <b><a href='lab/'>Begin with notebook 00</a> in this very browser, without installing anything.</b>");
}
