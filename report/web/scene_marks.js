import { format_number } from "./numbers.js";
import { el, get_css, make_check, make_slider } from "./page_parts.js";
import { cross } from "./viewer.js";

// Rows of the rotation of a quaternion w x y z, of any length.
export function to_rotation([w, x, y, z]) {
  const s = 2 / (w * w + x * x + y * y + z * z || 1);
  return [
    [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
    [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
    [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
  ];
}
export const turn = (R, v) => R.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const kGround = { p: [0, 0, 0], R: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };
const kSides = 10;
const kNoise = 1e-15;  // forces and moments below it are rounding errors in any units
const kLongest = 0.22;  // of the scene: the longest arrow of a kind at scale 1

// A body of revolution about the way from p along the unit vector u: [distance, radius] by rings.
function add_rings(mesh, p, u, rings) {
  const other = Math.abs(u[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0];
  const a = cross(u, other), size = Math.hypot(...a), e = a.map((v) => v / size), f = cross(u, e);
  const first = mesh.points.length / 3;
  for (const [along, radius] of rings)
    for (let k = 0; k < kSides; ++k) {
      const c = radius * Math.cos((2 * Math.PI * k) / kSides), s = radius * Math.sin((2 * Math.PI * k) / kSides);
      for (let i = 0; i < 3; ++i) mesh.points.push(p[i] + along * u[i] + c * e[i] + s * f[i]);
    }
  for (let r = 0; r + 1 < rings.length; ++r)
    for (let k = 0; k < kSides; ++k) {
      const i = first + r * kSides + k, j = first + r * kSides + ((k + 1) % kSides);
      mesh.triangles.push(i, j, i + kSides, j, j + kSides, i + kSides);
    }
}

// One head of a force, two of a moment.
export function add_arrow(mesh, from, vector, heads, size) {
  const length = Math.hypot(...vector);
  if (!(length > 1e-6 * size)) return;
  const head = Math.min(0.035 * size, (0.6 * length) / heads), wide = 0.38 * head, thin = Math.min(0.0035 * size, 0.4 * wide);
  const rings = [[0, 0], [0, thin]];
  for (let k = heads; k > 0; --k) rings.push([length - k * head, thin], [length - k * head, wide], [length - (k - 1) * head, k > 1 ? thin : 0]);
  add_rings(mesh, from, vector.map((v) => v / length), rings);
}

export const to_thing = (mesh, color) => ({ points: new Float32Array(mesh.points), triangles: new Uint32Array(mesh.triangles), edges: new Uint32Array(0), color, is_symbol: true });
const make_lines = (points, color) => ({ points: new Float32Array(points.flat()), edges: Uint32Array.from(points, (_, i) => i), color });

// Sensors, and arrows of forces and moments, that go with the bodies.
export class SceneMarks {
  constructor(view) {
    this.view = view;
    const run = view.run;
    this.sensors = run.data.sensors;
    this.sources = run.data.arrows.map((arrow, k) => ({ ...arrow, source: arrow.channel ? run.by_path.get(arrow.channel) : { path: "scene:" + k, stride: arrow.stride, columns: [arrow.values] } }));
    this.is_on = { sensors: true, applied: true, reactions: true };
    this.scale = 1;
    this.arrows = [];
    this.largest = [this.find_largest(false), this.find_largest(true)];
    this.meaning = el("span");
    this.now = el("p", { class: "note" });
    this.legend = el("p", { class: "note legend" });
    const mark = (color, text) => el("span", { class: "entry" }, el("span", { class: "swatch " + color }), " " + text);
    if (this.sensors.length > 0) this.legend.append(mark("sensor", "sensors: " + this.sensors.map((s) => s.name).join(", ")));
    for (const [is_reaction, color, text] of [[false, "applied", "applied"], [true, "reaction", "reactions, of the parent on the child"]])
      if (this.sources.some((a) => a.reaction === is_reaction)) this.legend.append(mark(color, text));
    this.legend.append(this.meaning);
  }

  make_tools() {
    const tools = [];
    const toggle = (name, has_any) => has_any && tools.push(make_check(name, true, (on) => { this.is_on[name] = on; this.view.draw(); }));
    toggle("sensors", this.sensors.length > 0);
    toggle("applied", this.sources.some((a) => !a.reaction));
    toggle("reactions", this.sources.some((a) => a.reaction));
    if (this.sources.length > 0) tools.push(make_slider("arrows ×", { min: -2, max: 3, step: 0.05, value: 0 }, (v) => { this.scale = 10 ** v; this.view.draw(); return format_number(10 ** v, 3); }));
    return tools;
  }

  // Of all samples: { value, name, time }.
  find_largest(is_moment) {
    const most = { value: 0, name: "", time: 0 };
    for (const { name, largest } of this.sources.filter((a) => a.moment === is_moment))
      if (largest.value > most.value) Object.assign(most, { ...largest, name });
    return most.value > kNoise ? most : { value: 0, name: "", time: 0 };
  }

  // In the world, with the deformation that is drawn; null where the body is not.
  locate(place, places) {
    const at = place.body >= 0 ? places[place.body] : kGround;
    if (!at) return null;
    let p = place.p;
    if (place.point >= 0) {
      const d = this.view.bodies[place.body].drawing, k = 3 * place.point;
      p = p.map((v, i) => v + d.points[k + i] - d.xyz[k + i]);
    }
    return turn(at.R, p).map((v, i) => v + at.p[i]);
  }

  // Where each arrow is and what it stands for, at this time.
  find_arrows(places, time) {
    const arrows = [];
    for (const arrow of this.sources) {
      const at = this.locate(arrow.at, places), axes = arrow.frame >= 0 ? places[arrow.frame] : kGround;
      if (!at || !axes) continue;
      const values = this.view.sample(arrow.source, time);
      let vector;
      if (arrow.towards) {
        const to = this.locate(arrow.towards, places);
        if (!to) continue;
        const way = to.map((v, i) => v - at[i]), length = Math.hypot(...way) || 1;
        vector = way.map((v) => (v * arrow.factor * values[arrow.column]) / length);
      } else {
        const v = arrow.column < 0 ? values : [values[arrow.column], 0, 0];
        vector = turn(axes.R, turn(arrow.axes, v)).map((x) => x * arrow.factor);
      }
      if (vector.every(Number.isFinite)) arrows.push({ name: arrow.name, moment: arrow.moment, reaction: arrow.reaction, at, vector });
    }
    return arrows;
  }

  // Takes in what is fixed in ground, and returns it; what is far off, as a planet, is left outside.
  extend(box) {
    const middle = box.get_middle(), near = 1.5 * box.get_diagonal(), taken = [];
    for (const place of [...this.sources.flatMap((a) => [a.at, a.towards]), ...this.sensors.map((s) => s.to)])
      if (place && place.body < 0 && Math.hypot(...place.p.map((v, i) => v - middle[i])) < near) taken.push(...place.p);
    for (let k = 0; k < taken.length; k += 3) box.add(taken[k], taken[k + 1], taken[k + 2]);
    return taken;
  }

  get_per_unit(size) {
    return this.largest.map((most) => (most.value > 0 ? (kLongest * size * this.scale) / most.value : 0));
  }

  // Heads of the arrows, three numbers each.
  list_tips(places, time, size) {
    const per_unit = this.get_per_unit(size);
    return this.find_arrows(places, time).flatMap(({ moment, at, vector }) => at.map((v, i) => v + per_unit[moment ? 1 : 0] * vector[i]));
  }

  make_things(places, time, size) {
    const things = [];
    this.add_hinges(things, places, size);
    if (this.is_on.sensors) this.add_sensors(things, places, size);
    this.arrows = this.find_arrows(places, time).filter((a) => this.is_on[a.reaction ? "reactions" : "applied"]);
    const meshes = { "--applied": { points: [], triangles: [] }, "--reaction": { points: [], triangles: [] } };
    const per_unit = this.get_per_unit(size);
    for (const { moment, reaction, at, vector } of this.arrows)
      add_arrow(meshes[reaction ? "--reaction" : "--applied"], at, vector.map((v) => v * per_unit[moment ? 1 : 0]), moment ? 2 : 1, size);
    for (const [color, mesh] of Object.entries(meshes)) if (mesh.points.length > 0) things.push(to_thing(mesh, get_css(color)));
    this.tell(per_unit);
    return things;
  }

  // What a length means, and what acts now.
  tell(per_unit) {
    const words = [], { channels } = this.view.run.data;
    const find_unit = (ending, otherwise) => `[${channels.find((c) => c.path.endsWith(ending) && c.unit)?.unit ?? otherwise}]`;
    const length = find_unit("/position", "L"), units = [find_unit("/reaction_force", "F"), find_unit("/reaction_moment", "F L")];
    this.largest.forEach((most, k) => {
      if (most.value === 0) return;
      const [kind, dims] = [["Force (one head)", "Moment (two heads)"][k], units[k]];
      words.push(`${kind}: an arrow of length 1 ${length} is ${format_number(1 / per_unit[k], 3)} ${dims}, the largest ${format_number(most.value, 4)} (${most.name}, t = ${format_number(most.time, 4)})`);
    });
    this.meaning.textContent = words.length > 0 ? words.join(". ") + "." : "";
    // What rounding leaves is none.
    const measure = (a) => { const v = Math.hypot(...a.vector); return v < 1e-12 * this.largest[a.moment ? 1 : 0].value ? 0 : v; };
    const shown = this.arrows.slice(0, 12).map((a) => `${a.name} ${format_number(measure(a), 4)} ${units[a.moment ? 1 : 0]}`);
    if (this.arrows.length > 12) shown.push(`${this.arrows.length - 12} more`);
    this.now.textContent = shown.length > 0 ? "Now: " + shown.join(", ") : "";
  }

  add_hinges(things, places, size) {
    for (const hinge of this.view.run.data.hinges) {
      const at = this.locate(hinge.at, places);
      if (at) things.push({ ...make_lines(this.make_axis(at, hinge.at, hinge.axis, places, 0.03 * size), get_css("--hinge")), dots: true });
    }
  }

  // The place, or both ends of an axis through it.
  make_axis(at, place, axis, places, half) {
    if (!(Math.hypot(...axis) > 0)) return [at];
    const u = turn((place.body >= 0 ? places[place.body] : kGround).R, axis);
    return [-half, half].map((s) => at.map((v, i) => v + s * u[i]));
  }

  // An octahedron at each sensor; axes of instruments, x the longest; the axis of a hinge, the line of a distance.
  add_sensors(things, places, size) {
    const mesh = { points: [], triangles: [] }, lines = [], r = 0.011 * size;
    for (const sensor of this.sensors) {
      const at = this.locate(sensor.at, places);
      if (!at) continue;
      const first = mesh.points.length / 3;
      for (let i = 0; i < 3; ++i) for (const s of [-r, r]) mesh.points.push(...at.map((v, k) => v + (k === i ? s : 0)));
      for (let x = 0; x < 2; ++x) for (let y = 2; y < 4; ++y) for (let z = 4; z < 6; ++z) mesh.triangles.push(first + x, first + y, first + z);
      sensor.axes.forEach((axis, i) => lines.push(at, this.make_axis(at, sensor.at, axis, places, [0.05, 0.04, 0.03][i] * size)[1]));
      if (Math.hypot(...sensor.axis) > 0) lines.push(...this.make_axis(at, sensor.at, sensor.axis, places, 0.05 * size));
      const to = sensor.to && this.locate(sensor.to, places);
      if (to) lines.push(at, to);
    }
    if (mesh.points.length > 0) things.push(to_thing(mesh, get_css("--sensor")));
    if (lines.length > 0) things.push(make_lines(lines, get_css("--sensor")));
  }
}
