// What stands around the arm: light, table, and the layers that can be switched on and off.
import {
  ArrowHelper, BufferGeometry, CanvasTexture, CircleGeometry, Color, DirectionalLight, DoubleSide,
  Float32BufferAttribute, Group, HemisphereLight, LineDashedMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshPhongMaterial, PolarGridHelper, Scene, SphereGeometry, Sprite, SRGBColorSpace,
  SpriteMaterial, Vector3,
} from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { jacobian } from "./kinematics.js";
import { COLOURS } from "./robot.js";

// What a layer's colours mean.
export const KEYS = {
  frames: [[COLOURS.x, "x"], [COLOURS.y, "y"], [COLOURS.z, "z"]],
  "velocity ellipsoid": [["#56B4E9", "velocity ellipsoid"]],
  "force ellipsoid": [[COLOURS.target, "force ellipsoid"]],
};

export function makeScene(reach) {
  const scene = new Scene();
  scene.background = new Color("#fbfcfd");
  const sun = new DirectionalLight("#ffffff", 2.4), fill = new DirectionalLight("#dfe9ff", 0.7);
  sun.position.set(0.5 * reach, -1.6 * reach, 3 * reach);
  fill.position.set(-2 * reach, 1.5 * reach, 1.2 * reach);
  scene.add(sun, fill, new HemisphereLight("#ffffff", "#c9ced6", 1.5));
  return scene;
}

// A text that faces the eye; size: its height, m.
export function label(text, colour, size) {
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d"), font = "600 44px sans-serif";
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + 16;
  canvas.height = 60;
  Object.assign(pen, { font, textBaseline: "middle", lineWidth: 8, strokeStyle: "#ffffffdd", fillStyle: colour, lineJoin: "round" });
  pen.strokeText(text, 8, 31);
  pen.fillText(text, 8, 31);
  const map = Object.assign(new CanvasTexture(canvas), { colorSpace: SRGBColorSpace, anisotropy: 4 });
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false, transparent: true }));
  sprite.scale.set((size * canvas.width) / canvas.height, size, 1);
  sprite.renderOrder = 10;
  return sprite;
}

// A line of `width` CSS pixels through points, of which the first n can be shown.
export class Trail {
  constructor(colour, width = 2.5) {
    this.material = new LineMaterial({ color: colour, linewidth: width });
    this.line = new Line2(new LineGeometry(), this.material);
    this.line.frustumCulled = false;
    this.set([]);
  }

  set(points) { // [[x, y, z], ...] m
    const flat = points.length > 1 ? points.flat() : [0, 0, 0, 0, 0, 0];
    this.line.geometry.dispose();
    this.line.geometry = new LineGeometry().setPositions(flat);
    this.show(points.length);
  }

  show(n) {
    this.line.geometry.instanceCount = Math.max(n - 1, 0);
  }
}

function axes(length, name) {
  const group = Object.assign(new Group(), { matrixAutoUpdate: false });
  ["x", "y", "z"].forEach((axis, i) => {
    const along = new Vector3().setComponent(i, 1);
    const arrow = new ArrowHelper(along, new Vector3(), length, COLOURS[axis], 0.22 * length, 0.13 * length);
    const letter = label(axis + name, COLOURS[axis], 0.38 * length);
    letter.position.copy(along.multiplyScalar(1.18 * length));
    group.add(arrow, letter);
  });
  return group;
}

function ellipsoid(colour) {
  const look = { color: colour, transparent: true, opacity: 0.35, side: DoubleSide, depthWrite: false };
  const mesh = new Mesh(new SphereGeometry(1, 40, 24), new MeshPhongMaterial(look));
  return Object.assign(mesh, { matrixAutoUpdate: false });
}

function dashed(points, colour) {
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
  return new LineSegments(geometry, new LineDashedMaterial({ color: colour, dashSize: 0.02, gapSize: 0.012 })).computeLineDistances();
}

// All layers by name: Object3D each. Only what can be shown is there.
export class Layers {
  constructor(scene, { lengths, ball }) {
    const reach = lengths[1] + lengths[2];
    this.lengths = lengths;
    const table = new Group(), top = new Mesh(new CircleGeometry(1.12 * reach, 96), new MeshBasicMaterial({ color: "#eef1f4", side: DoubleSide }));
    const grid = new PolarGridHelper(1.1 * reach, 12, Math.round(11 * reach), 96, "#d3d9e0", "#d3d9e0").rotateX(Math.PI / 2);
    grid.position.z = 0.0006;
    table.add(top, grid);
    this.triads = [0, 1, 2, 3].map((i) => axes(0.17 * reach, String(i)));
    this.joints = [1, 2, 3].map((i) => {
      const name = label(`joint ${i}`, COLOURS.dark, 0.07 * reach);
      name.position.z = 0.3 * reach;
      const group = Object.assign(new Group(), { matrixAutoUpdate: false });
      return group.add(dashed([[0, 0, -0.25 * reach], [0, 0, 0.27 * reach]], COLOURS.dark), name);
    });
    this.velocity = ellipsoid(KEYS["velocity ellipsoid"][0][0]);
    this.force = ellipsoid(COLOURS.target);
    this.all = {
      table, frames: new Group().add(...this.triads), "joint axes": new Group().add(...this.joints),
      "velocity ellipsoid": this.velocity, "force ellipsoid": this.force,
    };
    if (ball) {
      const [[first, ...more], radius] = ball;
      this.all.ball = new Mesh(new SphereGeometry(radius, 32, 24), new MeshPhongMaterial({ color: COLOURS.ball, shininess: 60 }));
      for (const p of more) {
        const other = this.all.ball.clone(false);
        other.position.set(...p).sub(new Vector3(...first));
        this.all.ball.add(other);
      }
      this.all.ball.position.set(...first);
    }
    scene.add(...Object.values(this.all));
  }

  // on: names to be shown.
  show(on) {
    for (const [name, thing] of Object.entries(this.all)) thing.visible = on.includes(name);
  }

  place(transforms, q) {
    transforms.forEach((matrix, i) => this.triads[i].matrix.copy(matrix));
    this.joints.forEach((group, i) => group.matrix.copy(transforms[i]));
    const J = jacobian(this.lengths, q), at = new Vector3().setFromMatrixPosition(transforms[3]);
    const speed = new Matrix4().set(...J.flatMap((row) => [...row, 0]), 0, 0, 0, 1);
    // J carries the ball of unit joint rates onto the velocity ellipsoid, its inverse transpose that of unit torques
    // onto the force ellipsoid; at a singular pose the latter has no end
    const singular = Math.abs(speed.determinant()) < 1e-4;
    this.force.scale.setScalar(1);
    this.force.matrix.copy(singular ? new Matrix4().makeScale(0, 0, 0) : speed.clone().invert().transpose());
    this.force.matrix.premultiply(new Matrix4().makeScale(0.025, 0.025, 0.025)).setPosition(at);
    this.velocity.matrix.copy(speed.premultiply(new Matrix4().makeScale(0.25, 0.25, 0.25))).setPosition(at);
  }
}
