// A [[function]] changed in its curve: handles are dragged, and moved by keys; points of a table are added and deleted.
// Numbers that do not change keep the text that they have.
import { ask } from "./api.js";
import { Chart } from "./chart.js";
import { list_handles, list_texts, splice, to_text } from "./function_handles.js";
import { label_time } from "./history.js";
import { format_number } from "./numbers.js";
import { el, make_button } from "./page_parts.js";

const kNear = 10;  // pixels around a point
const kFine = 0.1;  // of the way of the pointer, with shift
const kStep = 0.01;  // of the range of an axis, for a key

export class CurveEditor {
  /**
   * @param {any} view  the SystemView
   * @param {{name: string, type: string, of_time: boolean, x: number[], y: number[], path: string, values: Record<string, string>}} curve
   * @param {CurveEditor} [before]  of the text before: its handle stays chosen
   */
  constructor(view, { name, type, of_time, x, y, path, values }, before) {
    this.view = view;
    this.name = name;
    this.type = type;
    this.path = path;
    this.is_table = type === "table";
    this.word = this.is_table ? "point" : "handle";
    /** Changes that are not in the text yet, and drags: the curve is not replaced meanwhile. */
    this.pending = 0;
    this.chosen = before?.chosen ?? -1;
    this.span = [x[0], x[x.length - 1]];
    this.take_curve(x, y);
    this.take(values);
    /** Which control of the curve before has the focus, -1 for none. */
    this.focused = before ? before.list_controls().indexOf(document.activeElement) : -1;
    this.chart = new Chart({ title: "", series: this.make_series(), x_label: of_time ? (view.motion ? label_time(view.motion.run) : "time") : "argument", y_label: name, height: 170,
      on_grab: (at, event) => this.grab(at, event), on_double: (at) => this.is_table && this.add(at), on_key: (event) => this.key(event) });
    this.chart.overlay.setAttribute("aria-label", `${this.word}s of ${name}`);
    this.fields = ["x", "y"].map((axis) => {
      const field = el("input", { type: "number", step: "any", "aria-label": `${axis} of the ${this.word} of ${name}` });
      field.addEventListener("change", () => this.change(this.chosen, { [axis]: Number(field.value) }));
      return field;
    });
    this.remove_button = make_button("delete", "Delete the chosen point (Delete)", () => this.remove());
    this.status = el("output", { class: "note", "aria-live": "polite" });
    const more = this.is_table ? [make_button("add", "Add a point after the chosen one (Insert)", () => this.insert()), this.remove_button] : [];
    this.element = el("div", { class: "curve-editor", "data-function": name }, this.chart.element, el("div", { class: "tools" }, make_button("◀", `The ${this.word} before (p)`, () => this.step(-1)), make_button("▶", `The next ${this.word} (n)`, () => this.step(1)), ...this.fields.map((field, k) => el("label", {}, (k > 0 ? "value" : of_time ? "time" : "argument") + " ", field)), ...more), this.status);
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
    const mark = (handles, name, style) => {
      const [x, y] = [handles.map((h) => h.x), handles.map((h) => h.y)].map((v) => Float64Array.from(v.length > 0 ? v : [NaN]));
      return { name, x, y, points: "circle", style, tip: (i) => `${this.is_table ? "" : handles[i].name + " "}(${format_number(x[i], 4)}, ${format_number(y[i], 4)})` };
    };
    // Always three: the legend stays.
    return [this.curve, mark(this.handles, `${this.word}s`, 0), mark(this.handles.slice(this.chosen, this.chosen + 1), "chosen", 1)];
  }

  show() {
    const { chosen, handles } = this, handle = handles[chosen], moves = [handle?.along_x, handle?.along_y];
    this.chart.series = this.make_series();
    this.chart.draw();
    this.fields.forEach((field, k) => {
      field.disabled = !moves[k];
      field.value = handle ? String(Number([handle.x, handle.y][k].toPrecision(12))) : "";
    });
    this.remove_button.disabled = !handle || handles.length < 3;
    const ways = ["x", "y"].filter((_, k) => moves[k]).join(" and ");
    this.status.textContent = !handle ? (this.is_table ? "Drag a point; a double click adds one, Delete takes the chosen one away. Keys: n and p choose, arrows move." : "Drag a handle. Keys: n and p choose, arrows move.")
      : this.is_table ? `Point ${chosen + 1} of ${handles.length}: shift: fine, ctrl: y alone.` : `Handle ${chosen + 1} of ${handles.length}: ${handle.name}, along ${ways}; shift: fine.`;
    this.element.dataset.chosen = String(chosen);
    this.element.dataset.points = String(handles.length);
  }

  choose(k) {
    this.chosen = k;
    this.show();
  }
  step(by) {
    const n = this.handles.length;
    this.choose(this.chosen < 0 ? (by > 0 ? 0 : n - 1) : (this.chosen + by + n) % n);
  }

  /** The handle near a place of the chart, -1 without. */
  find(at) {
    let best = kNear, found = -1;
    this.handles.forEach((handle, k) => {
      const distance = Math.hypot(this.chart.map_x(handle.x) - at.x, this.chart.map_y(handle.y) - at.y);
      if (distance < best) [best, found] = [distance, k];
    });
    return found;
  }

  /** Rounded to less than a pixel. */
  round(v, is_x, more = 0) {
    const { range, frame } = this.chart, pixel = is_x ? (range.x1 - range.x0) / frame.width : (range.y1 - range.y0) / frame.height;
    return Number(v.toFixed(Math.min(12, Math.max(0, Math.ceil(-Math.log10(pixel)) + more)))) || 0;
  }

  /** Between the limits of the handle. */
  limit({ low = -Infinity, high = Infinity }, x) {
    const gap = 1e-3 * (this.chart.range.x1 - this.chart.range.x0);
    return Math.min(high - gap, Math.max(low + gap, x));
  }

  grab(at, from) {
    const k = this.find(at);
    if (k < 0) return null;
    this.choose(k);
    ++this.pending;
    const { chart, curve } = this, { x0, x1, y0, y1 } = chart.range, handle = this.handles[k], before = this.values, window = chart.link.window, y_window = chart.y_window;
    // The axes stay while the handle moves.
    chart.link.window = [x0, x1];
    chart.y_window = [y0, y1];
    let place = [chart.map_x(handle.x), chart.map_y(handle.y)], last = from, is_moved = false;
    const release = () => {
      --this.pending;
      this.is_dragged = false;
      removeEventListener("keydown", stop);
      chart.link.window = window;
      chart.y_window = y_window;
    };
    const back = () => {
      is_moved = this.is_dragged = false;
      this.take(before);
      this.curve = curve;
      this.show();
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
        const to = {};
        if (Math.abs(place[0] - chart.map_x(handle.x)) > 0.5) to.x = this.round(this.limit(handle, chart.unmap_x(place[0])), true, more);
        if (Math.abs(place[1] - chart.map_y(handle.y)) > 0.5) to.y = this.round(chart.unmap_y(place[1]), false, more);
        this.is_dragged = true;
        this.try_values(this.move(handle, to, before));
      },
      end: () => {
        release();
        const after = this.values;
        this.take(before);
        if (is_moved) this.write(after);
        else this.show();
        this.view.diagrams.update();
      },
    };
  }

  /** Values of the table when a handle is at another place. @param {{x?: number, y?: number}} to */
  move(handle, to, values) {
    const changes = { ...(to.x !== undefined && handle.along_x?.(to.x)), ...(to.y !== undefined && handle.along_y?.(to.y)) };
    // What is no plain number, as a parameter, stays.
    const free = Object.entries(changes).filter((change) => !/["']/.test(values[change[0]] ?? ""));
    return { ...values, ...Object.fromEntries(free.map(([key, v]) => [key, typeof v === "number" ? to_text(v) : v])) };
  }

  /** While a handle moves: the handles at once, the curve as soon as the program has drawn it. */
  try_values(values) {
    this.take(values);
    this.draw_lines();
    if (!this.is_straight()) this.follow();
  }

  is_straight() {
    return this.is_table && /^$|linear/.test(this.values.interpolation ?? "");
  }

  /** Straight lines of a linear table. */
  draw_lines() {
    const { handles } = this, n = handles.length;
    if (this.is_straight() && this.chart && n > 0) {
      const { x0, x1 } = this.chart.range, [x, y] = [handles.map((h) => h.x), handles.map((h) => h.y)];
      this.take_curve([Math.min(x0, x[0]), ...x, Math.max(x1, x[n - 1])], [y[0], ...y, y[n - 1]]);
    }
    this.show();
  }

  /** Asks for the curve with the values as they are now; what comes while an answer is on its way waits, the last alone. */
  async follow() {
    this.is_late = true;
    if (this.is_asking) return;
    this.is_asking = true;
    try {
      while (this.is_late) {
        this.is_late = false;
        const { view } = this, commands = this.list_commands(this.written, this.values);
        const { functions } = await ask("diagram", { file: view.file, text: view.pane.text, kind: "system", commands });
        const found = functions.find((f) => f.name === this.name);
        if (!found || !this.is_dragged) continue;
        this.take_curve(found.x, found.y);
        this.show();
      }
    } catch {
      // Values that no run has: the text says why when the handle is there.
    } finally {
      this.is_asking = false;
    }
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
    const p = this.handles, n = p.length, k = this.chosen < 0 ? n - 1 : this.chosen;
    if (k < n - 1) return this.put((p[k].x + p[k + 1].x) / 2, (p[k].y + p[k + 1].y) / 2);
    return this.put(2 * p[k].x - (p[k - 1]?.x ?? p[k].x - 1), p[k].y);
  }

  /** Both lists with other entries. @param {(texts: string[], axis: number) => string[]} edit */
  edit_lists(edit) {
    const lists = ["x", "y"].map((key, axis) => [key, `[${edit(list_texts(this.values[key]), axis).join(", ")}]`]);
    return this.write({ ...this.values, ...Object.fromEntries(lists) });
  }

  put(x, y) {
    if (this.handles.some((h) => h.x === x)) return;
    const k = this.handles.findIndex((h) => h.x > x), at = k < 0 ? this.handles.length : k;
    this.chosen = at;
    this.edit_lists((texts, axis) => splice(texts, at, 0, to_text([x, y][axis])));
  }

  remove() {
    const { chosen } = this;
    if (!this.is_table || chosen < 0 || this.handles.length < 3) return;
    this.chosen = Math.min(chosen, this.handles.length - 2);
    this.edit_lists((texts) => splice(texts, chosen, 1));
  }

  /** Another place of a handle, within its limits. @param {{x?: number, y?: number}} to */
  change(k, to) {
    const handle = this.handles[k];
    if (!handle || Object.values(to).some((v) => !Number.isFinite(v))) return this.show();
    const { low = -Infinity, high = Infinity } = handle;
    if (to.x !== undefined && (to.x <= low || to.x >= high)) {
      this.show();
      this.status.textContent = `x stays between ${Number.isFinite(low) ? low : "−∞"} and ${Number.isFinite(high) ? high : "∞"}.`;
      return;
    }
    const same = Object.fromEntries(Object.entries(to).filter(([axis, v]) => v !== handle[axis]));
    this.write(this.move(handle, same, this.values));
  }

  key(event) {
    const handle = this.handles[this.chosen], { x0, x1, y0, y1 } = this.chart.range, share = kStep * (event.shiftKey ? kFine : 1), more = event.shiftKey ? 1 : 0;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.key === "n") this.step(1);
    else if (event.key === "p") this.step(-1);
    else if (event.key === "Insert" && this.is_table) this.insert();
    else if (!handle) return false;
    else if (event.key === "Escape") this.choose(-1);
    else if (event.key === "Delete" || event.key === "Backspace") this.remove();
    else if (way) this.change(this.chosen, way[0] ? { x: this.round(this.limit(handle, handle.x + way[0] * share * (x1 - x0)), true, more) } : { y: this.round(handle.y + way[1] * share * (y1 - y0), false, more) });
    else return false;
    return true;
  }

  list_commands(before, after) {
    const changed = Object.keys(after).filter((key) => after[key] !== before[key]);
    return changed.length > 0 ? [`set ${changed.map((key) => `${this.path}.${key}=${after[key]}`).join(" ")}`] : [];
  }

  /** The values are here at once: what comes next begins with them. @param {Record<string, string>} values */
  async write(values) {
    const before = this.values, chosen = this.chosen, commands = this.list_commands(before, values);
    if (commands.length === 0) return this.show();
    this.take(values);
    this.draw_lines();
    ++this.pending;
    const done = await this.view.studio.attempt(() => this.view.pane.edit(commands));
    --this.pending;
    if (done === false) {
      this.chosen = chosen;
      this.take(before);
      this.draw_lines();
    } else {
      this.written = values;
    }
    this.view.diagrams.update();
  }

  take(values) {
    this.values = values;
    this.written ??= values;  // as the text has them
    this.handles = list_handles(this.type, values, this.span);
    if (this.chosen >= this.handles.length) this.chosen = -1;
  }

  take_curve(x, y) {
    this.curve = { name: `${this.name} (${this.type})`, x: Float64Array.from(x), y: Float64Array.from(y, (v) => v ?? NaN) };
  }
}
