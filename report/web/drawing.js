import { format_number } from "./numbers.js";
import { unpack_column, unpack_floats, unpack_indices, unpack_shorts } from "./unpack.js";

export const kBarNote = " Bars are drawn as lines: a body file has no sections; the studio's view of the deck has them.";

const kMaxSorted = 1e6;  // indices of faces whose edges are looked through for bars

// A body as report/drawing.hpp writes it, and its points when its modes move.
export class Drawing {
  constructor(json) {
    this.xyz = unpack_floats(json.xyz);
    this.triangles = unpack_indices(json.triangles);
    this.edges = unpack_indices(json.edges);
    this.ghosts = unpack_indices(json.ghosts);
    this.ids = json.id ? unpack_indices(json.id) : new Uint32Array();  // node of each point
    this.interface = new Set(json.interface ? unpack_indices(json.interface) : []);
    this.packed = json.shapes;
    this.matrices = null;
    this.shapes = new Array(json.shapes.length);
    this.points = new Float32Array(this.xyz);
    this.size = new Float32Array(this.xyz.length / 3);  // of the displacement of each point
    if (json.elements) {
      const { of_triangle, of_edge, kind, measure, energy } = json.elements;
      this.elements = { of_triangle: unpack_indices(of_triangle), of_edge: unpack_indices(of_edge), kind: unpack_indices(kind), measure: unpack_floats(measure), energy };
      this.matrix = json.elements.matrix;
      const { fields } = json.elements;
      if (fields) Object.assign(this.elements, { id: unpack_indices(json.elements.id), property: unpack_indices(json.elements.property), at_point: unpack_indices(json.elements.at_point) });
      this.lists = fields?.lists.map(unpack_indices) ?? [];
      // Columns of stresses, strains and margins, those of a group one after the other.
      const groups = [...new Set(fields?.list.map((f) => f.group))];
      this.fields = groups.flatMap((group) => fields.list.filter((f) => f.group === group));
    }
  }

  /** Points where hinges, forces and sensors are set: interface nodes, and nodes that no element draws. @returns {Set<number>} */
  find_attachments() {
    if (!this.attachments) {
      const drawn = new Set([...this.triangles, ...this.edges, ...this.ghosts]);
      this.attachments = new Set([...this.ids.keys()].filter((k) => this.interface.has(this.ids[k]) || (this.ids[k] > 0 && !drawn.has(k))));
    }
    return this.attachments;
  }

  /** Returns true if elements are drawn as lines between nodes: the file of a body has no sections. */
  has_bars() {
    return this.ids.length > 0 && this.find_lines().length > 0;
  }

  /** Edges that bound no face, as bars: they have the colour of the body. @returns {Uint32Array} */
  find_lines() {
    if (!this.lines) {
      const count = this.xyz.length / 3, of_faces = new Set(), { triangles, edges } = this, lines = [];
      const to_key = (a, b) => Math.min(a, b) * count + Math.max(a, b);
      const is_large = triangles.length > kMaxSorted;
      for (let i = 0; i < triangles.length && !is_large; i += 3) for (let c = 0; c < 3; ++c) of_faces.add(to_key(triangles[i + c], triangles[i + ((c + 1) % 3)]));
      for (let i = 0; i < edges.length && !is_large; i += 2) if (!of_faces.has(to_key(edges[i], edges[i + 1]))) lines.push(edges[i], edges[i + 1]);
      this.lines = Uint32Array.from(lines);
    }
    return this.lines;
  }

  /**
   * A field in shape j: the number of each element, NaN for those without one, and the elements with the least and the
   * largest. Elements that are not drawn count.
   */
  get_field(field, j) {
    const list = this.lists[field.of], packed = unpack_column(field.values[j], field.count);
    const values = new Float64Array(this.elements.id.length).fill(NaN);
    let least = -1, most = -1;
    list.forEach((element, k) => {
      values[element] = packed[k];
      if (!Number.isFinite(packed[k])) return;
      if (least < 0 || packed[k] < values[least]) least = element;
      if (most < 0 || packed[k] > values[most]) most = element;
    });
    return { values, least, most, low: least < 0 ? 0 : values[least], high: most < 0 ? 0 : values[most] };
  }

  /**
   * Means at the corners of the triangles: over the elements at the point with the kind and property of the triangle's own
   * element. Returns three numbers a triangle, and the mean by "point element" (of what a click names).
   */
  average(values) {
    const { at_point, of_triangle, property, kind } = this.elements, sums = new Map();
    const get_key = (point, element) => `${point} ${property[element]} ${kind[element]}`;
    for (let i = 0; i < at_point.length; i += 2) {
      const value = values[at_point[i + 1]];
      if (!Number.isFinite(value)) continue;
      const key = get_key(at_point[i], at_point[i + 1]), sum = sums.get(key);
      if (sum) [sum[0], sum[1]] = [sum[0] + value, sum[1] + 1];
      else sums.set(key, [value, 1]);
    }
    const find = (point, element) => {
      const sum = Number.isFinite(values[element]) ? sums.get(get_key(point, element)) : undefined;
      return sum ? sum[0] / sum[1] : NaN;
    };
    return { corners: Float64Array.from(this.triangles, (point, i) => find(point, of_triangle[Math.floor(i / 3)])), find };
  }

  // Strain energy of each element for these coefficients of the shapes, and with `is_density` over its extent.
  calc_energies(coefficients, is_density) {
    this.matrices ??= { weight: unpack_floats(this.matrix.weight), largest: unpack_floats(this.matrix.largest), data: unpack_shorts(this.matrix.data) };
    const { weight, largest, data } = this.matrices, { measure } = this.elements, n = weight.length;
    const a = Array.from(weight, (w, i) => w * (coefficients[i] ?? 0));
    const pairs = [];
    for (let i = 0; i < n; ++i) for (let j = i; j < n; ++j) pairs.push((i === j ? 0.5 : 1) * a[i] * a[j]);
    return Float32Array.from(largest, (scale, k) => {
      let sum = 0;
      for (let c = 0, at = k * pairs.length; c < pairs.length; ++c) sum += data[at + c] * pairs[c];
      const energy = Math.max(0, (sum * scale) / 32767);
      return !is_density ? energy : measure[k] > 0 ? energy / measure[k] : 0;
    });
  }

  // Strain energy of each element in shape j over the largest, 0 to 1; by density lines, surfaces and solids each over
  // the largest of their own.
  get_levels(j, is_density) {
    const { kind, measure, energy } = this.elements, { data, largest } = energy[j];
    const share = Float32Array.from(unpack_shorts(data), (v) => (v * largest) / 32767);
    if (!is_density) return { levels: share.map((v) => (largest > 0 ? v / largest : 0)), largest };
    const density = share.map((v, k) => (measure[k] > 0 ? v / measure[k] : 0)), most = [0, 0, 0];
    density.forEach((v, k) => (most[kind[k]] = Math.max(most[kind[k]], v)));
    return { levels: density.map((v, k) => (most[kind[k]] > 0 ? v / most[kind[k]] : 0)), largest };
  }

  get_shape(j) {
    if (!this.shapes[j]) {
      const { data, largest } = this.packed[j];
      const shorts = unpack_shorts(data);
      this.shapes[j] = Float32Array.from(shorts, (v) => (v * largest) / 32767);
    }
    return this.shapes[j];
  }

  // "node 41: (8, 0, 0), displacement 0.57": `value` is what the colours show.
  describe(k, before, value) {
    const place = Array.from(this.xyz.slice(3 * k, 3 * k + 3), (v) => format_number(v, 5)).join(", ");
    return `${before}node ${this.ids[k]}: (${place}), ${value}`;
  }

  // The largest displacement of a point in shape j with coefficient 1.
  get_reach(j) {
    const shape = this.get_shape(j);
    let most = 0;
    for (let i = 0; i < shape.length; i += 3) most = Math.max(most, Math.hypot(shape[i], shape[i + 1], shape[i + 2]));
    return most;
  }

  // The largest displacement of a point over a cycle, of shapes j (real part) and j + 1 (imaginary part).
  get_complex_reach(j) {
    const re = this.get_shape(j), im = this.get_shape(j + 1);
    let most = 0;
    for (let i = 0; i < re.length; i += 3) {
      const a = re[i] ** 2 + re[i + 1] ** 2 + re[i + 2] ** 2, b = im[i] ** 2 + im[i + 1] ** 2 + im[i + 2] ** 2;
      const c = re[i] * im[i] + re[i + 1] * im[i + 1] + re[i + 2] * im[i + 2];
      most = Math.max(most, Math.sqrt((a + b + Math.hypot(a - b, 2 * c)) / 2));
    }
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

/** Indices of the points that are farthest in each of 26 directions. @param {ArrayLike<number>} xyz */
export function find_extremes(xyz) {
  const found = new Set();
  for (let code = 0; code < 27; ++code) {
    const [a, b, c] = [(code % 3) - 1, (Math.floor(code / 3) % 3) - 1, Math.floor(code / 9) - 1];
    let best = -1, most = -Infinity;
    for (let k = 0; 3 * k < xyz.length; ++k) {
      const reach = a * xyz[3 * k] + b * xyz[3 * k + 1] + c * xyz[3 * k + 2];
      if (reach > most) [best, most] = [k, reach];
    }
    if (best >= 0) found.add(best);
  }
  return [...found];
}

// Corners of the box around points, three numbers each.
export class Box {
  constructor() {
    this.hull = [];  // points that are to be seen, three numbers each; empty: the corners
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
    this.hull = points;
    for (let i = 0; i < points.length; i += 3) this.add(points[i], points[i + 1], points[i + 2]);
  }
  get_middle() {
    return this.low.map((v, i) => (this.high[i] >= v ? (v + this.high[i]) / 2 : 0));
  }
  get_diagonal() {
    return Math.hypot(...this.low.map((v, i) => (this.high[i] >= v ? this.high[i] - v : 0))) || 1;
  }
}
