/**
 * Fewer faces of a large mesh, for views that move where no graphics card draws. Vertex clustering (Rossignac & Borrel
 * 1993): the corners in a cell of a grid become one of them, the farthest from the middle; faces that lose a corner go.
 * @param {Float32Array} points
 * @param {Uint32Array} triangles
 * @param {number} max  faces
 * @returns {{triangles: Uint32Array, sources: Uint32Array}}  faces of the same points; which face each was
 */
export function make_coarse_mesh(points, triangles, max) {
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity], area = 0;
  for (const corner of triangles)
    for (let c = 0; c < 3; ++c) {
      low[c] = Math.min(low[c], points[3 * corner + c]);
      high[c] = Math.max(high[c], points[3 * corner + c]);
    }
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const u = [0, 1, 2].map((i) => points[b + i] - points[a + i]), v = [0, 1, 2].map((i) => points[c + i] - points[a + i]);
    area += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
  }
  const middle = low.map((v, i) => (v + high[i]) / 2);
  // Two faces per square of the surface.
  for (let cell = Math.sqrt((2 * area) / max) || 1; ; cell *= 1.2) {
    const found = cluster(points, triangles, low, middle, cell);
    if (found.triangles.length <= 3 * max) return found;
  }
}

function cluster(points, triangles, low, middle, cell) {
  const cells = new Map(), of_point = new Int32Array(points.length / 3).fill(-1), best = [], distance = [];
  for (const p of triangles) {
    if (of_point[p] >= 0) continue;
    const [i, j, k] = low.map((v, c) => Math.floor((points[3 * p + c] - v) / cell));
    const key = (i * 200000 + j) * 200000 + k, at = cells.get(key) ?? cells.size;
    if (at === cells.size) cells.set(key, at);
    of_point[p] = at;
    const d = middle.reduce((sum, v, c) => sum + (points[3 * p + c] - v) ** 2, 0);
    if (!(d <= distance[at])) [best[at], distance[at]] = [p, d];
  }
  const kept = [], sources = [], seen = new Set(), count = cells.size;
  for (let t = 0; t < triangles.length / 3; ++t) {
    const [a, b, c] = [of_point[triangles[3 * t]], of_point[triangles[3 * t + 1]], of_point[triangles[3 * t + 2]]];
    if (a === b || b === c || c === a) continue;
    const least = Math.min(a, b, c), most = Math.max(a, b, c), key = (least * count + (a + b + c - least - most)) * count + most;
    if (seen.has(key)) continue;
    seen.add(key);
    kept.push(best[a], best[b], best[c]);
    sources.push(t);
  }
  return { triangles: Uint32Array.from(kept), sources: Uint32Array.from(sources) };
}
