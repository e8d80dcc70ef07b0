import { unpack_floats, unpack_indices, unpack_shorts } from "./unpack.js";

// A body as formats/report/drawing.hpp writes it, and its points when its modes move.
export class Drawing {
  constructor(json) {
    this.xyz = unpack_floats(json.xyz);
    this.triangles = unpack_indices(json.triangles);
    this.edges = unpack_indices(json.edges);
    this.ghosts = unpack_indices(json.ghosts);
    this.packed = json.shapes;
    this.shapes = new Array(json.shapes.length);
    this.points = new Float32Array(this.xyz);
    this.size = new Float32Array(this.xyz.length / 3);  // of the displacement of each point
  }

  get_shape(j) {
    if (!this.shapes[j]) {
      const { data, largest } = this.packed[j];
      const shorts = unpack_shorts(data);
      this.shapes[j] = Float32Array.from(shorts, (v) => (v * largest) / 32767);
    }
    return this.shapes[j];
  }

  // The largest displacement of a point in shape j with coefficient 1.
  get_reach(j) {
    const shape = this.get_shape(j);
    let most = 0;
    for (let i = 0; i < shape.length; i += 3) most = Math.max(most, Math.hypot(shape[i], shape[i + 1], shape[i + 2]));
    return most;
  }

  // points = xyz + scale Σ coefficients[j] shape j.
  deform(coefficients, scale) {
    this.points.set(this.xyz);
    coefficients.forEach((c, j) => {
      if (c === 0 || j >= this.shapes.length) return;
      const shape = this.get_shape(j), factor = scale * c;
      for (let i = 0; i < shape.length; ++i) this.points[i] += factor * shape[i];
    });
    for (let i = 0, k = 0; i < this.points.length; i += 3, ++k)
      this.size[k] = Math.hypot(this.points[i] - this.xyz[i], this.points[i + 1] - this.xyz[i + 1], this.points[i + 2] - this.xyz[i + 2]);
  }
}

// Corners of the box around points, three numbers each.
export class Box {
  constructor() {
    this.low = [Infinity, Infinity, Infinity];
    this.high = [-Infinity, -Infinity, -Infinity];
  }
  add(x, y, z) {
    [x, y, z].forEach((v, i) => {
      if (!Number.isFinite(v)) return;
      this.low[i] = Math.min(this.low[i], v);
      this.high[i] = Math.max(this.high[i], v);
    });
  }
  add_points(points) {
    for (let i = 0; i < points.length; i += 3) this.add(points[i], points[i + 1], points[i + 2]);
  }
  get_middle() {
    return this.low.map((v, i) => (this.high[i] >= v ? (v + this.high[i]) / 2 : 0));
  }
  get_diagonal() {
    return Math.hypot(...this.low.map((v, i) => (this.high[i] >= v ? this.high[i] - v : 0))) || 1;
  }
}
