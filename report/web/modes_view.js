import { Box, Drawing, kBarNote } from "./drawing.js";
import { format_number, write_powers } from "./numbers.js";
import { el, get_css, make_button, make_check, make_color_bar, make_select, make_slider } from "./page_parts.js";
import { Viewer, make_triad } from "./viewer.js";

const kColorings = ["displacement", "nothing", "strain energy", "strain energy density"];
const label_unit = (name, unit) => (unit ? `${name} [${unit}]` : name);

// One mode at a time, swinging; or one static solution. Of complex modes the shapes are in turn real and imaginary parts.
export class ModesView {
  constructor(data) {
    this.drawing = new Drawing(data.drawing);
    this.viewer = new Viewer();
    this.mode = 0;
    this.phase = Math.PI / 2;
    this.turns = 0.5;  // per second
    this.is_playing = false;
    this.has_overlay = true;
    this.color_by = 0;  // index into kColorings, then into the fields of the elements
    this.is_averaged = false;
    this.is_complex = data.complex === true;
    const count = data.drawing.shapes.length / (this.is_complex ? 2 : 1);
    this.names = data.names;
    const names = data.names?.slice(0, count) ?? Array.from({ length: count }, (_, j) => `${j + 1}: ${format_number(data.frequency[j] ?? NaN, 5)}${data.kinds[j] && data.kinds[j] !== "normal" ? " " + data.kinds[j] : ""}`);
    this.picker = make_select(data.names ? "deformed by" : data.buckling ? "load factor" : "mode, frequency [Hz]", names, (j) => this.show(j));
    this.picker.list.classList.add("mode-picker");
    const step = (by) => () => this.show((this.mode + by + count) % count);
    this.box = new Box();
    this.box.add_points(this.drawing.xyz);
    this.play_button = make_button("▶ play", "Play or pause", () => this.play(!this.is_playing));
    this.play_button.classList.add("play");
    this.note = el("p", { class: "note" });
    this.bar = make_color_bar();
    const tools = el("div", { class: "tools" }, this.picker, make_button("◀", "Mode before", step(-1)), make_button("▶", "Next mode", step(1)), this.play_button,
      make_slider("amplitude", { min: 0, max: 0.4, step: 0.005, value: 0.12 }, (v) => { this.amplitude = v; this.draw(); return Math.round(100 * v) + " %"; }),
      make_slider("speed", { min: 0.1, max: 3, step: 0.1, value: 0.5 }, (v) => { this.turns = v; return v + " /s"; }),
      make_check("undeformed", true, (on) => { this.has_overlay = on; this.draw(); }),
      this.make_color_tools(), this.viewer.make_view_buttons());
    this.element = el("div", { class: "modes" }, tools, this.viewer.element, this.bar.element, this.note);
    // Left and right show the mode before and the next one; with shift they turn the view.
    this.viewer.on_key = (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!by || event.shiftKey) return false;
      event.preventDefault();
      step(by)();
      return true;
    };
    this.viewer.repaint = () => this.draw();
    this.viewer.fit(this.box);
    this.show(0);
  }

  // Fields of elements, each column of a static solution one, are flat in an element or means at its nodes.
  make_color_tools() {
    this.fields = this.drawing.fields ?? [];
    const names = kColorings.slice(0, this.drawing.elements ? 4 : 2);
    this.num_plain = names.length;
    const colors = make_select("colour by", [...names, ...this.fields.map((f) => [f.group, f.name])], (i) => { this.color_by = i; this.show(this.mode); });
    if (this.fields.length === 0) return colors;
    this.average = make_check("averaged at nodes", false, (on) => { this.is_averaged = on; this.show(this.mode); });
    return el("span", { class: "together" }, colors, this.average);
  }

  // Levels of the chosen field, and what a click on an element tells.
  show_field(mode) {
    const field = this.fields[this.color_by - this.num_plain], found = this.drawing.get_field(field, mode), { id, property } = this.drawing.elements;
    const level = (v) => (Number.isFinite(v) ? (found.high > found.low ? (v - found.low) / (found.high - found.low) : 0.5) : -1);
    const means = this.is_averaged && field.average ? this.drawing.average(found.values) : null;
    const number = (v) => format_number(v, 4), name_value = (v) => `${field.name} ${Number.isFinite(v) ? number(v) + (field.unit ? " " + write_powers(field.unit) : "") : "none"}`;
    this.field = { levels: Float32Array.from(found.values, level), corner_levels: means ? Float32Array.from(means.corners, level) : undefined,
      describe: (element) => `element ${id[element]}${property[element] ? `, property ${property[element]}` : ""}: ${name_value(found.values[element])}` };
    this.bar.update(found.low, found.high, label_unit(field.name, field.unit), number);
    const ends = found.least < 0 ? `No element of this subcase has a ${field.name}.` : `From ${number(found.low)} (element ${id[found.least]}) to ${number(found.high)} (element ${id[found.most]}).`;
    const kind = means ? " Colours: means at the nodes, of elements with one property." : field.average ? "" : " Components in element axes have no mean at nodes.";
    const has_gaps = found.least >= 0 && found.values.some((v) => !Number.isFinite(v));
    return `${ends}${kind}${has_gaps ? " Grey: elements without it." : ""} `;
  }

  show(mode) {
    this.mode = mode;
    this.picker.list.value = mode;
    this.reach = this.is_complex ? this.drawing.get_complex_reach(2 * mode) : this.drawing.get_reach(mode);
    const is_field = this.color_by >= this.num_plain;
    if (this.average) this.average.hidden = !is_field || !this.fields[this.color_by - this.num_plain].average;
    this.energy = this.color_by > 1 && !is_field ? this.drawing.get_levels(mode, this.color_by === 3) : null;
    const what = this.names ? this.names[mode][0].toUpperCase() + this.names[mode].slice(1) + ": largest displacement" : `Mode ${mode + 1}: largest displacement of its shape`;
    const label = this.names ? this.names[mode] : `mode ${mode + 1}`;
    const number = (v) => format_number(v, 4), percent = (v) => format_number(100 * v, 4) + " %";
    this.bar.element.hidden = this.color_by === 1;
    this.field = null;
    const about_field = is_field ? this.show_field(mode) : "";
    if (this.color_by === 0) this.bar.update(0, this.reach, this.names ? "displacement" : "displacement of the shape", number);
    if (this.color_by === 2 && !is_field) this.bar.update(0, this.energy.largest, "strain energy of each element, of the whole", percent);
    if (this.color_by === 3 && !is_field) this.bar.update(0, 1, "strain energy per length, area or volume, of the largest of lines, of surfaces, of solids", percent);
    this.viewer.name = `${label}${is_field ? " " + this.fields[this.color_by - this.num_plain].name : this.color_by > 0 ? " " + kColorings[this.color_by] : ""}`;
    this.note.textContent = `${about_field}${what} ${format_number(this.reach)}, drawn as the amplitude's share of the size of the body. A click names a node${is_field ? " and its element" : ""}. Axes: orange x, green y, blue z.${this.drawing.has_bars() ? kBarNote : ""}`;
    this.draw();
  }

  play(is_on) {
    this.is_playing = is_on;
    this.play_button.textContent = is_on ? "❚❚ pause" : "▶ play";
    this.viewer.set_played(is_on);
    let last = performance.now();
    const step = (now) => {
      if (!this.is_playing || !this.element.isConnected) return;
      this.phase += 2 * Math.PI * this.turns * Math.min(0.1, (now - last) / 1000);
      last = now;
      this.draw();
      requestAnimationFrame(step);
    };
    if (is_on) requestAnimationFrame(step);
  }

  draw() {
    if (!this.reach && this.reach !== 0) return;
    const size = this.box.get_diagonal();
    const scale = this.reach > 0 ? (this.amplitude * size) / this.reach : 0;
    // Re φ sin(phase) + Im φ cos(phase) is Re(φ exp(iωt)) with ωt = phase - π/2.
    const parts = this.is_complex ? [Math.sin(this.phase), Math.cos(this.phase)] : [Math.sin(this.phase)];
    const first = this.mode * parts.length;
    this.drawing.deform(Array.from({ length: first + parts.length }, (_, j) => (j >= first ? parts[j - first] : 0)), scale);
    const { xyz, points, triangles, edges, ghosts } = this.drawing;
    const has_faces = triangles.length > 0;
    const body = { points, size: this.drawing.size, triangles, edges, lines: this.drawing.find_lines(), ghosts, color: get_css("--body"), by_level: this.color_by === 0, dots: !has_faces };
    const size_of = this.drawing.size, swing = scale > 0 ? scale : 1;
    if (this.drawing.ids.length > 0)
      Object.assign(body, { ids: this.drawing.ids, describe: (k) => this.drawing.describe(k, "", `displacement ${format_number(size_of[k] / swing, 4)}`) });
    if (this.field) Object.assign(body, { elements: this.drawing.elements, levels: this.field.levels, corner_levels: this.field.corner_levels, color: get_css("--ghost"), describe_element: this.field.describe });
    if (this.energy) Object.assign(body, { elements: this.drawing.elements, levels: this.energy.levels });
    const things = [...make_triad([0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], 0.12 * size), body];
    if (this.has_overlay) things.unshift({ points: xyz, edges, color: get_css("--ghost"), alpha: 0.7, lift: -1e-3 });
    this.viewer.things = things;
    this.viewer.reach = this.amplitude * size;
    this.viewer.draw();
  }
}
