// The elbow arm in standard DH: l = column, upper arm, forearm (m); q = three joint angles (rad).
import { Matrix4 } from "three";

// Transforms of frames 0 to 3, coordinates of frame i to the base: four Matrix4. Frame i sits at the far end of link i.
export function frames([l1, l2, l3], [a, b, c]) {
  const ca = Math.cos(a), sa = Math.sin(a);
  const turned = (angle, x, y, z) => {
    const cosine = Math.cos(angle), sine = Math.sin(angle);
    return new Matrix4().set(
      ca * cosine, -ca * sine, sa, x,
      sa * cosine, -sa * sine, -ca, y,
      sine, cosine, 0, z,
      0, 0, 0, 1,
    );
  };
  const elbow = [l2 * Math.cos(b) * ca, l2 * Math.cos(b) * sa, l1 + l2 * Math.sin(b)];
  const [x, y, z] = tip([l1, l2, l3], [a, b, c]);
  const hand = turned(b + c, x, y, z).multiply(new Matrix4().makeRotationX(-Math.PI / 2));
  return [new Matrix4(), turned(0, 0, 0, l1), turned(b, ...elbow), hand];
}

// The tip, [x, y, z] in m.
export function tip([l1, l2, l3], [a, b, c]) {
  const rho = l2 * Math.cos(b) + l3 * Math.cos(b + c);
  return [rho * Math.cos(a), rho * Math.sin(a), l1 + l2 * Math.sin(b) + l3 * Math.sin(b + c)];
}

// Velocity of the tip per joint rate: three rows of three, m.
export function jacobian([, l2, l3], [a, b, c]) {
  const rho = l2 * Math.cos(b) + l3 * Math.cos(b + c);
  const z2 = -l2 * Math.sin(b) - l3 * Math.sin(b + c), z3 = -l3 * Math.sin(b + c);
  const ca = Math.cos(a), sa = Math.sin(a);
  return [
    [-rho * sa, ca * z2, ca * z3],
    [rho * ca, sa * z2, sa * z3],
    [0, rho, l3 * Math.cos(b + c)],
  ];
}

const clamp = (value, [low, high]) => Math.min(Math.max(value, low), high);
const distance = (p, r) => Math.hypot(p[0] - r[0], p[1] - r[1], p[2] - r[2]);

// Joint angles within the limits that bring the tip to p, or as near as they can: {q, miss in m}. Of angles that are
// equally near, those that turn the joints least from `now`.
export function reach(l, limits, p, now) {
  let best = null;
  for (const start of [...branches(l, p, now), now]) {
    const q = descend(l, limits, p, start.map((value, i) => clamp(value, limits[i])));
    const miss = distance(tip(l, q), p), turn = Math.max(...q.map((value, i) => Math.abs(value - now[i])));
    const better = !best || miss < best.miss - 1e-7 || (miss < best.miss + 1e-7 && turn < best.turn);
    if (better) best = { q, miss, turn };
  }
  return best;
}

// The four closed-form branches by half angles; a point off the shell is first moved onto it.
function branches([l1, l2, l3], p, now) {
  const z = p[2] - l1, side = Math.hypot(p[0], p[1]), r = Math.hypot(side, z);
  const k = clamp(r, [Math.abs(l2 - l3), l2 + l3]) / Math.max(r, 1e-9), r2 = (r * k) ** 2;
  const found = [];
  for (const behind of [0, Math.PI]) {
    for (const sign of [-1, 1]) {
      const above = Math.sqrt(Math.max((l2 + l3) ** 2 - r2, 0)), below = Math.sqrt(Math.max(r2 - (l2 - l3) ** 2, 0));
      const q3 = sign * 2 * Math.atan2(above, below), rho = (behind ? -side : side) * k;
      const q2 = Math.atan2(z * k, rho) - Math.atan2(l3 * Math.sin(q3), l2 + l3 * Math.cos(q3));
      const q = [Math.atan2(p[1], p[0]) + behind, q2, q3];
      found.push(q.map((value, i) => value - 2 * Math.PI * Math.round((value - now[i]) / (2 * Math.PI))));
    }
  }
  return found;
}

// Where limits cut a branch off: damped steps along the gradient, clamped, until the tip comes no nearer.
function descend(l, limits, p, q) {
  for (let step = 0; step < 25; step++) {
    const at = tip(l, q), error = p.map((value, i) => value - at[i]), miss = Math.hypot(...error);
    if (miss < 1e-9) break;
    const J = jacobian(l, q);
    const gradient = [0, 1, 2].map((j) => J[0][j] * error[0] + J[1][j] * error[1] + J[2][j] * error[2]);
    const gain = 1 / ((l[1] + l[2]) ** 2 + l[2] ** 2);
    const next = q.map((value, j) => clamp(value + gain * gradient[j], limits[j]));
    if (miss - distance(tip(l, next), p) < 1e-7) break;
    q = next;
  }
  return q;
}
