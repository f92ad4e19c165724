// The arm as solids. Each link is made once in the coordinates of its own frame and then placed by that frame's 4 x 4
// transform, so that wrong transforms draw a wrong arm.
import {
  BoxGeometry, CylinderGeometry, ExtrudeGeometry, Group, Mesh, MeshBasicMaterial, MeshPhongMaterial, Shape, SphereGeometry,
} from "three";

export const COLOURS = {
  column: "#aab2bd", dark: "#3a4048", upper: "#0072B2", fore: "#D55E00", x: "#D55E00", y: "#009E73", z: "#0072B2",
  trail: "#009E73", target: "#CC79A7", ball: "#C8102E", second: "#009E73", alarm: "#E69F00",
};

// A plate along x, round at both ends: radius `far` at x = -length, `near` at x = 0.
function plate(length, far, near, thickness) {
  const shape = new Shape();
  shape.absarc(0, 0, near, -Math.PI / 2, Math.PI / 2);
  shape.absarc(-length, 0, far, Math.PI / 2, 1.5 * Math.PI);
  shape.closePath();
  const bevel = 0.12 * Math.min(near, thickness);
  const options = { depth: thickness - 2 * bevel, curveSegments: 20, bevelSize: bevel, bevelThickness: bevel, bevelSegments: 2 };
  return new ExtrudeGeometry(shape, options).translate(0, 0, bevel - thickness / 2);
}

const hub = (radius, width) => new CylinderGeometry(radius, radius, width, 40).rotateX(Math.PI / 2); // along z
const alongX = (radius, width) => new CylinderGeometry(radius, radius, width, 28).rotateZ(Math.PI / 2);

export class Robot {
  // upper, fore: colours of the links; opacity < 1 for a ghost; shadow: flat and black, one colour for all.
  constructor([l1, l2, l3], { upper = COLOURS.upper, fore = COLOURS.fore, opacity = 1, shadow = false } = {}) {
    const s = (l2 + l3) / 0.572; // sizes below are metres of the IR50P
    const paint = (color) => shadow
      ? new MeshBasicMaterial({ color: "#000000", transparent: true, opacity: 0.1, depthWrite: false })
      : new MeshPhongMaterial({ color, shininess: 45, specular: "#333333", opacity, transparent: opacity < 1 });
    const paints = { column: paint(COLOURS.column), dark: paint(COLOURS.dark), upper: paint(upper), fore: paint(fore) };
    this.links = [0, 1, 2, 3].map(() => Object.assign(new Group(), { matrixAutoUpdate: false }));
    const add = (link, geometry, colour) => {
      const mesh = new Mesh(geometry, paints[colour]);
      this.links[link].add(mesh);
      return mesh;
    };
    const stand = (radius, height, middle) => // in frame 1: y points up, the shoulder is the origin
      new CylinderGeometry(radius * s, 1.06 * radius * s, height, 48).translate(0, middle - l1, 0);
    const foot = new CylinderGeometry(0.105 * s, 0.115 * s, 0.03 * s, 56).rotateX(Math.PI / 2).translate(0, 0, 0.015 * s);
    add(0, foot, "dark");
    const shaft = Math.max(l1 - 0.085 * s, 0.04 * s);
    add(1, stand(0.062, shaft - 0.03 * s, (shaft + 0.03 * s) / 2), "column");
    add(1, stand(0.07, 0.02 * s, shaft), "dark");
    for (const side of [-1, 1]) {
      const cheek = plate(Math.min(0.085 * s, l1), 0.05 * s, 0.036 * s, 0.014 * s).rotateZ(Math.PI / 2);
      add(1, cheek.translate(0, 0, side * 0.047 * s), "column");
      add(2, plate(l2, 0.034 * s, 0.03 * s, 0.011 * s).translate(0, 0, side * 0.031 * s), "upper");
    }
    const beam = new BoxGeometry(0.45 * l2, 0.034 * s, 0.056 * s).translate(-l2 / 2, 0, 0);
    add(2, beam, "upper");
    this.hubs = [
      add(1, stand(0.064, 0.006 * s, 0.034 * s), "dark"),
      add(1, hub(0.024 * s, 0.122 * s), "dark"),
      add(2, hub(0.021 * s, 0.084 * s), "dark"),
    ];
    const hand = 0.085 * s, toFrame3 = (geometry) => geometry.rotateX(Math.PI / 2);
    add(3, toFrame3(plate(l3 - hand - 0.02 * s, 0.028 * s, 0.019 * s, 0.042 * s).translate(-hand - 0.02 * s, 0, 0)), "fore");
    add(3, alongX(0.015 * s, 0.03 * s).translate(-hand, 0, 0), "dark");
    add(3, new BoxGeometry(0.016 * s, 0.058 * s, 0.022 * s).translate(-hand + 0.02 * s, 0, 0), "column");
    for (const side of [-1, 1]) {
      add(3, new BoxGeometry(0.066 * s, 0.007 * s, 0.018 * s).translate(-0.026 * s, side * 0.022 * s, 0), "dark");
    }
    this.tip = add(3, new SphereGeometry(0.009 * s, 24, 16), "fore");
    this.root = new Group().add(...this.links);
    if (!shadow) this.hubs.forEach((mesh) => { mesh.material = mesh.material.clone(); });
  }

  // transforms: four Matrix4. What is not finite is not drawn.
  place(transforms) {
    transforms.forEach((matrix, i) => {
      this.links[i].visible = matrix.elements.every(Number.isFinite);
      this.links[i].matrix.copy(matrix);
      this.links[i].matrixWorldNeedsUpdate = true;
    });
  }

  // Where a ray first meets a link that moves: {link, point: in its frame, at: the same place in the base}, or null.
  hit(ray) {
    const [found] = ray.intersectObjects(this.links.slice(1)), frame = found?.object.parent;
    return found ? { link: this.links.indexOf(frame), point: frame.worldToLocal(found.point.clone()), at: found.point } : null;
  }

  // joints: three booleans, whether each is at a stop: its hub lights up.
  alarm(joints) {
    this.hubs.forEach((mesh, i) => { mesh.material.emissive.set(joints[i] ? COLOURS.alarm : "#000000"); });
  }
}
