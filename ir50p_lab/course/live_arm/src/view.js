// One LiveArm on a page: holds its scene, hand and player together, and speaks with the kernel.
import { Matrix4 } from "three";
import { Hand } from "./hand.js";
import { frames } from "./kinematics.js";
import { fillMenu, jointSliders, layout, showLegend } from "./page.js";
import { Player } from "./player.js";
import { ArmScene } from "./scene.js";
import { KEYS } from "./stage.js";
import { contacts, Track } from "./track.js";

export class View {
  constructor(model, el) {
    this.model = model;
    this.options = model.get("options");
    this.l = this.options.lengths;
    this.limits = this.options.limits;
    this.q = [...model.get("q")];
    this.on = new Set(model.get("layers"));
    this.waiting = {}; // kinds of messages under way, and the one to be sent next
    this.parts = layout(this.options.badge);
    this.canvas = this.parts.canvas;
    el.append(this.parts.box);
    this.scene = new ArmScene(this.canvas, this.l, this.options, () => this.player.draw(this.sideWidth, this.options.height));
    this.hand = new Hand(this);
    this.player = new Player(this);
    fillMenu(this.parts.layers, [...Object.keys(this.scene.layers.all), "trail", "shadow"], this.on, () => this.hand.clear(), () => {
      model.set("layers", [...this.on]);
      model.save_changes();
      this.moved();
    });
    this.showJoints = jointSliders(this.parts.joints, this.limits, (i, value) => {
      this.player.pause();
      this.pose(this.q.map((old, k) => (k === i ? value : old)), true);
    });
    this.parts.joints.hidden = !this.options.sliders;
    this.listen();
    this.player.load();
    this.moved();
    this.parts.box.liveArm = this; // for tests in a browser
  }

  // Move to q; tell: the kernel is to hear of it.
  pose(q, tell = false) {
    this.q = q;
    if (this.model.get("poses").length) this.ask({ frames: q });
    if (tell) {
      this.hand.write();
      this.tell();
    }
    this.moved();
  }

  // Everything that follows from the pose.
  moved() {
    const own = this.model.get("poses"), { scene, hand, parts } = this;
    scene.place(own.length ? own.map((rows) => new Matrix4().set(...rows.flat())) : frames(this.l, this.q), this.q, this.on);
    showLegend(parts.keys, [...this.on].flatMap((name) => KEYS[name] ?? []));
    if (!hand.busy) scene.keepInSight();
    hand.showPush();
    const touched = this.touched();
    if (hand.mostPush) touched.push("press on a link and drag to push it, or press Shift and arrows");
    if (!hand.busy && !this.error) this.say(touched.join(", "));
    const [x, y, z] = scene.tipAt.map((v) => v.toFixed(3).replace("-", "\u2212"));
    parts.tip.textContent = `tip ${x}, ${y}, ${z} m`;
    const push = hand.mostPush ? ", with Shift they push the arm" : "";
    this.canvas.setAttribute("aria-label", `the arm in 3-D, tip at x ${x} m, y ${y} m, z ${z} m; arrow keys turn the view${push}`);
    this.showJoints(this.q);
  }

  // Stops and table that a motion touches, in words; an arm in space has none.
  touched() {
    const { stops, table } = contacts(this.l, this.player.track && !this.options.in_space ? this.limits : null, this.q);
    this.scene.robot.alarm(stops);
    return [...stops.flatMap((at, i) => (at ? [`joint ${i + 1} at its stop`] : [])), ...(table ? ["touches the table"] : [])];
  }

  say(text) {
    this.parts.note.textContent = text;
  }

  resize() {
    const wide = this.parts.box.clientWidth;
    if (!wide) return;
    this.parts.side.hidden = !this.player.track;
    this.sideWidth = Math.max(this.parts.side.clientWidth, 240);
    this.scene.resize(this.parts.stage.clientWidth, this.options.height);
  }

  listen() {
    const { model, scene, player, hand } = this;
    this.heard = {
      "change:q": () => { if (!hand.dragging && !player.playing && model.get("q") !== this.q) this.pose(model.get("q")); },
      "change:poses": () => this.moved(),
      "change:layers": () => { this.on = new Set(model.get("layers")); this.moved(); },
      "change:track": () => player.load(),
      "msg:custom": (message, buffers) => this.message(message, buffers),
    };
    for (const [event, handler] of Object.entries(this.heard)) model.on(event, handler);
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(this.parts.box);
    this.sight = new IntersectionObserver((entries) => {
      scene.seen = entries.at(-1).isIntersecting;
      if (scene.seen) scene.soon();
    }, { rootMargin: "200px" });
    this.sight.observe(this.parts.stage);
    this.beforePrint = () => { scene.seen = true; scene.draw(false); };
    window.addEventListener("beforeprint", this.beforePrint);
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

  message(message, buffers) {
    if (message.live) return this.player.live(new Track(buffers[0], message.live), message.live.push);
    this.error = message.error ?? null;
    for (const kind of ["frames", "drag", "push"]) if (kind in message) this.answered(kind);
    if ("push" in message) this.hand.felt();
    if (message.error) this.say(message.error);
    else if ("drag" in message) this.hand.followed(message.drag, "kernel");
  }

  close() {
    this.sizes.disconnect();
    this.sight.disconnect();
    window.removeEventListener("beforeprint", this.beforePrint);
    for (const [event, handler] of Object.entries(this.heard)) this.model.off(event, handler);
    this.scene.close();
  }
}
