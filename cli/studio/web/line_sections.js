// Bars, beams, rods and tubes with their cross sections: faces for the viewer.
import { unpack_floats, unpack_indices } from "./unpack.js";

/** More faces are thinned: sections of one element in some. */
const kMaxFaces = 100000;
const kSmooth = Math.cos((27 * Math.PI) / 180);  // between sides of a round section

/**
 * Sides, ends and lines of the solid between the stations of a section. Points are numbered station by station, corner by
 * corner; sides that two faces share are inside.
 */
function make_template({ stations }) {
  const corners = stations.map((s) => s.faces.flat()), first = corners[0], count = first.length;
  const size = Math.max(...first.flat().map(Math.abs)), key = ([y, z]) => `${Math.round((y / size) * 1e6)},${Math.round((z / size) * 1e6)}`;
  const sides = new Map(), ends = [];
  let from = 0;
  for (const face of stations[0].faces) {
    face.forEach((corner, k) => {
      const a = from + k, b = from + ((k + 1) % face.length), [ka, kb] = [key(first[a]), key(first[b])];
      if (sides.has(`${kb} ${ka}`)) sides.delete(`${kb} ${ka}`);
      else sides.set(`${ka} ${kb}`, [a, b]);
      if (k > 1) ends.push(from, from + k - 1, from + k);
    });
    from += face.length;
  }
  const triangles = [], edges = [], last = (stations.length - 1) * count, at_corner = new Map();
  for (const [a, b] of sides.values()) {
    for (let s = 0; s < last; s += count) triangles.push(s + a, s + b, s + count + b, s + a, s + count + b, s + count + a);
    edges.push(a, b, last + a, last + b);
    const way = first[b].map((v, i) => v - first[a][i]), length = Math.hypot(...way);
    for (const corner of [a, b]) at_corner.set(key(first[corner]), [...(at_corner.get(key(first[corner])) ?? []), { corner, way: way.map((v) => v / length) }]);
  }
  for (const found of at_corner.values()) {
    const [p, q] = found, is_smooth = found.length === 2 && p.way[0] * q.way[0] + p.way[1] * q.way[1] > kSmooth;
    if (!is_smooth) for (let s = 0; s < last; s += count) edges.push(s + p.corner, s + count + p.corner);
  }
  for (let k = 0; k < ends.length; k += 3) triangles.push(ends[k], ends[k + 2], ends[k + 1], last + ends[k], last + ends[k + 1], last + ends[k + 2]);
  return { x: stations.map((s) => s.x), corners, triangles, edges };
}

export class LineSections {
  /** @param {any} json  of the answer  @param {Map<number, number>} row_of_id  rows of the line elements */
  constructor(json, row_of_id) {
    this.shapes = json.shapes;
    this.pins = json.pins;
    this.without = json.without;
    this.shape = unpack_indices(json.shape);
    this.frame = unpack_floats(json.frame);
    this.rows = Array.from(unpack_indices(json.element), (id) => row_of_id.get(id) ?? -1);
    /** Place among the sections of each element that has one. */
    this.of_row = new Map(this.rows.map((row, k) => [row, k]));
    this.templates = this.shapes.map(make_template);
    const faces = this.shape.reduce((sum, s) => sum + this.templates[s].triangles.length / 3, 0);
    this.every = Math.max(1, Math.ceil(faces / kMaxFaces));
  }

  /** "I 0.3 0.2 …" of a PBARL; what stands for a section of which the card gives A and I. */
  describe_shape({ card, id, text, equivalent }) {
    return equivalent ? `drawn as ${text}` : `${card}${id ? " " + id : ""}: ${text}`;
  }
  describe(row) {
    const k = this.of_row.get(row);
    return k === undefined ? "" : this.describe_shape(this.shapes[this.shape[k]]);
  }

  /** Solids of the elements in these rows. @param {Iterable<number>} rows */
  make_solids(rows) {
    const points = [], triangles = [], edges = [], of_triangle = [];
    for (const row of rows) {
      const k = this.of_row.get(row);
      if (k === undefined || k % this.every !== 0) continue;
      const { x, corners, ...more } = this.templates[this.shape[k]], first = points.length / 3;
      const [a, b, y, z] = [0, 3, 6, 9].map((i) => this.frame.subarray(12 * k + i, 12 * k + i + 3));
      x.forEach((share, s) => {
        for (const [u, v] of corners[s]) for (let i = 0; i < 3; ++i) points.push(a[i] + share * (b[i] - a[i]) + u * y[i] + v * z[i]);
      });
      for (const t of more.triangles) triangles.push(first + t);
      for (const t of more.edges) edges.push(first + t);
      for (let t = 0; t < more.triangles.length; t += 3) of_triangle.push(row);
    }
    return { points: Float32Array.from(points), triangles: Uint32Array.from(triangles), edges: Uint32Array.from(edges), elements: { of_triangle, of_edge: [] } };
  }
}
