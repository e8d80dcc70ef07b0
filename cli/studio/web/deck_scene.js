// A deck as things for the viewer.
import { Box, Drawing } from "./drawing.js";
import { LineSections } from "./line_sections.js";
import { format_number } from "./numbers.js";
import { get_css, get_style } from "./page_parts.js";
import { add_arrow, to_thing } from "./scene_marks.js";
import { unpack_indices } from "./unpack.js";
import { make_triad } from "./viewer.js";

/** More symbols of a kind are thinned: each is drawn in every frame. */
const kMaxSymbols = 2000;

export class DeckScene {
  constructor(answer) {
    this.drawing = new Drawing(answer.drawing);
    const e = answer.elements;
    /** @type {any} */
    this.elements = { cards: e.cards, ...Object.fromEntries(["id", "card", "property", "file", "line", "of_triangle", "of_edge"].map((k) => [k, unpack_indices(e[k])])) };
    this.grids = Object.fromEntries(["id", "file", "line", "part"].map((k) => [k, unpack_indices(answer.grids[k])]));
    this.answer = answer;
    this.row_of_grid = new Map(Array.from(this.grids.id, (id, k) => [id, k]));
    this.point_of_grid = new Map(Array.from(this.drawing.ids, (id, k) => [id, k]));
    this.box = new Box();
    this.box.add_points(this.drawing.xyz);
    for (const m of answer.masses) this.box.add(...m.place);
    this.size = this.box.get_diagonal();
    this.sections = new LineSections(answer.line_sections, this.list_line_rows());
    this.hidden = new Set();
    this.show = { sections: true, pins: true, masses: true, spiders: true, supports: true, loads: true, systems: false, edges: true };
    this.thinned = [];
    this.set_coloring("property");
  }

  /** Rows of the elements that are drawn as lines, by id. */
  list_line_rows() {
    const { id, of_edge } = this.elements;
    return new Map(Array.from(of_edge).filter((row) => row !== 0xffffffff).map((row) => [id[row], row]));
  }

  get_place(grid) {
    const k = this.point_of_grid.get(grid);
    return k === undefined ? null : Array.from(this.drawing.xyz.slice(3 * k, 3 * k + 3));
  }

  name_group(element) {
    const { card, cards, property } = this.elements;
    return property[element] > 0 ? `${cards[card[element]]} of property ${property[element]}` : cards[card[element]];
  }

  /** The group of an element, null for none. */
  find_group(row) {
    return this.groups.find((g) => g.faces_of.includes(row) || g.lines_of.includes(row)) ?? null;
  }

  /** "CBAR 12, property 3, PBARL 3: I 0.3 0.2 …" */
  describe_element(row) {
    const { id, property, card, cards } = this.elements, section = this.sections.describe(row);
    return `${cards[card[row]]} ${id[row]}${property[row] > 0 ? `, property ${property[row]}` : ""}${section ? `, ${section}` : ""}`;
  }

  /** Groups of elements: by property, card or connected part. */
  set_coloring(by) {
    this.coloring = by;
    const { drawing } = this, { card, property, of_triangle, of_edge, cards } = this.elements;
    const groups = new Map();
    const find = (element, point) => {
      const part = this.grids.part[this.row_of_grid.get(drawing.ids[point])] ?? 0;
      const name = by === "part" ? `part ${part}` : by === "card" ? cards[card[element]] : this.name_group(element);
      const order = by === "part" ? part : by === "card" ? card[element] : property[element];
      if (!groups.has(name)) groups.set(name, { name, order, property: by === "property" ? property[element] : 0, triangles: [], edges: [], lines: [], faces_of: [], lines_of: [] });
      return groups.get(name);
    };
    // Outlines belong to the group of a triangle at their first point.
    const group_of_point = new Map();
    of_triangle.forEach((element, t) => {
      const corners = drawing.triangles.subarray(3 * t, 3 * t + 3), group = find(element, corners[0]);
      group.triangles.push(...corners);
      group.faces_of.push(element);
      for (const c of corners) group_of_point.set(c, group);
    });
    of_edge.forEach((element, k) => {
      const [a, b] = drawing.edges.subarray(2 * k, 2 * k + 2);
      if (element !== 0xffffffff) {
        const group = find(element, a);
        group.lines.push(a, b);
        group.lines_of.push(element);
      } else (group_of_point.get(a) ?? group_of_point.get(b))?.edges.push(a, b);
    });
    this.groups = [...groups.values()].sort((a, b) => a.order - b.order || a.name.localeCompare(b.name));
    // Groups of one property (its CQUAD4 and its CTRIA3) have one colour.
    const styles = new Map();
    this.groups.forEach((g) => {
      for (const key of ["triangles", "edges", "lines"]) g[key] = Uint32Array.from(g[key]);
      if (!styles.has(g.property || g.name)) styles.set(g.property || g.name, styles.size);
      g.style = styles.get(g.property || g.name);
      g.solids = this.sections.make_solids(new Set(g.lines_of));
    });
  }

  /** One mesh of a shape at each place. */
  make_symbols(places, shape, color) {
    const points = [], triangles = [];
    for (const [x, y, z, scale] of this.thin(places)) {
      const first = points.length / 3;
      for (let i = 0; i < shape.points.length; i += 3) points.push(x + scale * shape.points[i], y + scale * shape.points[i + 1], z + scale * shape.points[i + 2]);
      for (const t of shape.triangles) triangles.push(first + t);
    }
    return { ...to_thing({ points, triangles }, color) };
  }

  thin(list) {
    const every = Math.ceil(list.length / kMaxSymbols);
    return every > 1 ? list.filter((_, k) => k % every === 0) : list;
  }

  list_places(items, scale) {
    return items.map((item) => [this.get_place(item.grid), item]).filter(([p]) => p).map(([p, item]) => [...p, scale(item)]);
  }

  make_things() {
    const { drawing, answer, show, size } = this, points = drawing.xyz, things = [];
    const pick = { ids: drawing.ids, describe: (k) => `grid ${drawing.ids[k]}: ${this.describe_place(k)}` };
    const marks = [];
    things.push(...make_triad([0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], 0.1 * size));
    let has_pick = false;
    const describe_element = (row) => this.describe_element(row);
    for (const g of this.groups) {
      if (this.hidden.has(g.name)) continue;
      const { color } = get_style(g.style);
      if (g.triangles.length > 0) things.push({ points, triangles: g.triangles, edges: show.edges ? g.edges : undefined, color, elements: { of_triangle: g.faces_of, of_edge: [] }, describe_element, ...(has_pick ? {} : pick) });
      has_pick = true;
      if (g.lines.length > 0) things.push({ points, edges: g.lines, color, lift: 3e-4, elements: { of_triangle: [], of_edge: g.lines_of }, describe_element });
      if (show.sections && g.solids.triangles.length > 0) things.push({ ...g.solids, edges: show.edges ? g.solids.edges : undefined, color, describe_element, is_detail: true });
    }
    // Grids can be picked even if all elements are hidden or none is there.
    things.push({ points, edges: new Uint32Array(0), color: get_css("--body"), dots: this.groups.length === 0, ...pick });
    const heaviest = Math.max(...answer.masses.map((m) => m.mass), 0);
    const ball = make_ball();
    if (show.masses && answer.masses.length > 0)
      things.push(this.make_symbols(answer.masses.map((m) => [...m.place, size * (0.006 + 0.012 * Math.cbrt(heaviest > 0 ? Math.max(0, m.mass) / heaviest : 0))]), ball, get_css("--sensor")));
    if (show.spiders) {
      const lines = [];
      for (const s of answer.spiders) {
        const a = this.point_of_grid.get(s.centre);
        for (const g of s.grids) {
          const b = this.point_of_grid.get(g);
          if (a !== undefined && b !== undefined) lines.push(a, b);
        }
      }
      if (lines.length > 0) things.push({ points, edges: Uint32Array.from(lines), color: get_css("--reaction"), lift: 4e-4 });
    }
    if (show.supports && answer.supports.length > 0) {
      const seen = new Map(answer.supports.map((s) => [s.grid, s]));
      things.push(this.make_symbols(this.list_places([...seen.values()], () => 0.009 * size), kCone, get_css("--hinge")));
    }
    if (show.loads && answer.loads.length > 0) {
      for (const is_moment of [false, true]) {
        const loads = answer.loads.filter((l) => l.moment === is_moment), mesh = { points: [], triangles: [] };
        const largest = Math.max(...loads.map((l) => Math.hypot(...l.vector)), 0);
        for (const l of this.thin(loads)) {
          const p = this.get_place(l.grid);
          if (p && largest > 0) add_arrow(mesh, p, l.vector.map((v) => (0.15 * size * v) / largest), is_moment ? 2 : 1, size);
        }
        if (mesh.points.length > 0) marks.push(to_thing(mesh, get_css("--applied")));
      }
    }
    if (show.pins && this.sections.pins.length > 0)
      marks.push(this.make_symbols(this.sections.pins.map((p) => [...p.place, 0.006 * size]), ball, get_css("--hinge")));
    if (show.systems) for (const s of answer.systems.slice(0, 200)) things.push(...make_triad(s.origin, s.axes, 0.05 * size));
    this.thinned = Object.entries({ masses: answer.masses, supports: answer.supports, loads: answer.loads, "pin flags": this.sections.pins }).filter(([, list]) => list.length > kMaxSymbols).map(([name, list]) => `${name}: one of ${Math.ceil(list.length / kMaxSymbols)} is drawn`);
    if (this.sections.every > 1) this.thinned.push(`sections: one of ${this.sections.every} elements has its section`);
    if (this.sections.without > 0) this.thinned.push(`${this.sections.without} bars, beams and rods have no section to draw`);
    return { things, marks };
  }

  /** Grids in another colour, over all else. */
  make_marks(grids, color) {
    return this.make_symbols(this.list_places([...grids].map((grid) => ({ grid })), () => 0.008 * this.size), make_ball(), color);
  }

  describe_place(k) {
    return `(${Array.from(this.drawing.xyz.slice(3 * k, 3 * k + 3), (v) => format_number(v, 6)).join(", ")})`;
  }
}

// An octahedron whose sides are split once, of radius 1.
function make_ball() {
  const corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
  const faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
  const points = [], triangles = [];
  const add = (v) => {
    const r = Math.hypot(...v);
    points.push(...v.map((x) => x / r));
    return points.length / 3 - 1;
  };
  for (const [a, b, c] of faces) {
    const [p, q, r] = [corners[a], corners[b], corners[c]], middle = (u, v) => u.map((x, i) => x + v[i]);
    const [i, j, k, ij, jk, ki] = [p, q, r, middle(p, q), middle(q, r), middle(r, p)].map(add);
    triangles.push(i, ij, ki, j, jk, ij, k, ki, jk, ij, jk, ki);
  }
  return { points, triangles };
}

// A pyramid below the grid.
const kCone = { points: [0, 0, 0, 1, 1, -1.6, -1, 1, -1.6, -1, -1, -1.6, 1, -1, -1.6], triangles: [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 1, 3, 2, 1, 4, 3] };
