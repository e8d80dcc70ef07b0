// Ends of hinges in the scene of a system, dragged along an axis, in the plane of the screen or to a node, and their
// numbers by keys. A free hinge moves its body. The text gets what a command of `bough edit` writes.
import { ask } from "./api.js";
import { dot, to_toml, transpose } from "./hinge_axes.js";
import { el, get_css, make_select } from "./page_parts.js";
import { find_distance_to_segment } from "./picking.js";
import { add_arrow, to_thing, turn } from "./scene_marks.js";

const kGrab = 12, kNear = 14;  // pixels around a handle, and from a node to which an end goes
const kShare = 0.13;  // length of a handle over the size of the scene
const kFine = 0.1;  // of the way of the pointer, with shift
const kGround = { p: [0, 0, 0], R: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };
const kEnds = ["parent", "child"];
const kColors = ["#d55e00", "#009e73", "#0072b2"];  // x, y, z as in all triads

const add = (a, b, factor = 1) => a.map((v, i) => v + factor * b[i]);

/** @typedef {{name: string, path: string, free: boolean, parent: string, child: string, parent_node: number, child_node: number, parent_position: number[], child_position: number[], axes: number[][], position: number[]}} Hinge */

export class HingePlaces {
  /** @param {any} view  the SystemView */
  constructor(view) {
    this.view = view;
    this.name = "";
    this.end = "parent";
    /** @type {Hinge[]} */
    this.hinges = [];
    this.rigid = {};
    /** While an end is dragged. @type {{way: number[], node: number | null, axis: number} | null} */
    this.dragged = null;
    this.names = [];
    this.picker = make_select("move", ["no hinge"], (k) => this.choose(k > 0 ? this.names[k - 1] : ""));
    this.picker.list.classList.add("place-picker");
    this.ends = make_select("end", kEnds, (k) => {
      this.end = kEnds[k];
      this.show_numbers();
      this.motion?.draw();
    });
    this.fields = ["x", "y", "z"].map((name) => {
      const field = el("input", { type: "number", step: "any", "aria-label": `place ${name}` });
      field.addEventListener("change", () => this.write(this.fields.map((f) => Number(f.value)), null));
      return field;
    });
    this.node = el("input", { type: "number", min: 0, step: 1, "aria-label": "place node" });
    this.node.addEventListener("change", () => this.write([0, 0, 0], Number(this.node.value)));
    this.node_label = el("label", {}, "node ", this.node, " and from it ");
    this.numbers = el("span", { class: "axis-numbers", hidden: true }, this.ends, this.node_label, ...this.fields);
    this.status = el("output", { class: "note", "aria-live": "polite" });
    this.element = el("div", { class: "tools hinge-places", hidden: true }, this.picker, this.numbers, this.status);
  }

  get motion() {
    return this.view.motion;
  }
  get hinge() {
    return this.hinges.find((h) => h.name === this.name);
  }
  /** A free hinge has no end on a body of the parent: its coordinates are dragged. */
  get is_free() {
    return this.end === "parent" && Boolean(this.hinge?.free);
  }

  /** Hinges and nodes of a text without errors. */
  update({ hinges, nodes }) {
    this.hinges = hinges;
    this.rigid = nodes;
    const names = hinges.map((h) => h.name);
    if (names.join("\n") !== this.names.join("\n")) {
      this.names = names;
      this.picker.list.replaceChildren(...["no hinge", ...hinges.map((h) => `${h.child} at ${h.name}`)].map((text, i) => el("option", { value: i }, text)));
    }
    if (!this.hinge) this.name = "";
    this.picker.list.selectedIndex = names.indexOf(this.name) + 1;
    this.element.hidden = names.length === 0;
    // The text of the scene again, by Undo: bodies that were dragged go back.
    if (this.view.text_drawn === this.view.pane.text) return this.cancel();
    this.show_numbers();
  }

  attach(motion) {
    this.dragged = null;
    if (this.name) motion.draw();
  }

  choose(name) {
    this.name = name;
    this.show_numbers();
    this.motion?.draw();
  }

  /** Index of a body and its place now. */
  find_body(name) {
    const index = this.motion.bodies.findIndex((b) => b.name === name && b.is_drawn);
    return { index, place: name === "ground" ? kGround : index >= 0 ? this.motion.get_places()[index] : null };
  }

  /** Nodes of a body in its frame, of a flexible one as it is drawn. @returns {Map<number, number[]>} */
  list_nodes(name) {
    const nodes = new Map([[0, [0, 0, 0]]]), drawing = this.motion.bodies.find((b) => b.name === name)?.drawing;
    drawing?.ids.forEach((id, k) => nodes.set(id, Array.from(drawing.points.subarray(3 * k, 3 * k + 3))));
    for (const { id, position } of this.rigid[name] ?? []) nodes.set(id, position);
    return nodes;
  }

  /**
   * Place of the end in the world, the axes of its numbers there as rows, its numbers, its body and node. Null: the body is
   * not drawn.
   */
  locate() {
    const { hinge, end } = this;
    if (!hinge || !this.motion) return null;
    const on = (side) => {
      const { place } = this.find_body(hinge[side]), node = this.list_nodes(hinge[side]).get(hinge[side + "_node"]);
      return place && node ? { place, at: add(turn(place.R, add(node, hinge[side + "_position"])), place.p) } : null;
    };
    const found = on(end), child = this.is_free ? on("child") : null;
    if (!found || (this.is_free && !child)) return null;
    const columns = transpose(found.place.R);
    if (this.is_free) return { at: child.at, axes: hinge.axes.map((axis) => turn(found.place.R, axis)), value: hinge.position.length > 6 ? hinge.position.slice(4, 7) : [0, 0, 0] };
    return { at: found.at, axes: columns, value: hinge[end + "_position"], place: found.place, body: hinge[end], node: hinge[end + "_node"] };
  }

  get_length(size = this.motion.viewer.extent) {
    return kShare * size;
  }

  make_things(_places, size) {
    const now = this.name && this.locate();
    if (!now) return [];
    const at = this.dragged && !this.is_moving_child() ? add(now.at, this.dragged.way) : now.at, ball = { points: [], triangles: [] };
    for (let i = 0; i < 3; ++i) for (const s of [-1, 1]) ball.points.push(...at.map((v, k) => v + (k === i ? 0.016 * s * size : 0)));
    for (let x = 0; x < 2; ++x) for (let y = 2; y < 4; ++y) for (let z = 4; z < 6; ++z) ball.triangles.push(x, y, z);
    const arrows = now.axes.map((axis, i) => {
      const mesh = { points: [], triangles: [] };
      add_arrow(mesh, at, axis.map((v) => v * this.get_length(size)), 1, 1.2 * size);
      return to_thing(mesh, kColors[i]);
    });
    return [...arrows, to_thing(ball, get_css(this.dragged?.node != null ? "--good" : "--link"))];
  }

  /** True if the dragged end takes its bodies along, which are drawn there already. */
  is_moving_child() {
    return Boolean(this.dragged) && this.end === "parent" && this.is_free;
  }

  /** Handle at a place of the screen: 0 to 2 an axis, 3 the middle, -1 none. */
  find_handle(event) {
    const now = this.name && this.locate();
    if (!now) return -1;
    const { viewer } = this.motion, box = viewer.canvas.getBoundingClientRect();
    /** @type {[number, number]} */
    const click = [event.clientX - box.left, event.clientY - box.top];
    const middle = viewer.find_place(now.at);
    if (!middle) return -1;
    if (Math.hypot(middle[0] - click[0], middle[1] - click[1]) < kGrab) return 3;
    const far = now.axes.map((axis) => {
      const tip = viewer.find_place(add(now.at, axis, this.get_length()));
      // An axis that points at the eye has no direction on the screen.
      return tip && Math.hypot(tip[0] - middle[0], tip[1] - middle[1]) > kGrab ? find_distance_to_segment(click, middle, tip) : Infinity;
    });
    const least = Math.min(...far);
    return least < kGrab / 2 ? far.indexOf(least) : -1;
  }
  can_grab(event) {
    return this.find_handle(event) >= 0;
  }

  grab(event) {
    const axis = this.find_handle(event), start = this.locate(), { viewer } = this.motion;
    const nodes = axis === 3 && start.place ? [...this.list_nodes(start.body)].map(([id, p]) => ({ id, at: add(turn(start.place.R, p), start.place.p) })) : [];
    let way = [0, 0, 0], before = this.find_way(event, start, axis, way);
    this.dragged = { way, node: null, axis };
    const stop = (key) => key.key === "Escape" && this.cancel();
    addEventListener("keydown", stop);
    return {
      move: (to) => {
        const next = this.find_way(to, start, axis, way);
        if (!this.dragged || !next || !before) return;
        way = add(way, add(next, before, -1), to.shiftKey ? kFine : 1);
        before = next;
        this.is_fine = to.shiftKey;
        const near = to.altKey ? null : this.find_near(to, nodes);
        this.dragged = { way: near ? add(near.at, start.at, -1) : way, node: near ? near.id : null, axis };
        this.shift_bodies();
        this.show_numbers(this.calc_value(start), near?.id);
        this.motion.draw();
      },
      end: () => {
        removeEventListener("keydown", stop);
        const { dragged } = this;
        if (!dragged || !(Math.hypot(...dragged.way) > 0)) return this.cancel();
        if (dragged.node !== null) this.write([0, 0, 0], dragged.node);
        else this.write(this.calc_value(start), null);
      },
    };
  }

  /** Where the pointer is: along an axis, or in the plane of the screen through the end; null at the horizon. */
  find_way(event, { at, axes }, axis, way) {
    const { eye, direction } = this.motion.viewer.make_ray(event);
    if (axis === 3) {
      const { back } = this.motion.viewer.get_axes(), slope = dot(direction, back);
      if (Math.abs(slope) < 1e-6) return null;
      return add(eye, direction, dot(add(add(at, way), eye, -1), back) / slope);
    }
    const u = axes[axis], w = add(at, eye, -1), b = dot(u, direction), space = 1 - b * b;
    return space < 1e-4 ? null : u.map((v) => (v * (b * dot(direction, w) - dot(u, w))) / space);
  }

  /** The node near the pointer. */
  find_near(event, nodes) {
    const { viewer } = this.motion, box = viewer.canvas.getBoundingClientRect();
    let best = kNear, found = null;
    for (const node of nodes) {
      const place = viewer.find_place(node.at), distance = place ? Math.hypot(place[0] - (event.clientX - box.left), place[1] - (event.clientY - box.top)) : Infinity;
      if (distance < best) [best, found] = [distance, node];
    }
    return found;
  }

  /** Numbers of the dragged end, rounded to less than a pixel; along an axis one of them changes. */
  calc_value({ at, axes, value }) {
    const { viewer } = this.motion, { back } = viewer.get_axes(), { way, axis } = this.dragged;
    const eye = add(viewer.target, back, viewer.distance), depth = Math.max(dot(add(eye, at, -1), back), 1e-9 * viewer.extent);
    const pixel = (2 * depth) / (viewer.get_lens()[1] * Math.max(1, viewer.canvas.clientHeight));
    const digits = Math.min(12, Math.max(0, Math.ceil(-Math.log10(pixel)) + (this.is_fine ? 1 : 0)));
    return value.map((v, i) => (axis !== 3 && axis !== i ? v : Number((v + dot(axes[i], way)).toFixed(digits)) || 0));
  }

  /** Bodies behind the hinge go with its end on the parent. */
  shift_bodies() {
    const shifts = new Map();
    if (this.dragged && this.end === "parent") {
      const names = [this.hinge.child];
      for (const name of names) {
        shifts.set(this.find_body(name).index, this.dragged.way);
        names.push(...this.hinges.filter((h) => h.parent === name).map((h) => h.child));
      }
    }
    this.motion.shifts = shifts;
  }

  show_numbers(value = null, node = undefined) {
    const { hinge } = this;
    this.numbers.hidden = !hinge;
    if (!hinge) {
      this.status.textContent = "";
      return;
    }
    this.ends.list.selectedIndex = kEnds.indexOf(this.end);
    const now = this.locate(), own = value ?? now?.value ?? [0, 0, 0];
    const step = 10 ** Math.floor(Math.log10((this.motion?.viewer.extent || 1) / 50));
    this.fields.forEach((field, i) => {
      field.value = String(node == null ? own[i] : 0);
      field.step = String(step);
    });
    this.node_label.hidden = this.is_free;
    this.node.value = String(node ?? (this.is_free ? 0 : hinge[this.end + "_node"]));
    if (!value) this.status.textContent = now ? `Drag an arrow: along an axis; the middle: in the plane of the screen${this.is_free ? "" : ", and to a node"}. Shift: fine; Alt: past nodes; Escape: back.` : "The body of this end is not drawn.";
  }

  /**
   * @param {number[]} value  numbers of the end
   * @param {number | null} node  null: the same node
   */
  write(value, node) {
    const { hinge, end, is_free } = this;
    if (!hinge || !value.every(Number.isFinite) || (node !== null && !Number.isInteger(node))) return this.cancel();
    const key = is_free ? "position" : `${end}_position`;
    const numbers = is_free ? [...(hinge.position.length > 6 ? hinge.position.slice(0, 4) : [1, 0, 0, 0]), ...value] : value;
    return this.view.studio.attempt(async () => {
      const { values } = await ask("table", { text: this.view.pane.text, path: hinge.path });
      const by_parameter = [key, `${end}_node`].find((k) => values[k]?.includes("$"));
      if (by_parameter || (is_free && values.position_deg)) {
        this.cancel();
        this.status.textContent = by_parameter ? `${by_parameter} is made of parameters (${values[by_parameter]}): change those, or the text.` : "The text has position_deg: change it there.";
        return;
      }
      await this.view.pane.edit([...(node === null || node === hinge[`${end}_node`] ? [] : [`set ${hinge.path}.${end}_node=${node}`]), `set ${hinge.path}.${key}=${to_toml(numbers)}`]);
      this.dragged = null;  // the bodies stay where they were dragged until the scene of the text is there
      this.status.textContent = `${hinge.name}: ${node === null ? "" : `${end}_node = ${node}, `}${key} = ${to_toml(numbers)}`;
    }).then((done) => done === false && this.cancel());
  }

  /** The text does not change: all is where the text has it. */
  cancel() {
    this.dragged = null;
    if (this.motion) this.motion.shifts = new Map();
    this.show_numbers();
    this.motion?.draw();
  }
}
