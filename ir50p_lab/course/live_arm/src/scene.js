// What is seen: the arm, its shadow, a second arm, the set point, trails; the camera, and when to draw.
import { Group, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { frames } from "./kinematics.js";
import * as renderer from "./renderer.js";
import { COLOURS, Robot } from "./robot.js";
import { Layers, makeScene, Trail } from "./stage.js";

const REST = 160; // ms without motion until the fine picture is drawn

export class ArmScene {
  // l: lengths of the links, m; options as in view.py; drawn: called after each picture.
  constructor(canvas, l, options, drawn) {
    Object.assign(this, { canvas, l, drawn, size: l[1] + l[2] });
    this.scene = makeScene(this.size);
    this.layers = new Layers(this.scene, options);
    this.robot = new Robot(l);
    this.ghost = new Robot(l, { upper: "#8a8f98", fore: "#8a8f98", opacity: 0.3 });
    this.second = new Robot(l, { upper: COLOURS.second, fore: COLOURS.second });
    this.shade = new Robot(l, { shadow: true }); // the arm pressed flat: a shadow without a shadow map
    this.shadow = new Group().add(this.shade.root);
    this.shadow.scale.z = 1e-4;
    this.shadow.position.z = 0.0012;
    this.trails = [new Trail(COLOURS.trail), new Trail(COLOURS.second)];
    this.ghost.root.visible = this.second.root.visible = false;
    this.scene.add(this.robot.root, this.ghost.root, this.second.root, this.shadow, ...this.trails.map((trail) => trail.line));
    this.camera = new PerspectiveCamera(30, 16 / 9, 0.01, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableZoom = false; // the wheel scrolls the page until the view is clicked
    this.controls.addEventListener("change", () => this.soon());
    this.controls.addEventListener("start", () => { this.turned = true; });
    renderer.enter(this);
  }

  // Show the arm at the transforms of its frames. on: names of the layers that are shown.
  place(transforms, q, on) {
    const along = (T, x) => new Vector3(x, 0, 0).applyMatrix4(T).toArray(); // of a link, whose frame is at its far end
    this.robot.place(transforms);
    this.shade.place(transforms);
    this.layers.place(transforms, q);
    this.layers.show([...on]);
    this.withTable = on.has("table");
    this.shade.root.visible = on.has("shadow");
    this.trails.forEach((trail) => { trail.line.visible = on.has("trail"); });
    this.joints = [...transforms.map((T) => along(T, 0)), along(transforms[2], -this.l[1]), along(transforms[3], -this.l[2])];
    this.tipAt = this.joints[3];
    this.soon();
  }

  // Show a transparent arm at the set point, and a second one; null: none.
  placeOthers(wanted, second) {
    for (const [robot, q] of [[this.ghost, wanted], [this.second, second]]) {
      robot.root.visible = Boolean(q?.every(Number.isFinite));
      if (robot.root.visible) robot.place(frames(this.l, q));
    }
  }

  resize(width, height) {
    Object.assign(this, { width, height });
    this.canvas.style.height = height + "px";
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (`${width} ${height}` !== this.framed && this.joints && !this.turned) this.lookFromStart();
    this.soon();
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
    const points = [...this.joints, ...runs, ...(this.withTable ? rim : [[0, 0, 0]])].map((p) => new Vector3(...p));
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

  // Bring the arm back into the picture if an end of a link has left it.
  keepInSight() {
    const outside = (p) => { const { x, y } = new Vector3(...p).project(this.camera); return Math.max(Math.abs(x), Math.abs(y)) > 1; };
    if (this.width && !this.turned && this.joints.some(outside)) this.frame();
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
    this.scene.traverse(({ material }) => material?.resolution?.set(this.width, this.height)); // of lines with a width
    renderer.paint(this, moving);
    this.drawn();
  }

  // For tests: where on the page a point of the base frame is seen.
  onPage(p) {
    const at = new Vector3(...p).project(this.camera), box = this.canvas.getBoundingClientRect();
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height];
  }

  close() {
    this.closed = true;
    clearTimeout(this.fine);
    this.controls.dispose();
    renderer.leave(this);
    this.scene.traverse((thing) => {
      thing.geometry?.dispose();
      thing.material?.map?.dispose();
      thing.material?.dispose();
    });
  }
}
