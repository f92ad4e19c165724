// What hand and keys do: turn the view, drag the tip, push the arm while a bench is followed live.
import { ConeGeometry, Mesh, MeshBasicMaterial, Plane, Raycaster, SphereGeometry, Vector2, Vector3 } from "three";
import { reach, tip } from "./kinematics.js";
import { COLOURS } from "./robot.js";
import { Trail } from "./stage.js";

const FELT = 1200; // ms without an answer until a push is said not to be felt

export class Hand {
  constructor(view) {
    Object.assign(this, { view, written: [], dragging: false });
    const { scene, size } = view.scene;
    const mesh = (geometry, color) => new Mesh(geometry, new MeshBasicMaterial({ color }));
    this.missing = new Trail(COLOURS.target, 2); // from the nearest point to the one wanted
    this.shaft = new Trail(COLOURS.target, 6); // of the arrow of a push, with its head
    this.head = mesh(new ConeGeometry(0.03 * size, 0.08 * size, 20), COLOURS.target);
    this.target = mesh(new SphereGeometry(0.014 * size, 20, 14), COLOURS.target);
    this.nearest = mesh(new SphereGeometry(0.01 * size, 20, 14), COLOURS.dark);
    this.target.visible = this.nearest.visible = false;
    scene.add(this.target, this.nearest, this.missing.line, this.shaft.line, this.head);
    this.reset();
    this.listen();
  }

  reset() {
    this.grip = null; // of a push: {link, point on it, at, force}
    this.mostPush = 0; // N; more only while a simulated arm is followed live
  }

  get busy() {
    return this.dragging || Boolean(this.grip);
  }

  listen() {
    const { canvas, scene: { camera, controls, robot, size } } = this.view;
    const ray = new Raycaster(), plane = new Plane(), hit = new Vector3(), eye = new Vector3();
    const aim = (event) => {
      const box = canvas.getBoundingClientRect();
      ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), camera);
    };
    const overTip = () => ray.ray.distanceToPoint(new Vector3(...this.view.scene.tipAt)) < 0.06 * size;
    canvas.addEventListener("pointerdown", (event) => { // in the capture phase: before OrbitControls
      aim(event);
      const { player } = this.view, at = new Vector3(...this.view.scene.tipAt);
      const atTip = overTip() ? { link: 3, point: new Vector3(), at } : null;
      const grip = this.mostPush ? robot.hit(ray) ?? atTip : null;
      if (!grip && (!atTip || player.isLive)) return;
      event.stopImmediatePropagation();
      player.pause();
      this.dragging = !grip;
      this.grip = grip;
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
      plane.setFromNormalAndCoplanarPoint(camera.getWorldDirection(eye), grip?.at ?? at);
    }, true);
    canvas.addEventListener("pointermove", (event) => {
      aim(event);
      const there = ray.ray.intersectPlane(plane, hit);
      if (there && this.grip?.at) this.push(hit.clone().sub(this.grip.at).multiplyScalar(this.stiff));
      else if (there && this.dragging) this.drag([hit.x, hit.y, Math.max(hit.z, 0)]);
      else canvas.style.cursor = overTip() || (this.mostPush && robot.hit(ray)) ? "grab" : "default";
    });
    const release = () => {
      this.letGo();
      if (!this.dragging) return;
      this.dragging = this.target.visible = this.nearest.visible = false;
      this.missing.set([]);
      this.view.moved();
    };
    for (const event of ["pointerup", "pointercancel", "blur"]) canvas.addEventListener(event, release);
    canvas.addEventListener("keyup", (event) => { if (event.key === "Shift") this.letGo(); });
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("focus", () => { controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { controls.enableZoom = false; });
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  }

  // ---- dragging the tip

  // The hand wants the tip at p.
  drag(p) {
    const { l, limits, q, options, model, scene } = this.view;
    this.wantedAt = p;
    this.best = reach(l, limits, p, q);
    if (options.drag === "kernel" && !model.isPage) this.view.ask({ drag: p, q });
    else this.followed(this.best.q, "browser");
    scene.soon();
  }

  // An answer to the hand: q, or null for none. Shows what is missing to the point wanted.
  followed(q, whose) {
    const { view } = this;
    if (q) view.pose(q, whose === "browser");
    if (q && whose === "kernel") this.write();
    if (!this.dragging) return;
    const at = tip(view.l, q ?? this.best.q), away = Math.hypot(...at.map((v, i) => v - this.wantedAt[i]));
    this.target.position.set(...this.wantedAt);
    this.nearest.position.set(...at);
    this.target.visible = true;
    this.nearest.visible = away > 0.001;
    this.missing.set(away > 0.001 ? [at, this.wantedAt] : []);
    const millimetres = `${(1000 * away).toFixed(0)} mm`;
    if (q) view.say(away > 0.001 ? `out of reach by ${millimetres}; the black point is the nearest` : "");
    else view.say(away > 0.001 ? `no solution here: the nearest point is ${millimetres} away` : "no solution, although this point can be reached");
    view.scene.soon();
  }

  // The trail that the hand writes.
  write() {
    const { l, q, player, scene } = this.view, at = tip(l, q), last = this.written.at(-1);
    if (last && Math.hypot(...at.map((v, i) => v - last[i])) < 0.002) return;
    this.written = [...this.written, at].slice(-3000);
    if (!player.track) scene.trails[0].set(this.written);
  }

  clear() {
    this.written = [];
    this.view.scene.trails[0].set([]);
    this.view.scene.soon();
  }

  // ---- pushing the arm

  mayPush(most) {
    this.mostPush = most;
    this.stiff = most / (0.2 * this.view.scene.size); // N a metre of the arrow, and of the way that the hand goes
  }

  // The hand pushes with `force`, N in the base. Each message costs as much as a picture, and the kernel forgets a push
  // after a second: stillPushes() sends it again.
  push(force) {
    const { grip, view } = this, now = performance.now();
    grip.force = force.clampLength(0, this.mostPush);
    grip.felt ??= now;
    view.say(now - grip.felt < FELT ? `you push with ${force.length().toFixed(1)} N at link ${grip.link}` : "the computer is busy (perhaps a cell is running): the arm does not feel your hand yet");
    if (!force.length() || now - (grip.sent ?? 0) > (grip.told === force ? 400 : 80)) {
      Object.assign(grip, { sent: now, told: force });
      view.ask({ push: [grip.link, grip.point.toArray(), force.toArray()] });
    }
    this.showPush();
    view.scene.soon();
  }

  felt() {
    if (this.grip) this.grip.felt = performance.now();
  }

  stillPushes() {
    if (!this.mostPush) this.letGo();
    else if (this.grip?.force) this.push(this.grip.force);
  }

  letGo() {
    if (!this.grip) return;
    if (this.grip.force) this.push(new Vector3());
    this.grip = null;
    this.view.moved();
  }

  // The arrow of the push, from where the hand is.
  showPush() {
    const { grip, head, shaft } = this, force = grip?.force;
    head.visible = shaft.line.visible = Boolean(force?.length());
    if (!head.visible) return;
    const from = grip.point.clone().applyMatrix4(this.view.scene.robot.links[grip.link].matrix);
    head.position.copy(from).addScaledVector(force, 1 / this.stiff);
    shaft.set([from.toArray(), head.position.toArray()]);
    head.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), force.clone().normalize());
  }

  // ---- keys

  key(event) {
    const { scene, player } = this.view, { controls, camera } = scene;
    const side = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0, up = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
    if (event.shiftKey && this.mostPush && (side || up)) { // 1 N more
      this.grip ??= { link: 3, point: new Vector3() };
      const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
      this.push((this.grip.force ?? new Vector3()).clone().addScaledVector(right, side).add(new Vector3(0, 0, up)));
      return event.preventDefault();
    }
    const turn = { ArrowLeft: 0.06, ArrowRight: -0.06 }[event.key], tilt = { ArrowUp: 0.06, ArrowDown: -0.06 }[event.key];
    const zoom = { "+": 0.92, "=": 0.92, "-": 1.08 }[event.key];
    if (turn) controls.rotateLeft(turn);
    else if (tilt) controls.rotateUp(tilt);
    else if (zoom) controls.dollyIn(zoom);
    else if (event.key === "Home") scene.lookFromStart();
    else if (event.key === " " && player.track) player.toggle();
    else return;
    scene.turned ||= Boolean(turn || tilt || zoom);
    event.preventDefault();
  }
}
