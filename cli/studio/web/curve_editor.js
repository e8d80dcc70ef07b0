// Points of a [[function]] of type table, changed in its curve: dragged, added by a double click, deleted; by keys too.
// Numbers that do not change keep the text that they have.
import { Chart } from "./chart.js";
import { format_number } from "./numbers.js";
import { el, make_button } from "./page_parts.js";

const kNear = 10;  // pixels around a point
const kFine = 0.1;  // of the way of the pointer, with shift
const kStep = 0.01;  // of the range of an axis, for a key

const kList = /^\[[\s\d.,eE+\-_]*\]$/;
const list_texts = (text) => text.slice(1, -1).split(",").map((t) => t.trim()).filter(Boolean);

/** Returns true if both lists of a table are numbers, neither parameters nor a file. @param {{x: string, y: string}} points */
export const is_plain = ({ x, y }) => kList.test(x) && kList.test(y) && list_texts(x).length === list_texts(y).length && list_texts(x).length > 0;

/** A copy of a list, from place k on `count` entries replaced. */
const splice = (list, k, count, ...entries) => [...list.slice(0, k), ...entries, ...list.slice(k + count)];
const to_text = (v) => (Number.isInteger(v) && Math.abs(v) < 1e15 ? v.toFixed(1) : String(v));
const to_number = (text) => Number(text.replaceAll("_", ""));

export class CurveEditor {
  /**
   * @param {any} view  the SystemView
   * @param {{name: string, type: string, line: number, x: number[], y: number[], points: {path: string, x: string, y: string, interpolation: string}}} curve
   * @param {CurveEditor} [before]  of the text before: its point stays chosen
   */
  constructor(view, { name, type, x, y, points }, before) {
    this.view = view;
    this.name = name;
    this.path = points.path;
    this.is_linear = points.interpolation === "" || points.interpolation.includes("linear");
    /** Changes that are not in the text yet, and drags: the curve is not replaced meanwhile. */
    this.pending = 0;
    this.chosen = before?.chosen ?? -1;
    this.take({ x: list_texts(points.x), y: list_texts(points.y) });
    this.curve = { name: `${name} (${type})`, x: Float64Array.from(x), y: Float64Array.from(y, (v) => v ?? NaN) };
    /** Which control of the curve before has the focus, -1 for none. */
    this.focused = before ? before.list_controls().indexOf(document.activeElement) : -1;
    this.chart = new Chart({ title: "", series: this.make_series(), x_label: "argument", y_label: name, height: 170,
      on_grab: (at, event) => this.grab(at, event), on_double: (at) => this.add(at), on_key: (event) => this.key(event) });
    this.chart.overlay.setAttribute("aria-label", `points of ${name}`);
    this.fields = ["x", "y"].map((axis, k) => {
      const field = el("input", { type: "number", step: "any", "aria-label": `${axis} of the point of ${name}` });
      field.addEventListener("change", () => this.change(this.chosen, k === 0 ? Number(field.value) : this.x[this.chosen], k === 1 ? Number(field.value) : this.y[this.chosen]));
      return field;
    });
    this.remove_button = make_button("delete", "Delete the chosen point (Delete)", () => this.remove());
    this.status = el("output", { class: "note", "aria-live": "polite" });
    this.element = el("div", { class: "curve-editor", "data-function": name }, this.chart.element, el("div", { class: "tools" }, make_button("◀", "Point before (p)", () => this.step(-1)), make_button("▶", "Next point (n)", () => this.step(1)), ...this.fields, make_button("add", "Add a point after the chosen one (Insert)", () => this.insert()), this.remove_button), this.status);
    this.show();
  }

  /** On the page: the focus is where it was. */
  settle() {
    if (this.focused >= 0) /** @type {HTMLElement} */ (this.list_controls()[this.focused])?.focus();
    this.focused = -1;
  }
  /** @returns {(Element | null)[]} */
  list_controls() {
    return [...this.element.querySelectorAll("canvas.overlay, .tools button, .tools input")];
  }

  make_series() {
    const mark = (x, y, name, style) => ({ name, x, y, points: "circle", style, tip: (i) => `(${format_number(x[i])}, ${format_number(y[i])})` });
    const { chosen } = this;
    // Always three: the legend stays.
    return [this.curve, mark(Float64Array.from(this.x), Float64Array.from(this.y), "points", 0), mark(Float64Array.of(this.x[chosen] ?? NaN), Float64Array.of(this.y[chosen] ?? NaN), "chosen", 1)];
  }

  show() {
    const { chosen } = this;
    this.chart.series = this.make_series();
    this.chart.draw();
    this.fields.forEach((field, k) => {
      field.disabled = chosen < 0;
      field.value = chosen < 0 ? "" : String([this.x, this.y][k][chosen]);
    });
    this.remove_button.disabled = chosen < 0 || this.x.length < 3;
    this.status.textContent = chosen < 0 ? "Drag a point; a double click adds one, Delete takes the chosen one away. Keys: n and p choose, arrows move." : `Point ${chosen + 1} of ${this.x.length}: shift: fine, ctrl: y alone.`;
    this.element.dataset.chosen = String(chosen);
    this.element.dataset.points = String(this.x.length);
  }

  choose(k) {
    this.chosen = k;
    this.show();
  }
  step(by) {
    this.choose(this.chosen < 0 ? (by > 0 ? 0 : this.x.length - 1) : (this.chosen + by + this.x.length) % this.x.length);
  }

  /** The point near a place of the chart, -1 without. */
  find(at) {
    let best = kNear, found = -1;
    this.x.forEach((x, k) => {
      const distance = Math.hypot(this.chart.map_x(x) - at.x, this.chart.map_y(this.y[k]) - at.y);
      if (distance < best) [best, found] = [distance, k];
    });
    return found;
  }

  /** Rounded to less than a pixel. */
  round(v, is_x, more = 0) {
    const { range, frame } = this.chart, pixel = is_x ? (range.x1 - range.x0) / frame.width : (range.y1 - range.y0) / frame.height;
    return Number(v.toFixed(Math.min(12, Math.max(0, Math.ceil(-Math.log10(pixel)) + more)))) || 0;
  }

  /** Between the points before and after. */
  limit(k, x) {
    const gap = 1e-3 * (this.chart.range.x1 - this.chart.range.x0);
    return Math.min((this.x[k + 1] ?? Infinity) - gap, Math.max((this.x[k - 1] ?? -Infinity) + gap, x));
  }

  grab(at, from) {
    const k = this.find(at);
    if (k < 0) return null;
    this.choose(k);
    ++this.pending;
    const { chart } = this, { x0, x1, y0, y1 } = chart.range, old = [this.x[k], this.y[k]], window = chart.link.window, y_window = chart.y_window;
    // The axes stay while the point moves.
    chart.link.window = [x0, x1];
    chart.y_window = [y0, y1];
    let place = [chart.map_x(old[0]), chart.map_y(old[1])], last = from, is_moved = false;
    const release = () => {
      --this.pending;
      removeEventListener("keydown", stop);
      chart.link.window = window;
      chart.y_window = y_window;
    };
    const back = () => {
      is_moved = false;
      [this.x[k], this.y[k]] = old;
      this.draw_lines();
    };
    const stop = (event) => event.key === "Escape" && back();
    addEventListener("keydown", stop);
    return {
      move: (_at, event) => {
        const share = event.shiftKey ? kFine : 1, more = event.shiftKey ? 1 : 0;
        place = [place[0] + (event.ctrlKey ? 0 : share * (event.clientX - last.clientX)), place[1] + share * (event.clientY - last.clientY)];
        last = event;
        is_moved ||= Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > 2;
        if (!is_moved) return;
        // An axis along which the pointer does not move keeps its number.
        if (Math.abs(place[0] - chart.map_x(old[0])) > 0.5) this.x[k] = this.round(this.limit(k, chart.unmap_x(place[0])), true, more);
        else this.x[k] = old[0];
        if (Math.abs(place[1] - chart.map_y(old[1])) > 0.5) this.y[k] = this.round(chart.unmap_y(place[1]), false, more);
        else this.y[k] = old[1];
        this.draw_lines();
      },
      end: () => {
        release();
        const [x, y] = [this.x[k], this.y[k]];
        [this.x[k], this.y[k]] = old;
        if (is_moved && (x !== old[0] || y !== old[1])) this.change(k, x, y);
        else this.draw_lines();
        this.view.diagrams.update();
      },
    };
  }

  /** While a point moves: straight lines of a linear table; a spline is drawn by the program, after the drag. */
  draw_lines() {
    if (this.is_linear) {
      const n = this.x.length, { x0, x1 } = this.chart.range;
      this.curve = { ...this.curve, x: Float64Array.of(Math.min(x0, this.x[0]), ...this.x, Math.max(x1, this.x[n - 1])), y: Float64Array.of(this.y[0], ...this.y, this.y[n - 1]) };
    }
    this.show();
  }

  /** A double click away from all points adds one. */
  add(at) {
    const { left, top, width, height } = this.chart.frame;
    if (at.x < left || at.x > left + width || at.y < top || at.y > top + height) return false;
    if (this.find(at) < 0) this.put(this.round(this.chart.unmap_x(at.x), true), this.round(this.chart.unmap_y(at.y), false));
    return true;
  }
  /** Halfway to the next point, or as far again after the last one. */
  insert() {
    const n = this.x.length, k = this.chosen < 0 ? n - 1 : this.chosen;
    if (k < n - 1) return this.put((this.x[k] + this.x[k + 1]) / 2, (this.y[k] + this.y[k + 1]) / 2);
    return this.put(2 * this.x[k] - (this.x[k - 1] ?? this.x[k] - 1), this.y[k]);
  }

  put(x, y) {
    if (this.x.includes(x)) return;
    const k = this.x.findIndex((v) => v > x), at = k < 0 ? this.x.length : k;
    this.chosen = at;
    this.write({ x: splice(this.texts.x, at, 0, to_text(x)), y: splice(this.texts.y, at, 0, to_text(y)) });
  }

  remove() {
    const { chosen, texts } = this;
    if (chosen < 0 || this.x.length < 3) return;
    this.chosen = Math.min(chosen, this.x.length - 2);
    this.write({ x: splice(texts.x, chosen, 1), y: splice(texts.y, chosen, 1) });
  }

  /** Another place of a point; its x stays between the neighbours. */
  change(k, x, y) {
    if (k < 0 || !Number.isFinite(x) || !Number.isFinite(y)) return this.show();
    if ((k > 0 && x <= this.x[k - 1]) || x >= (this.x[k + 1] ?? Infinity)) {
      this.show();
      this.status.textContent = `x stays between ${this.x[k - 1] ?? "−∞"} and ${this.x[k + 1] ?? "∞"}.`;
      return;
    }
    const swap = (texts, old, now) => (now === old[k] ? texts : splice(texts, k, 1, to_text(now)));
    this.write({ x: swap(this.texts.x, this.x, x), y: swap(this.texts.y, this.y, y) });
  }

  key(event) {
    const k = this.chosen, { x0, x1, y0, y1 } = this.chart.range, share = kStep * (event.shiftKey ? kFine : 1), more = event.shiftKey ? 1 : 0;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.key === "n") this.step(1);
    else if (event.key === "p") this.step(-1);
    else if (event.key === "Insert") this.insert();
    else if (k < 0) return false;
    else if (event.key === "Escape") this.choose(-1);
    else if (event.key === "Delete" || event.key === "Backspace") this.remove();
    else if (way) this.change(k, way[0] ? this.round(this.limit(k, this.x[k] + way[0] * share * (x1 - x0)), true, more) : this.x[k], way[1] ? this.round(this.y[k] + way[1] * share * (y1 - y0), false, more) : this.y[k]);
    else return false;
    return true;
  }

  /** The points are here at once: what comes next begins with them. @param {{x: string[], y: string[]}} texts */
  async write(texts) {
    const before = this.texts, chosen = this.chosen;
    const commands = ["x", "y"].filter((key) => texts[key].join() !== before[key].join()).map((key) => `set ${this.path}.${key}=[${texts[key].join(", ")}]`);
    this.take(texts);
    ++this.pending;
    const done = await this.view.studio.attempt(() => this.view.pane.edit(commands));
    --this.pending;
    if (done === false) {
      this.chosen = chosen;
      this.take(before);
    }
    this.view.diagrams.update();
  }

  take(texts) {
    this.texts = texts;
    this.x = texts.x.map(to_number);
    this.y = texts.y.map(to_number);
    if (this.chosen >= this.x.length) this.chosen = -1;
    if (this.chart) this.draw_lines();
  }
}
