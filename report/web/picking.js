// Nodes and faces that a ray from the eye meets.

/**
 * Faces of things that a ray meets before `end`: calls `take(thing, triangle, distance)` for each until it returns true.
 * Moller & Trumbore 1997. Things that are seen through and symbols hide nothing.
 */
function meet_faces(things, eye, direction, end, take) {
  const [ex, ey, ez] = eye, [dx, dy, dz] = direction;
  for (const thing of things) {
    if (!(thing.triangles?.length > 0) || (thing.alpha ?? 1) < 1 || thing.is_symbol) continue;
    const { points, triangles } = thing;
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ax = points[a], ay = points[a + 1], az = points[a + 2];
      const ux = points[b] - ax, uy = points[b + 1] - ay, uz = points[b + 2] - az;
      const vx = points[c] - ax, vy = points[c + 1] - ay, vz = points[c + 2] - az;
      const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
      const det = ux * px + uy * py + uz * pz;
      if (det === 0) continue;
      const sx = ex - ax, sy = ey - ay, sz = ez - az;
      const u = (sx * px + sy * py + sz * pz) / det;
      if (!(u >= 0 && u <= 1)) continue;
      const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
      const v = (dx * qx + dy * qy + dz * qz) / det;
      if (!(v >= 0 && u + v <= 1)) continue;
      const distance = (vx * qx + vy * qy + vz * qz) / det;
      if (distance > 0 && distance < end && take(thing, t / 3, distance)) return;
    }
  }
}

/** The face that the ray meets first. @returns {{thing: any, triangle: number, distance: number} | null} */
export function find_front(things, { eye, direction }) {
  let found = null;
  meet_faces(things, eye, direction, Infinity, (thing, triangle, distance) => {
    if (!found || distance < found.distance) found = { thing, triangle, distance };
    return false;
  });
  return found;
}

/** Returns true if a face of any thing is in front of point k of `thing`; faces that end there are not. */
export function is_hidden(things, eye, thing, k, tolerance) {
  const way = eye.map((e, i) => thing.points[3 * k + i] - e), length = Math.hypot(...way);
  let is_covered = false;
  meet_faces(things.filter((t) => !t.is_detail), eye, way.map((w) => w / length), length - tolerance, (other, t) => {
    const { triangles } = other;
    is_covered = other.points !== thing.points || (triangles[3 * t] !== k && triangles[3 * t + 1] !== k && triangles[3 * t + 2] !== k);
    return is_covered;
  });
  return is_covered;
}

/** Distance of a place from the segment a b, in a plane. */
export function find_distance_to_segment([x, y], a, b) {
  const u = [b[0] - a[0], b[1] - a[1]], square = u[0] ** 2 + u[1] ** 2;
  const s = square > 0 ? Math.max(0, Math.min(1, ((x - a[0]) * u[0] + (y - a[1]) * u[1]) / square)) : 0;
  return Math.hypot(x - a[0] - s * u[0], y - a[1] - s * u[1]);
}
