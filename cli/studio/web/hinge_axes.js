// Axes of hinges in the scene of a system: an arrow that is turned by dragging its tip, and its numbers by keys. The
// axis is written to the text as a command of `bough edit` does.
import { el, get_css, make_button, make_select } from "./page_parts.js";
import { add_arrow, to_thing, turn } from "./scene_marks.js";

const kGrab = 18;  // pixels around the tip
const kSnap = Math.cos((4 * Math.PI) / 180);  // of an axis of the hinge frame
const kShare = 0.24;  // length of the arrow over the size of the scene

export const transpose = (R) => R[0].map((_, i) => R.map((row) => row[i]));
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (v) => v.map((x) => x / Math.hypot(...v));
const round = (v) => Number(v.toFixed(4));
/** Numbers of a TOML file, which are no integers. */
export const to_toml = (v) => `[${v.map((x) => (Number.isInteger(x) ? x.toFixed(1) : String(x))).join(", ")}]`;

export class HingeAxes {
  /** @param {any} view  the SystemView */
  constructor(view) {
    this.view = view;
    this.name = "";
    /** @type {number[] | null} axis in the world while it is dragged */
    this.dragged = null;
    this.picker = make_select("turn the axis of", ["no hinge"], (k) => this.choose(k > 0 ? this.names[k - 1] : ""));
    this.picker.list.classList.add("hinge-picker");
    this.names = [];
    this.fields = ["x", "y", "z"].map((name) => {
      const field = el("input", { type: "number", step: "any", "aria-label": `axis ${name}` });
      field.addEventListener("change", () => this.write(this.fields.map((f) => Number(f.value))));
      return field;
    });
    const along = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis, i) => make_button("xyz"[i], "The axis along " + "xyz"[i] + " of the hinge frame of the parent", () => this.write(axis)));
    this.numbers = el("span", { class: "axis-numbers", hidden: true }, ...this.fields, ...along, make_button("± reverse", "The axis in the other direction", () => this.write(this.fields.map((f) => -Number(f.value)))));
    this.status = el("output", { class: "note", "aria-live": "polite" });
    this.element = el("div", { class: "tools hinge-axes", hidden: true }, this.picker, this.numbers, this.status);
  }

  get motion() {
    return this.view.motion;
  }

  /** A scene that is drawn from now on. */
  attach(motion) {
    const with_axis = motion.run.data.hinges.filter((h) => h.rotation && Math.hypot(...h.axis) > 0);
    this.hinges = new Map(with_axis.map((h) => [h.name, h]));
    const names = [...this.hinges.keys()];
    if (names.join("\n") !== this.names.join("\n")) {
      this.names = names;
      this.picker.list.replaceChildren(...["no hinge", ...names].map((name, i) => el("option", { value: i }, name)));
    }
    if (!this.hinges.has(this.name)) this.name = "";
    this.picker.list.selectedIndex = names.indexOf(this.name) + 1;
    this.element.hidden = names.length === 0;
    this.dragged = null;
    this.show_numbers();
    if (this.name) motion.draw();
  }

  choose(name) {
    this.name = name;
    this.show_numbers();
    this.motion.draw();
  }

  /** Place of the hinge, its axis there, and the axes of its frame as rows; of the scene as it is drawn now. */
  locate() {
    const hinge = this.hinges?.get(this.name), places = this.motion.get_places();
    const at = hinge && this.motion.marks.locate(hinge.at, places);
    if (!at) return null;
    const R = hinge.at.body >= 0 ? places[hinge.at.body].R : [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const frame = transpose(hinge.rotation).map((column) => turn(R, column));
    return { at, axis: this.dragged ?? unit(turn(R, hinge.axis)), frame };
  }

  get_length(size = this.motion.viewer.extent) {
    return kShare * size;
  }

  make_things(_places, size) {
    const now = this.name && this.locate();
    if (!now) return [];
    const mesh = { points: [], triangles: [] };
    add_arrow(mesh, now.at, now.axis.map((v) => v * this.get_length(size)), 1, 1.6 * size);
    return [to_thing(mesh, get_css("--link"))];
  }

  can_grab(event) {
    const now = this.name && this.locate();
    if (!now) return false;
    const tip = now.at.map((v, i) => v + this.get_length() * now.axis[i]);
    const { canvas } = this.motion.viewer, place = this.motion.viewer.find_place(tip), box = canvas.getBoundingClientRect();
    return place !== null && Math.hypot(place[0] - (event.clientX - box.left), place[1] - (event.clientY - box.top)) < kGrab;
  }

  /** Takes the tip: it follows the pointer on a sphere about the hinge, near an axis of the hinge frame it is that. */
  grab(event) {
    if (!this.can_grab(event)) return null;
    const { at, axis, frame } = this.locate(), length = this.get_length();
    const show = (v) => this.show_numbers(v);
    return {
      move: (to) => {
        const { eye, direction } = this.motion.viewer.make_ray(to);
        const before = this.dragged ?? axis, from = eye.map((v, i) => v - at[i]);
        const along = dot(from, direction), space = along * along - dot(from, from) + length * length;
        const meet = (t) => unit(from.map((v, i) => v + t * direction[i]));
        const ends = space > 0 ? [meet(-along - Math.sqrt(space)), meet(-along + Math.sqrt(space))] : [meet(-along)];
        let next = ends.reduce((best, v) => (dot(v, before) > dot(best, before) ? v : best));
        if (!to.altKey) for (const row of frame) for (const s of [-1, 1]) if (dot(next, row) * s > kSnap) next = row.map((x) => s * x);
        this.dragged = next;
        show(frame.map((row) => dot(next, row)));
        this.motion.draw();
      },
      end: () => {
        if (this.dragged) this.write(frame.map((row) => dot(this.dragged, row)));
      },
    };
  }

  show_numbers(axis = null) {
    const hinge = this.hinges?.get(this.name);
    this.numbers.hidden = !hinge;
    this.status.textContent = hinge ? "Drag the tip of the arrow. Near an axis of the hinge frame it is that axis, but for Alt." : "";
    if (!hinge) return;
    (axis ?? transpose(hinge.rotation).map((column) => dot(column, hinge.axis))).forEach((v, i) => (this.fields[i].value = String(round(v) || 0)));
  }

  /** @param {number[]} axis  in the hinge frame of the parent */
  write(axis) {
    const rounded = axis.map((v) => round(v) || 0);
    if (!(Math.hypot(...rounded) > 0) || !rounded.every(Number.isFinite)) return this.show_numbers();
    const item = this.view.pane.answer?.items.find((i) => i.kind === "hinge" && i.name === this.name);
    if (!item) return;
    return this.view.studio.attempt(async () => {
      await this.view.pane.edit([`set ${item.path}.axis=${to_toml(rounded)}`]);
      this.status.textContent = `${this.name}: axis = ${to_toml(rounded)}`;
    }).then((done) => done === false && this.cancel());
  }

  /** The text does not take it: the arrow is that of the text. */
  cancel() {
    this.dragged = null;
    this.show_numbers();
    this.motion.draw();
  }
}
