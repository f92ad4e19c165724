// LiveArm in the browser: an anywidget's render, and mount() for a page without a kernel.
// State (see view.py): options, q, layers, poses, track, shape.
import { ConeGeometry, Matrix4, Mesh, MeshBasicMaterial, PerspectiveCamera, Plane, Raycaster, Group, SphereGeometry, Vector2, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Curves } from "./curves.js";
import { frames, jacobian, reach, tip } from "./kinematics.js";
import { jointSliders, layout, make, playerBar, showLegend } from "./page.js";
import * as renderer from "./renderer.js";
import { COLOURS, Robot } from "./robot.js";
import { KEYS, Layers, makeScene, Trail } from "./stage.js";
import { contacts, Track } from "./track.js";

const FELT = 1200; // ms without an answer until a push is said not to be felt
const REST = 160; // ms without motion until the fine picture is drawn

class View {
  constructor(model, el) {
    this.model = model;
    this.options = model.get("options");
    this.l = this.options.lengths;
    this.limits = this.options.limits;
    this.size = this.l[1] + this.l[2];
    this.q = [...model.get("q")];
    this.on = new Set(model.get("layers"));
    this.waiting = {}; // kinds of messages under way, and the one to be sent next
    this.parts = layout();
    el.append(this.parts.box);
    this.makeScene();
    this.makePage();
    this.listen();
    renderer.enter(this);
    this.loadTrack();
    this.moved();
    this.parts.box.liveArm = this; // for tests in a browser
  }

  // ---- the scene

  makeScene() {
    this.scene = makeScene(this.size);
    this.layers = new Layers(this.scene, this.options);
    this.robot = new Robot(this.l);
    this.ghost = new Robot(this.l, { upper: "#8a8f98", fore: "#8a8f98", opacity: 0.3 });
    this.second = new Robot(this.l, { upper: COLOURS.second, fore: COLOURS.second });
    this.shade = new Robot(this.l, { shadow: true }); // the arm pressed flat: a shadow without a shadow map
    this.shadow = new Group().add(this.shade.root);
    this.shadow.scale.z = 1e-4;
    this.shadow.position.z = 0.0012;
    this.trails = [new Trail(COLOURS.trail), new Trail(COLOURS.second)];
    this.lost = new Trail(COLOURS.target, 2);
    this.shaft = new Trail(COLOURS.target, 6); // of the arrow of a push, with its head
    this.head = new Mesh(new ConeGeometry(0.03 * this.size, 0.08 * this.size, 20), new MeshBasicMaterial({ color: COLOURS.target }));
    this.target = new Mesh(new SphereGeometry(0.014 * this.size, 20, 14), new MeshBasicMaterial({ color: COLOURS.target }));
    this.nearest = new Mesh(new SphereGeometry(0.01 * this.size, 20, 14), new MeshBasicMaterial({ color: COLOURS.dark }));
    this.target.visible = this.nearest.visible = this.ghost.root.visible = this.second.root.visible = false;
    this.scene.add(this.robot.root, this.ghost.root, this.second.root, this.shadow, this.target, this.nearest);
    this.scene.add(...this.trails.map((trail) => trail.line), this.lost.line, this.shaft.line, this.head);
    this.camera = new PerspectiveCamera(30, 16 / 9, 0.01, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.parts.canvas);
    this.controls.enableZoom = false; // the wheel scrolls the page until the view is clicked
    this.controls.addEventListener("change", () => this.soon());
    this.controls.addEventListener("start", () => { this.turned = true; });
  }

  lookFromStart() {
    this.turned = false;
    this.camera.position.set(1.55, -2.6, 1.3);
    this.camera.lookAt(0, 0, 0);
    this.framed = `${this.width} ${this.height}`;
    this.frame();
  }

  // Places of the arm, of the motion that it plays, of the ball and of the table's edge, m.
  seenPoints() {
    const { track, layers, l } = this, edge = 1.05 * this.size;
    const columns = track?.runs.flatMap((run) => [run.q, ...(run.reference === null ? [] : [run.reference])]) ?? [];
    const runs = columns.flatMap((first) => [...track.path(l, first), ...track.path([l[0], l[1], 0], first)]); // tip, elbow
    const rim = Array.from({ length: 24 }, (_, k) => [edge * Math.cos((k * Math.PI) / 12), edge * Math.sin((k * Math.PI) / 12), 0]);
    const points = [...this.joints, ...runs, ...(this.on.has("table") ? rim : [[0, 0, 0]])].map((p) => new Vector3(...p));
    const known = points.filter((p) => Number.isFinite(p.x + p.y + p.z));
    return layers.all.ball?.visible ? [...known, layers.all.ball.position.clone()] : known;
  }

  // Moves the camera, without turning it, until all of it is just seen: each edge of the picture touches a point.
  frame() {
    const { camera } = this, points = this.seenPoints().map((p) => p.applyQuaternion(camera.quaternion.clone().invert()));
    const half = Math.tan((camera.fov * Math.PI) / 360), high = 0.85 * half, wide = 0.95 * camera.aspect * half;
    const most = (of) => Math.max(...points.map(of));
    const right = most((p) => p.x + wide * p.z), left = most((p) => wide * p.z - p.x);
    const up = most((p) => p.y + high * p.z), down = most((p) => high * p.z - p.y);
    const back = Math.max((right + left) / (2 * wide), (up + down) / (2 * high));
    const depth = (most((p) => p.z) + Math.min(...points.map((p) => p.z))) / 2;
    const middle = (up - down) / 2 + 0.05 * half * (back - depth); // the words of the view stand above
    const at = (z) => new Vector3((right - left) / 2, middle, z).applyQuaternion(camera.quaternion);
    camera.position.copy(at(back));
    this.controls.target.copy(at(depth));
    this.controls.update();
    this.soon();
  }

  // Whether an end of a link has left the picture.
  hidden() {
    return this.joints.some((p) => { const { x, y } = new Vector3(...p).project(this.camera); return Math.max(Math.abs(x), Math.abs(y)) > 1; });
  }

  // Draw when something changed, at most once a frame; finely when all has come to rest.
  soon() {
    if (this.wanted || this.closed) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw(true);
      clearTimeout(this.fine);
      this.fine = setTimeout(() => this.draw(false), REST);
    });
  }

  draw(moving) {
    if (this.closed || !this.seen || !this.width) return;
    this.shadow.visible = !(moving && renderer.isSlow());
    for (const { material } of [...this.trails, this.lost, this.shaft]) material.resolution.set(this.width, this.height);
    renderer.paint(this, moving);
    if (this.track) this.curves.draw(this.time, this.sideWidth, this.height);
  }

  // ---- the page around it

  makePage() {
    const { parts, options } = this;
    this.canvas = parts.canvas;
    parts.badge.textContent = options.badge;
    parts.badge.classList.toggle("yours", options.badge === "yours");
    parts.badge.title = "whose code moves this arm";
    this.showJoints = jointSliders(parts.joints, this.limits, (i, value) => {
      this.pause();
      this.pose(this.q.map((old, k) => (k === i ? value : old)), true);
    });
    parts.joints.hidden = !options.sliders;
    const clear = make("button", { textContent: "clear trail" });
    clear.addEventListener("click", () => { this.written = []; this.trails[0].set([]); this.soon(); });
    const choice = (name, checked, changed) => {
      const tick = make("input", { type: "checkbox", checked });
      tick.addEventListener("change", () => {
        changed(tick.checked);
        this.model.save_changes();
        this.moved();
      });
      parts.layers.append(make("label", {}, {}, tick, ` ${name}`));
    };
    for (const name of [...Object.keys(this.layers.all), "ghost", "trail", "shadow"]) {
      choice(name, this.on.has(name), (on) => {
        this.on[on ? "add" : "delete"](name);
        this.model.set("layers", [...this.on]);
      });
    }
    choice("place of the tip", options.readout, (on) => {
      this.options = { ...this.options, readout: on };
      this.model.set("options", this.options);
    });
    parts.layers.append(clear);
    this.written = [];
    this.showPlayer = playerBar(parts.player, {
      toggle: () => this.toggle(),
      seek: (part) => this.seek(this.track.start + part * (this.track.end - this.track.start)),
      speed: (rate) => { this.rate = rate; },
      loop: () => { this.again = !this.again; this.seen && this.tellPlayer(); },
    });
    this.curves = new Curves(this.limits, this.l, (t) => this.seek(t));
    parts.side.append(this.curves.canvas, this.curves.cursor);
  }

  // ---- poses

  // Move to q; tell: the kernel is to hear of it.
  pose(q, tell = false) {
    this.q = q;
    if (this.model.get("poses").length) this.ask({ frames: q });
    if (tell) {
      this.write();
      this.tell();
    }
    this.moved();
  }

  // Everything that follows from the pose.
  moved() {
    const own = this.model.get("poses");
    const given = own.length ? own.map((rows) => new Matrix4().set(...rows.flat())) : null;
    const transforms = given ?? frames(this.l, this.q);
    this.robot.place(transforms);
    this.shade.place(transforms);
    this.layers.place(transforms, this.q);
    this.layers.show([...this.on]);
    showLegend(this.parts.keys, [...this.on].flatMap((name) => KEYS[name] ?? []));
    this.shade.root.visible = this.on.has("shadow");
    this.trails.forEach((trail) => { trail.line.visible = this.on.has("trail"); });
    const along = (T, x) => new Vector3(x, 0, 0).applyMatrix4(T).toArray(); // of a link, whose frame is at its far end
    this.joints = [...transforms.map((T) => along(T, 0)), along(transforms[2], -this.l[1]), along(transforms[3], -this.l[2])];
    this.tipAt = this.joints[3];
    if (this.width && !this.turned && !this.dragging && !this.hand && this.hidden()) this.frame();
    this.showPush();
    const { stops, table } = contacts(this.l, this.limits, this.q);
    this.robot.alarm(this.track ? stops : [false, false, false]);
    if (!this.dragging && !this.hand && !this.error) {
      const touched = this.track ? [...stops.flatMap((at, i) => (at ? [`joint ${i + 1} at its stop`] : [])), ...(table ? ["touches the table"] : [])] : [];
      if (this.mostPush) touched.push("press on a link and drag to push it, or press Shift and arrows");
      this.say(touched.join(", "));
    }
    const [x, y, z] = this.tipAt.map((v) => v.toFixed(3).replace("-", "\u2212"));
    const { readout } = this.options, place = readout ? `, tip at x ${x} m, y ${y} m, z ${z} m` : "";
    this.parts.tip.hidden = !readout;
    this.parts.tip.textContent = `tip ${x}, ${y}, ${z} m`;
    this.canvas.setAttribute("aria-label", `the arm in 3-D${place}; arrow keys turn the view${this.mostPush ? ", with Shift they push the arm" : ""}`);
    this.showJoints(this.q);
    this.soon();
  }

  say(text) {
    this.parts.note.textContent = text;
  }

  // The trail that the hand writes.
  write() {
    const at = tip(this.l, this.q), last = this.written.at(-1);
    if (last && Math.hypot(...at.map((v, i) => v - last[i])) < 0.002) return;
    this.written = [...this.written, at].slice(-3000);
    if (!this.track) this.trails[0].set(this.written);
  }

  // ---- the kernel

  // One message of a kind is under way at most; of those that wait only the last is sent.
  ask(message) {
    const kind = Object.keys(message)[0], underWay = kind in this.waiting;
    this.waiting[kind] = underWay ? message : null;
    if (!underWay) this.model.send(message);
  }

  answered(kind) {
    const next = this.waiting[kind];
    delete this.waiting[kind];
    if (next) this.ask(next);
  }

  // As often as the pose changes: the widget's model itself waits until the kernel has dealt with the last message.
  tell() {
    this.model.set("q", this.q);
    this.model.save_changes();
  }

  listen() {
    const { model, canvas } = this, { box, stage } = this.parts;
    this.heard = {
      "change:q": () => { if (!this.dragging && !this.playing && model.get("q") !== this.q) this.pose(model.get("q")); },
      "change:poses": () => this.moved(),
      "change:layers": () => { this.on = new Set(model.get("layers")); this.moved(); },
      "change:track": () => this.loadTrack(),
      "msg:custom": (message, buffers) => this.message(message, buffers),
    };
    for (const [event, handler] of Object.entries(this.heard)) model.on(event, handler);
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(box);
    this.sight = new IntersectionObserver((entries) => {
      this.seen = entries.at(-1).isIntersecting;
      if (this.seen) this.soon();
    }, { rootMargin: "200px" });
    this.sight.observe(stage);
    this.beforePrint = () => { this.seen = true; this.draw(false); };
    window.addEventListener("beforeprint", this.beforePrint);
    this.listenToHand();
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("focus", () => { this.controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { this.controls.enableZoom = false; });
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  }

  message(message, buffers) {
    if (message.live) return this.live(new Track(buffers[0], message.live), message.live.push);
    this.error = message.error ?? null;
    for (const kind of ["frames", "drag", "push"]) if (kind in message) this.answered(kind);
    if ("push" in message && this.hand) this.hand.felt = performance.now();
    if (message.error) this.say(message.error);
    else if ("drag" in message) this.followed(message.drag, "kernel");
  }

  resize() {
    const wide = this.parts.box.clientWidth;
    if (!wide) return;
    this.parts.side.hidden = !this.track;
    this.height = this.options.height;
    this.width = this.parts.stage.clientWidth;
    this.sideWidth = Math.max(this.parts.side.clientWidth, 240);
    this.canvas.style.height = this.height + "px";
    this.camera.aspect = this.width / this.height;
    this.camera.updateProjectionMatrix();
    const size = `${this.width} ${this.height}`;
    if (size !== this.framed && this.joints && !this.turned) this.lookFromStart();
    this.soon();
  }

  // ---- hand and keys

  listenToHand() {
    const { canvas } = this, ray = new Raycaster(), plane = new Plane(), hit = new Vector3(), eye = new Vector3();
    const aim = (event) => {
      const box = canvas.getBoundingClientRect();
      ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), this.camera);
    };
    const overTip = () => ray.ray.distanceToPoint(new Vector3(...this.tipAt)) < 0.06 * this.size;
    canvas.addEventListener("pointerdown", (event) => { // in the capture phase: before OrbitControls
      aim(event);
      const at = new Vector3(...this.tipAt), atTip = overTip() ? { link: 3, point: new Vector3(), at } : null;
      const grip = this.mostPush ? this.robot.hit(ray) ?? atTip : null;
      if (!grip && (!atTip || this.isLive)) return;
      event.stopImmediatePropagation();
      this.pause();
      this.dragging = !grip;
      this.hand = grip;
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
      plane.setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(eye), grip?.at ?? at);
    }, true);
    canvas.addEventListener("pointermove", (event) => {
      aim(event);
      const there = ray.ray.intersectPlane(plane, hit);
      if (there && this.hand?.at) this.push(hit.clone().sub(this.hand.at).multiplyScalar(this.stiff));
      else if (there && this.dragging) this.drag([hit.x, hit.y, Math.max(hit.z, 0)]);
      else canvas.style.cursor = overTip() || (this.mostPush && this.robot.hit(ray)) ? "grab" : "default";
    });
    const release = () => {
      this.letGo();
      if (!this.dragging) return;
      this.dragging = this.target.visible = this.nearest.visible = false;
      this.lost.set([]);
      this.moved();
    };
    for (const event of ["pointerup", "pointercancel", "blur"]) canvas.addEventListener(event, release);
    canvas.addEventListener("keyup", (event) => { if (event.key === "Shift") this.letGo(); });
  }

  // The hand pushes with `force`, N in the base. Each message costs as much as a picture, and the kernel forgets a push
  // after a second: live() sends it again.
  push(force) {
    const { hand } = this, now = performance.now();
    hand.force = force.clampLength(0, this.mostPush);
    hand.felt ??= now;
    this.say(now - hand.felt < FELT ? `you push with ${force.length().toFixed(1)} N at link ${hand.link}` : "a cell is running: until it ends the arm does not feel your hand");
    if (!force.length() || now - (hand.sent ?? 0) > (hand.told === force ? 400 : 80)) {
      Object.assign(hand, { sent: now, told: force });
      this.ask({ push: [hand.link, hand.point.toArray(), force.toArray()] });
    }
    this.showPush();
    this.soon();
  }

  letGo() {
    if (!this.hand) return;
    if (this.hand.force) this.push(new Vector3());
    this.hand = null;
    this.moved();
  }

  // The arrow of the push, from where the hand is.
  showPush() {
    const { hand, head, shaft } = this, force = hand?.force;
    head.visible = shaft.line.visible = Boolean(force?.length());
    if (!head.visible) return;
    const from = hand.point.clone().applyMatrix4(this.robot.links[hand.link].matrix);
    head.position.copy(from).addScaledVector(force, 1 / this.stiff);
    shaft.set([from.toArray(), head.position.toArray()]);
    head.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), force.clone().normalize());
  }

  // The hand wants the tip at p.
  drag(p) {
    this.wantedAt = p;
    this.best = reach(this.l, this.limits, p, this.q);
    if (this.options.drag === "kernel" && !this.model.isPage) this.ask({ drag: p, q: this.q });
    else this.followed(this.best.q, "browser");
    this.soon();
  }

  // An answer to the hand: q, or null for none. Shows what is missing to the point wanted.
  followed(q, whose) {
    if (q) this.pose(q, whose === "browser");
    if (q && whose === "kernel") this.write();
    if (!this.dragging) return;
    const at = q ? tip(this.l, q) : tip(this.l, this.best.q), away = Math.hypot(...at.map((v, i) => v - this.wantedAt[i]));
    this.target.position.set(...this.wantedAt);
    this.nearest.position.set(...at);
    this.target.visible = true;
    this.nearest.visible = away > 0.001;
    this.lost.set(away > 0.001 ? [at, this.wantedAt] : []);
    const millimetres = `${(1000 * away).toFixed(0)} mm`;
    if (q) this.say(away > 0.001 ? `out of reach by ${millimetres}; the black point is the nearest` : "");
    else this.say(away > 0.001 ? `no solution here: the nearest point is ${millimetres} away` : "no solution, although this point can be reached");
    this.soon();
  }

  key(event) {
    const { controls } = this;
    const side = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0, up = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
    if (event.shiftKey && this.mostPush && (side || up)) { // 1 N more
      this.hand ??= { link: 3, point: new Vector3() };
      const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
      this.push((this.hand.force ?? new Vector3()).clone().addScaledVector(right, side).add(new Vector3(0, 0, up)));
      return event.preventDefault();
    }
    const turn = { ArrowLeft: 0.06, ArrowRight: -0.06 }[event.key], tilt = { ArrowUp: 0.06, ArrowDown: -0.06 }[event.key];
    const zoom = { "+": 0.92, "=": 0.92, "-": 1.08 }[event.key];
    if (turn) controls.rotateLeft(turn);
    else if (tilt) controls.rotateUp(tilt);
    else if (zoom) controls.dollyIn(zoom);
    else if (event.key === "Home") this.lookFromStart();
    else if (event.key === " " && this.track) this.toggle();
    else return;
    this.turned ||= Boolean(turn || tilt || zoom);
    event.preventDefault();
  }

  // ---- motions

  loadTrack() {
    const bytes = this.model.get("track"), shape = this.model.get("shape");
    this.isLive = false;
    this.mostPush = 0; // N; more only while a simulated arm is followed live
    this.hand = null;
    this.pause();
    this.take(bytes?.byteLength ? new Track(bytes, shape) : null);
    if (!this.track) return;
    this.rate = this.model.get("options").speed;
    this.again = this.model.get("options").loop;
    this.seek(this.track.start);
    if (this.width && !this.turned) this.lookFromStart();
  }

  take(track) {
    this.track = track?.rows ? track : null;
    this.parts.player.hidden = this.parts.side.hidden = !this.track;
    const runs = this.track?.runs ?? [];
    this.ghost.root.visible = this.second.root.visible = false;
    const every = this.isLive ? 4 : 1; // a full trail, new in each picture, takes half of the drawing
    this.trails.forEach((trail, k) => trail.set(runs[k] ? this.track.path(this.l, runs[k].q, every) : k ? [] : this.written));
    if (this.track) this.curves.load(this.track);
    this.trails[0].material.color.set(runs.length > 1 ? COLOURS.upper : COLOURS.trail);
    const chips = runs.length > 1 ? [["#0072B2", runs[0].label], [COLOURS.second, runs[1].label]] : runs.map((run) => [null, run.label]);
    const words = this.track?.source ? [[null, this.track.source]] : [];
    const ghost = runs[0]?.reference != null ? [["#8a8f9888", "set point"]] : [];
    showLegend(this.parts.legend, [...chips, ...ghost, ...words]);
    this.resize();
  }

  // A window of samples that has just come: show the last. mostPush: N that a hand may push.
  live(track, mostPush) {
    const first = !this.isLive;
    this.isLive = true;
    this.playing = false;
    this.mostPush = mostPush;
    this.stiff = mostPush / (0.2 * this.size); // N a metre of the arrow, and of the way that the hand goes
    if (first) this.on.add("trail");
    this.take(track);
    if (this.track) this.seek(this.track.end);
    if (!mostPush) this.letGo();
    else if (this.hand?.force) this.push(this.hand.force);
  }

  seek(t) {
    const { track } = this, [first, second] = track.runs;
    this.time = Math.min(Math.max(t, track.start), track.end);
    const row = track.row(this.time);
    this.trails.forEach((trail) => trail.show(row + 1));
    const wanted = first.reference === null ? null : track.at(this.time, first.reference);
    this.ghost.root.visible = this.on.has("ghost") && wanted !== null && wanted.every(Number.isFinite);
    if (this.ghost.root.visible) this.ghost.place(frames(this.l, wanted));
    this.second.root.visible = Boolean(second);
    if (second) this.second.place(frames(this.l, track.at(this.time, second.q)));
    this.pose(track.at(this.time, first.q));
    this.tellPlayer();
  }

  tellPlayer() {
    const { track, time, playing, isLive, rate, again } = this;
    this.showPlayer({ t: time, start: track.start, end: track.end, playing, live: isLive, rate: rate ?? 1, again });
  }

  play() {
    if (this.time >= this.track.end) this.time = this.track.start;
    this.playing = true;
    let last = null;
    const tick = (now) => {
      if (!this.playing || this.closed) return;
      const next = this.time + (last === null ? 0 : ((now - last) / 1000) * this.rate);
      last = now;
      if (next >= this.track.end && !this.again) this.playing = false;
      this.seek(next >= this.track.end && this.again ? this.track.start : next);
      if (this.playing) requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  toggle() {
    this.playing ? this.pause() : this.play();
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.tellPlayer();
    this.tell();
  }

  // For tests: where on the page a point of the base frame is seen.
  onPage(p) {
    const at = new Vector3(...p).project(this.camera), box = this.canvas.getBoundingClientRect();
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height];
  }

  close() {
    this.closed = true;
    clearTimeout(this.fine);
    this.sizes.disconnect();
    this.sight.disconnect();
    window.removeEventListener("beforeprint", this.beforePrint);
    this.controls.dispose();
    for (const [event, handler] of Object.entries(this.heard)) this.model.off(event, handler);
    renderer.leave(this);
    this.scene.traverse((thing) => {
      thing.geometry?.dispose();
      thing.material?.map?.dispose();
      thing.material?.dispose();
    });
  }
}

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
