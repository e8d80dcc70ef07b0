import { el, get_css, get_style, make_button, make_file_name, on_theme, save_blob } from "./page_parts.js";
import { find_index, find_nearest, format_number, make_log_ticks, make_step_ticks, make_ticks, write_powers } from "./numbers.js";

// Charts that share their window of x and their cursor.
export class Link {
  constructor() {
    this.charts = [];
    this.window = null;  // [low, high], or null: all
    this.listeners = { window: [], cursor: [], pick: [] };
  }
  on(event, act) {
    this.listeners[event].push(act);
  }
  set_window(window) {
    const begin = performance.now();
    this.window = window;
    for (const chart of this.charts) chart.draw();
    for (const act of this.listeners.window) act(window);
    // What the tests hold against the time that a zoom may take.
    document.documentElement.dataset.zoomMs = (performance.now() - begin).toFixed(1);
  }
  set_cursor(x, from) {
    for (const chart of this.charts) chart.draw_cursor(x, chart === from);
    for (const act of this.listeners.cursor) act(x, from);
  }
  pick(x) {
    for (const act of this.listeners.pick) act(x);
  }
}

let is_printing = false;
export const set_printing = (is_on) => (is_printing = is_on);

const kPaperWidth = 680;  // CSS pixels that a sheet has room for
const kMargin = { left: 76, right: 14, top: 10, bottom: 42 };

const kMaxMarkRows = 3, kMarkRow = 13, kMaxMarkWidth = 220;  // labels above the frame, CSS pixels

// The text, or what of it is not wider than `width`, with an ellipsis; g has the font.
export function fit_text(g, text, width) {
  if (g.measureText(text).width <= width) return text;
  let count = text.length;
  while (count > 0 && g.measureText(text.slice(0, count) + "…").width > width) --count;
  return text.slice(0, count).trimEnd() + "…";
}

// The mark of a point, in the picture and in its legend.
function stroke_mark(g, kind, x, y, size) {
  g.beginPath();
  if (kind === "cross") {
    g.moveTo(x - size, y - size);
    g.lineTo(x + size, y + size);
    g.moveTo(x - size, y + size);
    g.lineTo(x + size, y - size);
  } else g.arc(x, y, kind === "dot" ? 1 : size, 0, 2 * Math.PI);
  g.stroke();
}

// Curves and points on a canvas. options: series [{ name, x, y, points, tip(i) }] (x ascending for curves), x_label,
// y_label, x_log, y_log, marks [{ x, label }], guides [{ label, x, y }], y_step (ticks at its multiples), notes [{ x, y, text }], link, equal (one scale for both axes), height,
// on_point(series, i): a point was clicked; on_grab(at, event): what takes a drag that begins there, { move(at, event), end() },
// or null; on_double(at), on_key(event): return true for what they have handled.
export class Chart {
  constructor(options) {
    this.series = options.series ?? [];
    this.marks = options.marks ?? [];
    this.guides = options.guides ?? [];
    this.notes = options.notes ?? [];
    this.x_log = options.x_log ?? false;
    this.y_log = options.y_log ?? false;
    this.equal = options.equal ?? false;
    this.height = options.height ?? 280;
    this.title = options.title;
    this.x_label = options.x_label;
    this.y_label = options.y_label;
    this.y_step = options.y_step;
    this.on_point = options.on_point;
    this.on_grab = options.on_grab;
    this.on_double = options.on_double;
    this.on_key = options.on_key;
    this.link = options.link ?? new Link();
    this.link.charts.push(this);
    this.hidden = new Set();
    this.y_window = null;
    this.canvas = el("canvas", { class: "curves" });
    this.overlay = el("canvas", { class: "overlay", tabindex: "0", role: "img", "aria-label": options.title ?? options.y_label });
    this.tip = el("div", { class: "tip", hidden: true });
    this.legend = el("div", { class: "legend" });
    this.stage = el("div", { class: "stage" }, this.canvas, this.overlay, this.tip);
    this.element = el("div", { class: "chart" }, options.title ? el("h4", {}, options.title) : "", this.legend, this.stage);
    this.make_legend();
    this.listen();
    on_theme(() => this.element.isConnected && this.draw());
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.stage);
    // Charts off the screen wait until they come near. Several changes may arrive in one batch: the last one counts.
    this.is_near = true;
    new IntersectionObserver((entries) => {
      this.is_near = entries[entries.length - 1].isIntersecting;
      if (this.is_near && this.is_late) this.draw();
    }, { rootMargin: "300px" }).observe(this.stage);
  }

  set_series(series) {
    this.series = series;
    this.hidden.clear();
    this.make_legend();
    this.draw();
  }

  make_legend() {
    this.values = [];
    this.legend.replaceChildren();
    this.series.forEach((s, i) => {
      const value = el("span", { class: "value" });
      const entry = el("button", { type: "button", "aria-pressed": "true", title: "Show or hide" }, el("canvas", { width: 28, height: 10 }), " " + write_powers(s.name ?? ""), value);
      entry.addEventListener("click", () => {
        if (!this.hidden.delete(i)) this.hidden.add(i);
        this.show_hidden();
      });
      this.values.push(value);
      this.legend.append(entry);
    });
    this.legend.append(make_button("PNG", "Save this picture", () => this.save()));
  }

  // What `hidden` holds, in the legend and in the picture.
  show_hidden() {
    this.legend.querySelectorAll("button[aria-pressed]").forEach((entry, i) => entry.setAttribute("aria-pressed", String(!this.hidden.has(i))));
    this.draw();
  }

  // x and y in the coordinates of the axes: logarithms where these are.
  to_x(v) {
    return this.x_log ? Math.log10(v) : v;
  }
  to_y(v) {
    return this.y_log ? Math.log10(Math.abs(v)) : v;
  }
  get_visible() {
    return this.series.map((s, i) => ({ ...s, index: i })).filter((s) => !this.hidden.has(s.index));
  }

  calc_ranges() {
    const visible = this.get_visible();
    let [x0, x1] = [Infinity, -Infinity];
    for (const s of visible) {
      const ends = s.points || this.x_log ? s.x : [s.x[0], s.x[s.x.length - 1]];
      for (const v of ends) {
        const x = this.to_x(v);
        if (!Number.isFinite(x)) continue;
        x0 = Math.min(x0, x);
        x1 = Math.max(x1, x);
      }
    }
    if (this.equal && this.guides.length > 0) [x0, x1] = [Math.min(x0, -1), Math.max(x1, 1)];  // the unit circle
    if (!(x0 <= x1)) [x0, x1] = [0, 1];
    const has_points = visible.some((s) => s.points) && visible.every((s) => s.points);
    if (x0 === x1 || has_points) {
      const pad = 0.05 * (x1 - x0) || 0.1 * Math.abs(x0) || 1;
      [x0, x1] = [x0 - pad, x1 + pad];
    }
    if (this.link.window) [x0, x1] = this.link.window;
    let [y0, y1] = [Infinity, -Infinity];
    for (const s of visible) {
      const [from, to] = s.points ? [0, s.x.length] : this.find_range(s, x0, x1);
      for (let i = from; i < to; ++i) {
        if (s.points && this.link.window && (this.to_x(s.x[i]) < x0 || this.to_x(s.x[i]) > x1)) continue;
        const y = this.to_y(s.y[i]);
        if (y < y0 && y > -Infinity) y0 = y;
        if (y > y1 && y < Infinity) y1 = y;
      }
    }
    if (this.equal && this.guides.length > 0) [y0, y1] = [Math.min(y0, -1), Math.max(y1, 1)];
    if (!(y0 <= y1)) [y0, y1] = [0, 1];
    if (this.y_log) y0 = Math.max(y0, y1 - 12);
    const pad = 0.05 * (y1 - y0) || 0.1 * Math.abs(y0) || 1;
    [y0, y1] = this.y_window ?? [y0 - pad, y1 + pad];
    return { x0, x1, y0, y1 };
  }

  // Samples of a curve in the window, and one to each side.
  find_range(s, x0, x1) {
    const low = this.x_log ? 10 ** x0 : x0, high = this.x_log ? 10 ** x1 : x1;
    return [Math.max(0, find_index(s.x, low) - 1), Math.min(s.x.length, find_index(s.x, high) + 1)];
  }

  draw() {
    this.is_late = !this.is_near && !is_printing;
    if (this.is_late) return;
    const width = is_printing ? kPaperWidth : this.stage.clientWidth;
    if (width < 50) return;
    const scale = devicePixelRatio || 1;
    for (const canvas of [this.canvas, this.overlay]) {
      if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(this.height * scale)) {
        canvas.width = Math.round(width * scale);
        canvas.height = Math.round(this.height * scale);
        canvas.style.width = width + "px";
        canvas.style.height = this.height + "px";
      }
    }
    if (this.stage.clientHeight !== this.height) this.stage.style.height = this.height + "px";
    const frame = { left: kMargin.left, top: kMargin.top, width: width - kMargin.left - kMargin.right, height: this.height - kMargin.top - kMargin.bottom };
    this.frame = frame;
    this.range = this.calc_ranges();
    if (this.equal && !this.y_window && !this.link.window) this.equalize();
    const g = this.canvas.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, width, this.height);
    const labels = this.place_mark_labels(g), room = labels.length > 0 ? kMarkRow * (1 + Math.max(...labels.map(([, , row]) => row))) : 0;
    frame.top += room;
    frame.height -= room;
    this.draw_axes(g);
    g.save();
    g.beginPath();
    g.rect(frame.left, frame.top, frame.width, frame.height);
    g.clip();
    this.draw_marks(g);
    this.draw_guides(g);
    for (const s of this.get_visible()) s.points ? this.draw_points(g, s) : this.draw_curve(g, s);
    g.restore();
    this.write_marks(g, labels);
    this.draw_legend_strokes();
  }

  equalize() {
    const r = this.range, f = this.frame;
    const unit = Math.max((r.x1 - r.x0) / f.width, (r.y1 - r.y0) / f.height);
    const grow = (low, high, pixels) => [(low + high - unit * pixels) / 2, (low + high + unit * pixels) / 2];
    [r.x0, r.x1] = grow(r.x0, r.x1, f.width);
    [r.y0, r.y1] = grow(r.y0, r.y1, f.height);
  }

  map_x(x) {
    return this.frame.left + ((x - this.range.x0) / (this.range.x1 - this.range.x0)) * this.frame.width;
  }
  map_y(y) {
    return this.frame.top + ((this.range.y1 - y) / (this.range.y1 - this.range.y0)) * this.frame.height;
  }

  draw_axes(g) {
    const { frame: f, range: r } = this;
    const text = get_css("--text"), grid = get_css("--grid");
    const xs = (this.x_log ? make_log_ticks : make_ticks)(r.x0, r.x1, Math.max(3, f.width / 90));
    const ys = this.y_step ? make_step_ticks(r.y0, r.y1, Math.max(3, f.height / 30), this.y_step) : (this.y_log ? make_log_ticks : make_ticks)(r.y0, r.y1, Math.max(3, f.height / 45));
    g.font = "12px " + get_css("--font");
    g.lineWidth = 1;
    g.strokeStyle = grid;
    g.fillStyle = text;
    g.textAlign = "center";
    for (const t of xs) {
      const x = Math.round(this.map_x(t.value)) + 0.5;
      g.beginPath();
      g.moveTo(x, f.top);
      g.lineTo(x, f.top + f.height);
      g.stroke();
      g.fillText(t.label, x, f.top + f.height + 16);
    }
    g.textAlign = "right";
    for (const t of ys) {
      const y = Math.round(this.map_y(t.value)) + 0.5;
      g.beginPath();
      g.moveTo(f.left, y);
      g.lineTo(f.left + f.width, y);
      g.stroke();
      g.fillText(t.label, f.left - 6, y + 4);
    }
    g.strokeStyle = get_css("--line");
    if (!this.y_log && r.y0 < 0 && r.y1 > 0) {
      g.beginPath();
      g.moveTo(f.left, this.map_y(0));
      g.lineTo(f.left + f.width, this.map_y(0));
      g.stroke();
    }
    g.strokeRect(f.left + 0.5, f.top + 0.5, f.width, f.height);
    g.textAlign = "center";
    g.fillText(write_powers(this.x_label ?? ""), f.left + f.width / 2, f.top + f.height + 35);
    g.save();
    // The whole height of the picture is its room, and its middle that of the frame if it can be.
    const label = write_powers(this.y_label ?? ""), half = Math.min(this.height - 8, g.measureText(label).width) / 2 + 4;
    g.translate(13, Math.min(Math.max(f.top + f.height / 2, half), this.height - half));
    g.rotate(-Math.PI / 2);
    g.fillText(label, 0, 0, this.height - 8);
    g.restore();
  }

  draw_marks(g) {
    g.save();
    g.strokeStyle = get_css("--mark");
    g.setLineDash([3, 3]);
    for (const x of this.find_marks().map(({ x }) => x)) {
      g.beginPath();
      g.moveTo(x, this.frame.top);
      g.lineTo(x, this.frame.top + this.frame.height);
      g.stroke();
    }
    g.restore();
  }

  // Marks in the frame and where they are in it.
  find_marks() {
    const { left, width } = this.frame;
    return this.marks.map(({ x, label }) => ({ x: this.map_x(this.to_x(x)), label })).filter(({ x }) => x >= left && x <= left + width);
  }

  /**
   * Places the labels of the marks in rows above the frame, where they hide no curve: [text, x, row]. A text without
   * room is shortened, and left out below six letters.
   * @param {CanvasRenderingContext2D} g  @returns {[string, number, number][]}
   */
  place_mark_labels(g) {
    g.font = "11px " + get_css("--font");
    const free = new Array(kMaxMarkRows).fill(this.frame.left), end = this.frame.left + this.frame.width, placed = [];
    const marks = this.find_marks();
    for (const [k, { x, label }] of marks.entries()) {
      const next = marks.slice(k + 1).find((m) => m.x > x)?.x ?? end;
      const whole = fit_text(g, label, Math.max(kMaxMarkWidth, next - x - 9)), size = g.measureText(whole).width;
      const take = (text, at, row) => {
        placed.push([text, at, row]);
        free[row] = at + g.measureText(text).width + 6;
      };
      const row = free.findIndex((from) => x >= from && x + 3 + size <= end);
      if (row >= 0) take(whole, x + 3, row);
      else {
        // Near the right end it stands before its line.
        const before = free.findIndex((from) => x - 3 - size >= from && x + 3 + size > end);
        const short = free.findIndex((from) => x >= from), text = short >= 0 ? fit_text(g, label, end - x - 3) : "";
        if (before >= 0) take(whole, x - 3 - size, before);
        else if (text.length > 6) take(text, x + 3, short);
      }
    }
    return placed;
  }

  write_marks(g, labels) {
    g.save();
    g.fillStyle = get_css("--mark");
    g.font = "11px " + get_css("--font");
    g.textAlign = "left";
    for (const [text, x, row] of labels) g.fillText(text, x, this.frame.top - 4 - kMarkRow * row);
    g.restore();
  }

  /**
   * Writes a text next to a point, on either side, above or below, where the frame does not cut it and no other text of
   * `boxes` is; up to `lines` lines away. Returns false without room.
   * @param {CanvasRenderingContext2D} g  @param {number[][]} boxes  @param {string} text  @param {number[]} at
   */
  place_text(g, boxes, text, [x, y], gap, size, lines = 1) {
    const { left, top, width, height } = this.frame, long = g.measureText(text).width;
    const steps = Array.from({ length: lines }, (_, k) => 1.1 * size * k).flatMap((more) => [gap + 0.65 * size + more, -gap - more]);
    for (const dy of steps)
      for (const dx of [gap, -gap - long]) {
        const box = [x + dx - 2, y + dy - size, x + dx + long + 2, y + dy + 0.3 * size];
        if (box[0] < left || box[1] < top || box[2] > left + width || box[3] > top + height) continue;
        if (boxes.some((b) => box[0] < b[2] && b[0] < box[2] && box[1] < b[3] && b[1] < box[3])) continue;
        boxes.push(box);
        g.fillText(text, x + dx, y + dy);
        return true;
      }
    return false;
  }

  // Thin lines behind the curves, each with its label where it leaves the frame or where else it has room, and counts
  // next to points.
  draw_guides(g) {
    const { left, top, width, height } = this.frame;
    // No text covers a mark.
    const boxes = this.series.flatMap((s, k) => (s.points && !this.hidden.has(k) && s.x.length < 500 ? Array.from(s.x, (x, i) => [this.map_x(this.to_x(x)), this.map_y(this.to_y(s.y[i]))]) : []))
      .map(([x, y]) => [x - 5, y - 5, x + 5, y + 5]);
    g.save();
    g.lineWidth = 1;
    g.textAlign = "left";
    g.font = "12px " + get_css("--font");
    g.fillStyle = get_css("--text");
    for (const note of this.notes) {
      const at = [this.map_x(note.x), this.map_y(note.y)];
      if (!this.place_text(g, boxes, note.text, at, 8, 12, 4)) g.fillText(note.text, at[0] + 9, at[1] - 8);
    }
    g.font = "11px " + get_css("--font");
    g.strokeStyle = get_css("--line");
    g.fillStyle = get_css("--soft");
    const is_inside = (p) => p[0] >= left && p[0] <= left + width && p[1] >= top && p[1] <= top + height;
    for (const guide of this.guides) {
      const points = Array.from(guide.x, (x, i) => [this.map_x(this.to_x(x)), this.map_y(this.to_y(guide.y[i]))]);
      g.beginPath();
      points.forEach(([x, y], i) => (i === 0 ? g.moveTo(x, y) : g.lineTo(x, y)));
      g.stroke();
      if (!guide.label) continue;
      let places = points.filter(is_inside), best = points.filter((p, i) => 2 * i <= points.length && is_inside(p)).length - 1;
      // A ray leaves the frame at the first side that it meets.
      if (points.length === 2) {
        const [from, to] = points;
        const share = Math.min(to[0] < left ? (from[0] - left) / (from[0] - to[0]) : 1, to[1] < top ? (from[1] - top) / (from[1] - to[1]) : 1);
        places = share > 0 ? [1, 0.9, 0.8, 0.7, 0.6].map((s) => [0, 1].map((c) => from[c] + s * share * (to[c] - from[c]))) : [];
        best = 0;
      }
      for (let k = 0; k < places.length; ++k) {
        const at = places[points.length === 2 ? k : (Math.max(0, best) + places.length - k) % places.length];
        if (this.place_text(g, boxes, guide.label, at, 4, 11)) break;
      }
    }
    g.restore();
  }

  // Of more samples than pixels the least and the largest of each column are joined: peaks stay.
  draw_curve(g, s) {
    const style = get_style(s.style ?? s.index);
    g.strokeStyle = style.color;
    g.setLineDash(style.dash);
    g.lineWidth = 1.6;
    g.lineJoin = "round";
    g.beginPath();
    const [from, to] = this.find_range(s, this.range.x0, this.range.x1);
    let is_down = false;
    const put = (x, y) => {
      if (!Number.isFinite(y)) is_down = false;
      else if (is_down) g.lineTo(x, y);
      else {
        g.moveTo(x, y);
        is_down = true;
      }
    };
    if (to - from <= 3 * this.frame.width) {
      for (let i = from; i < to; ++i) put(this.map_x(this.to_x(s.x[i])), this.map_y(this.to_y(s.y[i])));
    } else {
      const y = s.y;
      let i = from;
      while (i < to) {
        const column = Math.floor(this.map_x(this.to_x(s.x[i])));
        const next = this.unmap_x(column + 1);
        const end = Math.min(to, Math.max(i + 1, find_index(s.x, this.x_log ? 10 ** next : next)));
        let low = i, high = i, first = -1, last = -1;
        for (; i < end; ++i) {
          const v = y[i];
          if (!Number.isFinite(v)) continue;
          if (first < 0) first = low = high = i;
          last = i;
          if (v < y[low]) low = i;
          if (v > y[high]) high = i;
        }
        if (first < 0) {
          is_down = false;
          continue;
        }
        // On a logarithmic axis of what changes its sign the least size may be lost, never the largest.
        for (const k of y[low] < y[high] ? [first, low, high, last] : [first]) put(column, this.map_y(this.to_y(y[k])));
      }
    }
    g.stroke();
    g.setLineDash([]);
  }

  draw_points(g, s) {
    const style = get_style(s.style ?? s.index);
    g.strokeStyle = style.color;
    g.lineWidth = 1.8;
    for (let i = 0; i < s.x.length; ++i) {
      const x = this.map_x(this.to_x(s.x[i])), y = this.map_y(this.to_y(s.y[i]));
      if (!Number.isFinite(x + y)) continue;
      stroke_mark(g, s.points, x, y, 4);
    }
  }

  draw_legend_strokes() {
    this.legend.querySelectorAll("canvas").forEach((canvas, i) => {
      const g = canvas.getContext("2d"), style = get_style(this.series[i].style ?? i);
      g.clearRect(0, 0, 28, 10);
      g.strokeStyle = style.color;
      g.lineWidth = 2;
      g.setLineDash(style.dash);
      if (this.series[i].points) return stroke_mark(g, this.series[i].points, 14, 5, 3.5);
      g.beginPath();
      g.moveTo(0, 5);
      g.lineTo(28, 5);
      g.stroke();
    });
  }

  // x in units of the axis's quantity; null: none.
  draw_cursor(x, is_mine) {
    const scale = devicePixelRatio || 1;
    const g = this.overlay.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, this.overlay.width, this.overlay.height);
    if (!this.frame || x === null || this.series.every((s) => s.points)) return;
    const px = this.map_x(this.to_x(x));
    if (px < this.frame.left || px > this.frame.left + this.frame.width) return;
    g.strokeStyle = get_css("--text");
    g.lineWidth = 1;
    g.beginPath();
    g.moveTo(px, this.frame.top);
    g.lineTo(px, this.frame.top + this.frame.height);
    g.stroke();
    for (const s of this.get_visible()) {
      if (s.x.length === 0 || s.points) continue;
      const i = find_nearest(s.x, x);
      this.values[s.index].textContent = " " + format_number(s.y[i], 5);
      g.fillStyle = get_style(s.style ?? s.index).color;
      g.beginPath();
      g.arc(this.map_x(this.to_x(s.x[i])), this.map_y(this.to_y(s.y[i])), 3, 0, 2 * Math.PI);
      g.fill();
    }
    if (is_mine) {
      g.fillStyle = get_css("--text");
      g.font = "12px " + get_css("--font");
      g.textAlign = px > this.frame.left + this.frame.width - 90 ? "right" : "left";
      g.fillText(format_number(x), px + (g.textAlign === "left" ? 5 : -5), this.frame.top + this.frame.height - 6);
    }
  }

  draw_box(a, b) {
    this.draw_cursor(null);
    const g = this.overlay.getContext("2d");
    g.fillStyle = get_css("--select");
    const is_band = Math.abs(a.y - b.y) < 20;
    g.fillRect(Math.min(a.x, b.x), is_band ? this.frame.top : Math.min(a.y, b.y), Math.abs(a.x - b.x), is_band ? this.frame.height : Math.abs(a.y - b.y));
  }

  unmap_x(px) {
    return this.range.x0 + ((px - this.frame.left) / this.frame.width) * (this.range.x1 - this.range.x0);
  }
  unmap_y(py) {
    return this.range.y1 - ((py - this.frame.top) / this.frame.height) * (this.range.y1 - this.range.y0);
  }

  listen() {
    const place = (event) => {
      const box = this.overlay.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    let start = null, grabbed = null;
    this.overlay.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !this.frame) return;
      grabbed = this.on_grab?.(place(event), event) ?? null;
      if (!grabbed) start = place(event);
      this.overlay.setPointerCapture(event.pointerId);
    });
    this.overlay.addEventListener("pointermove", (event) => {
      const at = place(event);
      if (!this.frame) return;
      if (grabbed) return grabbed.move(at, event);
      if (start && Math.abs(at.x - start.x) > 4) return this.draw_box(start, at);
      const x = this.unmap_x(at.x);
      this.link.set_cursor(this.x_log ? 10 ** x : x, this);
      this.show_tip(at);
    });
    this.overlay.addEventListener("pointerup", (event) => {
      const at = place(event), from = start;
      start = null;
      grabbed?.end();
      grabbed = null;
      if (!from) return;
      if (Math.abs(at.x - from.x) < 5) {
        const x = this.unmap_x(at.x), point = this.find_point(at);
        if (point && this.on_point) return this.on_point(point.series, point.i);
        return this.link.pick(this.x_log ? 10 ** x : x);
      }
      if (Math.abs(at.y - from.y) >= 20) this.y_window = [this.unmap_y(Math.max(at.y, from.y)), this.unmap_y(Math.min(at.y, from.y))];
      this.link.set_window([this.unmap_x(Math.min(at.x, from.x)), this.unmap_x(Math.max(at.x, from.x))]);
      // The box has done its work, and the cursors of before stand elsewhere now.
      this.link.set_cursor(null, this);
    });
    this.overlay.addEventListener("pointercancel", () => {
      start = null;
      grabbed?.end();
      grabbed = null;
      this.draw_cursor(null);
    });
    this.overlay.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
      if (!start) this.link.set_cursor(null, this);
    });
    this.overlay.addEventListener("dblclick", (event) => this.on_double?.(place(event)) || this.reset());
    this.overlay.addEventListener("keydown", (event) => {
      if (this.on_key?.(event)) return event.preventDefault();
      const act = { "+": () => this.zoom(0.5), "-": () => this.zoom(2), 0: () => this.reset(), ArrowLeft: () => this.shift(-0.2), ArrowRight: () => this.shift(0.2) }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    });
  }

  zoom(factor) {
    const middle = (this.range.x0 + this.range.x1) / 2, half = (factor * (this.range.x1 - this.range.x0)) / 2;
    this.link.set_window([middle - half, middle + half]);
  }
  shift(share) {
    const by = share * (this.range.x1 - this.range.x0);
    this.link.set_window([this.range.x0 + by, this.range.x1 + by]);
  }
  reset() {
    for (const chart of this.link.charts) chart.y_window = null;
    this.link.set_window(null);
  }

  // The nearest point with a tip, within 12 pixels.
  find_point(at) {
    let best = 12, found = null;
    for (const s of this.get_visible()) {
      if (!s.points || !s.tip) continue;
      for (let i = 0; i < s.x.length; ++i) {
        const distance = Math.hypot(this.map_x(this.to_x(s.x[i])) - at.x, this.map_y(this.to_y(s.y[i])) - at.y);
        if (distance < best) [best, found] = [distance, { series: s, i }];
      }
    }
    return found;
  }

  // Of points: what the nearest one is.
  show_tip(at) {
    const found = this.find_point(at), text = found ? found.series.tip(found.i) : "";
    this.tip.hidden = text === "";
    this.tip.textContent = text;
    this.tip.style.left = Math.min(at.x + 12, this.stage.clientWidth - 200) + "px";
    this.tip.style.top = at.y + 12 + "px";
  }

  // The picture with its title and legend, named after its content.
  save() {
    const scale = devicePixelRatio || 1, width = this.canvas.width / scale, font = get_css("--font");
    const title = this.title || this.y_label || "";
    const entries = this.get_visible().filter((s) => s.name);
    const sheet = el("canvas"), g = sheet.getContext("2d");
    g.font = "12px " + font;
    const rows = [[]];
    let x = 10;
    for (const s of entries) {
      const size = 34 + g.measureText(s.name).width + 18;
      if (x + size > width && rows[rows.length - 1].length > 0) {
        rows.push([]);
        x = 10;
      }
      rows[rows.length - 1].push([s, x]);
      x += size;
    }
    const head = 26 + (entries.length > 0 ? 20 * rows.length : 0);
    sheet.width = this.canvas.width;
    sheet.height = this.canvas.height + Math.round(head * scale);
    g.fillStyle = get_css("--back");
    g.fillRect(0, 0, sheet.width, sheet.height);
    g.drawImage(this.canvas, 0, Math.round(head * scale));
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.fillStyle = get_css("--text");
    g.font = "600 14px " + font;
    g.fillText(title, 10, 18);
    g.font = "12px " + font;
    rows.forEach((row, k) => row.forEach(([s, at]) => {
      const style = get_style(s.style ?? s.index), y = 36 + 20 * k;
      g.strokeStyle = style.color;
      g.lineWidth = 2;
      g.setLineDash(s.points ? [] : style.dash);
      if (s.points) stroke_mark(g, s.points, at + 14, y - 4, 3.5);
      else {
        g.beginPath();
        g.moveTo(at, y - 4);
        g.lineTo(at + 28, y - 4);
        g.stroke();
      }
      g.setLineDash([]);
      g.fillText(s.name, at + 34, y);
    }));
    sheet.toBlob((blob) => save_blob(blob, make_file_name(title || "chart", "png")));
  }
}
