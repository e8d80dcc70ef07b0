import { Chart } from "./chart.js";
import { Box, Drawing, find_extremes, kBarNote } from "./drawing.js";
import { label_time, with_unit } from "./history.js";
import { find_index, format_number } from "./numbers.js";
import { el, get_css, get_style, make_button, make_check, make_color_bar, make_select, make_slider, make_swatch, save_blob } from "./page_parts.js";
import { SceneMarks, to_rotation, turn } from "./scene_marks.js";
import { Viewer, make_triad } from "./viewer.js";

const find_channels = (run, name) => Object.fromEntries(["position", "quaternion", "eta"].map((key) => [key, run.by_path.get(`/bodies/${name}/${key}`)]));

const kAxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const kFrameSize = 0.1, kBodyFrameSize = 0.06;  // of the scene: length of the axes of the inertial frame, of a body's

// Points of a body in the world, deformed.
function move_points(body, { p, R, eta }, scale) {
  const d = body.drawing;
  d.deform(eta, scale);
  body.world ??= new Float32Array(d.points.length);
  for (let i = 0; i < d.points.length; i += 3)
    for (let r = 0; r < 3; ++r) body.world[i + r] = p[r] + R[r][0] * d.points[i] + R[r][1] * d.points[i + 1] + R[r][2] * d.points[i + 2];
}

// The moving system of a run. A viewer that is given keeps its place on the page; an earlier run is drawn as outlines.
export class MotionView {
  constructor(run, viewer = null, earlier = null) {
    this.run = run;
    this.bodies = run.data.bodies
      .map((b) => ({ name: b.name, drawing: new Drawing(b.drawing), ...find_channels(run, b.name) }))
      .map((b, index) => ({ ...b, index, is_drawn: Boolean(b.position && b.quaternion) }));
    const moving = this.bodies.filter((b) => b.is_drawn);
    this.first = run.time[0];
    this.last = run.time[run.time.length - 1];
    this.time = this.first;
    this.earlier = earlier;
    this.ghosts = (earlier?.data.bodies ?? []).map((b) => ({ name: b.name, drawing: new Drawing(b.drawing), ...find_channels(earlier, b.name) })).filter((b) => b.position && b.quaternion);
    this.has_ghosts = true;
    this.scale = 1;
    this.follow = -1;
    this.has_frames = true;
    this.color_by = 0;
    this.is_playing = false;
    this.is_looping = false;  // starts again at the end
    /** Marks interface nodes, and nodes that no element draws: a click takes them, through faces too. */
    this.has_node_marks = false;
    /** More things before all others, of places of bodies and the size of the scene. @type {((places: any[], size: number) => any[]) | null} */
    this.make_overlay = null;
    /** Ways in the world by index of the body, for bodies that are drawn elsewhere. @type {Map<number, number[]>} */
    this.shifts = new Map();
    this.marks = new SceneMarks(this);
    this.viewer = viewer ?? new Viewer("clamp(320px, calc(100vh - 27rem), 900px)");
    this.scrubber = el("input", { type: "range", class: "scrub", min: 0, max: 1000, step: 1, value: 0, "aria-label": "time" });
    this.scrubber.addEventListener("input", () => this.set_time(this.first + (this.scrubber.value / 1000) * (this.last - this.first)));
    this.clock = el("output", { class: "clock" });
    this.play_button = make_button("▶ play", "Play or pause", () => this.play(!this.is_playing));
    this.play_button.classList.add("play");
    const tools = el("div", { class: "tools" }, this.play_button,
      make_slider("plays in", { min: 0.5, max: 2.3, step: 0.05, value: 1.1 }, (v) => { this.seconds = 10 ** v; return format_number(10 ** v, 2) + " s"; }),
      make_slider("deformation ×", { min: 0, max: 3, step: 0.05, value: 0 }, (v) => { this.scale = 10 ** v; this.draw(); return format_number(10 ** v, 3); }),
      make_select("follow", ["nothing", ...moving.map((b) => b.name)], (i) => { this.follow = i === 0 ? -1 : moving[i - 1].index; this.anchor(); }),
      ...this.marks.make_tools(),
      ...(this.ghosts.length > 0 ? [make_check("run before", true, (on) => { this.has_ghosts = on; this.draw(); })] : []),
      make_check("frames", true, (on) => { this.has_frames = on; this.draw(); }),
      make_select("colour by", ["body", "displacement", ...(moving.some((b) => b.drawing.matrix) ? ["strain energy", "strain energy density"] : [])], (i) => { this.color_by = i; this.set_colors(); }), this.viewer.make_view_buttons());
    if (globalThis.MediaRecorder) tools.append(make_button("WebM", "Play once from the start and save it as a film", () => this.film()));
    const names = el("p", { class: "note legend" }, ...moving.map((b) => el("span", { class: "entry" }, make_swatch(b.index), " " + b.name)));
    this.color_note = el("p", { class: "note" });
    this.bar = make_color_bar();
    this.bar.element.hidden = true;
    this.viewer.name = "motion";
    this.viewer.repaint = () => this.draw();
    /** Called with the node that was clicked, or null. @type {((found: any) => void) | null} */
    this.on_pick = null;
    this.pins = new Map();  // "body node" -> [body, node] of a chart
    this.pin_button = Object.assign(make_button("", "Its displacement, linear in the modes as the scene is, in a chart that goes with the other curves", () => this.picked && this.pin(this.picked.body, this.picked.node)), { className: "pin", hidden: true });
    this.viewer.on_pick = (found) => {
      this.offer_pin(found?.thing.body ? { body: found.thing.body, node: found.id } : null);
      this.on_pick?.(found);
    };
    this.pin_host = el("div", { class: "pins" });
    const help = el("p", { class: "note" }, "Black (white in the dark): hinges and their axes. Frames: orange x, green y, blue z. A click in a chart takes this view there; a click in this view names a node." + (moving.some((b) => b.drawing.has_bars()) ? kBarNote : ""));
    this.element = el("div", { class: "motion" }, tools, this.viewer.element, el("div", { class: "tools" }, this.scrubber, this.clock, this.pin_button), this.pin_host, this.bar.element, this.color_note, names, this.marks.legend, this.marks.now, help);
    run.link.on("pick", (time) => { this.play(false); this.set_time(time); });
    this.reach = this.find_reach();
    const box = this.find_box();
    this.viewer.face(box);
    this.viewer.fit(box);
    this.set_time(this.first);
  }

  // A channel of several columns between its samples.
  sample(channel, time, run = this.run) {
    const x = run.get_time(channel);
    const i = Math.min(Math.max(1, find_index(x, time)), x.length - 1);
    const share = x.length > 1 ? Math.min(1, Math.max(0, (time - x[i - 1]) / (x[i] - x[i - 1]))) : 0;
    return channel.columns.map((_, c) => {
      const y = run.get_values(channel, c);
      return x.length > 1 ? y[i - 1] + share * (y[i] - y[i - 1]) : y[0];
    });
  }

  place(body, time, run = this.run) {
    return { p: this.sample(body.position, time, run), R: to_rotation(this.sample(body.quaternion, time, run)), eta: body.eta ? this.sample(body.eta, time, run) : [] };
  }

  offer_pin(picked) {
    this.picked = picked;
    this.pin_button.hidden = !picked;
    if (picked) this.pin_button.textContent = `pin node ${picked.node} of ${picked.body}`;
  }

  // Takes over the clicked node and the charts of another run in the same viewer.
  take_over({ picked, pins }) {
    for (const [name, node] of pins.values()) this.pin(name, node);
    this.viewer.name_node(picked?.node, picked?.body);
    if (this.viewer.picked) this.offer_pin(picked);
  }

  // Displacement of a node since the start of its run, in the world: times, and three columns.
  calc_displacement(body, node, run) {
    const { drawing, position, quaternion, eta } = body, k = drawing.ids.indexOf(node), time = run.get_time(position);
    const columns = [0, 1, 2].map(() => new Float64Array(time.length));
    const shapes = eta ? eta.columns.slice(0, drawing.shapes.length).map((_, j) => drawing.get_shape(j).subarray(3 * k, 3 * k + 3)) : [];
    time.forEach((t, i) => {
      const { p, R, eta: q } = this.place({ position, quaternion, eta }, t, run);
      const r = [0, 1, 2].map((c) => drawing.xyz[3 * k + c] + shapes.reduce((sum, shape, j) => sum + q[j] * shape[c], 0));
      turn(R, r).forEach((v, c) => (columns[c][i] = p[c] + v));
    });
    for (const column of columns) column.forEach((v, i) => i > 0 && (column[i] = v - column[0]));
    for (const column of columns) column[0] = 0;
    return { time, columns };
  }

  // A chart of the displacement of a node, of the earlier run too (dashed).
  pin(name, node) {
    const key = `${name} ${node}`, body = this.bodies.find((b) => b.name === name && b.is_drawn);
    if (this.pins.has(key) || !body || !body.drawing.ids.includes(node)) return;
    const list = (of, run, suffix, style) => {
      const { time, columns } = this.calc_displacement(of, node, run);
      return columns.map((y, c) => ({ name: "xyz"[c] + suffix, x: time, y, style: c + style }));
    };
    const ghost = this.ghosts.find((b) => b.name === name && b.drawing.ids.includes(node));
    const series = [...list(body, this.run, "", 0), ...(ghost ? list(ghost, this.earlier, ", run before", 7) : [])];
    const chart = new Chart({ title: `displacement of node ${node} of ${name}`, series, marks: this.run.marks, link: this.run.link, x_label: label_time(this.run), y_label: with_unit("displacement", body.position.columns[0].unit || body.position.unit), height: 220 });
    const element = el("div", { class: "pinned", "data-node": key }, make_button("✕ unpin", "Take the chart away", () => {
      this.pins.delete(key);
      this.run.link.charts.splice(this.run.link.charts.indexOf(chart), 1);
      element.remove();
    }), chart.element);
    this.pins.set(key, [name, node]);
    this.pin_host.append(element);
  }

  // Positions of the bodies now; null where it is not drawn.
  get_places() {
    return this.bodies.map((b) => {
      if (!b.is_drawn) return null;
      const at = this.place(b, this.time), shift = this.shifts.get(b.index);
      return shift ? { ...at, p: at.p.map((v, i) => v + shift[i]) } : at;
    });
  }

  *list_times(count) {
    for (let k = 0; k < count; ++k) yield this.first + (k / (count - 1)) * (this.last - this.first);
  }

  find_box() {
    const box = new Box(), hull = [];
    for (const body of this.bodies.filter((b) => b.is_drawn)) {
      const { xyz } = body.drawing, ends = find_extremes(xyz);
      for (const time of this.list_times(40)) {
        const { p, R } = this.place(body, time);
        for (const k of ends) {
          const q = turn(R, [xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]]);
          const at = p.map((v, i) => v + q[i]);
          box.add(...at);
          hull.push(...at);
        }
      }
    }
    hull.push(...this.marks.extend(box));
    hull.push(...this.list_tips(box));
    box.hull = hull.every(Number.isFinite) ? hull : [];
    return box;
  }

  // Ends of arrows and frames, of the sizes that a scene in this box has: they are in the picture too.
  list_tips(box) {
    const size = box.get_diagonal(), tips = [];
    const add_frame = (p, R, length) => [0, 1, 2].forEach((c) => tips.push(...p.map((v, i) => v + length * R[i][c])));
    const middle = box.get_middle();
    if (Math.hypot(...middle) < 1.5 * size) add_frame([0, 0, 0], kAxes, kFrameSize * size);
    const has_arrows = this.marks.sources.length > 0;
    for (const time of this.list_times(40)) {
      const places = this.bodies.map((b) => (b.is_drawn ? this.place(b, time) : null));
      this.bodies.forEach((body, k) => {
        if (!places[k]) return;
        add_frame(places[k].p, places[k].R, kBodyFrameSize * size);
        if (has_arrows) move_points(body, places[k], 1);
      });
      if (has_arrows) tips.push(...this.marks.list_tips(places, time, size));
    }
    return tips;
  }

  // The largest displacement of any point, for the colours.
  find_reach() {
    let most = 0;
    for (const body of this.bodies.filter((b) => b.is_drawn && b.eta)) {
      for (const time of this.list_times(40)) {
        body.drawing.deform(this.sample(body.eta, time), 1);
        for (const s of body.drawing.size) if (s > most) most = s;
      }
    }
    return most;
  }

  // The largest energy of an element in the run, of lines, surfaces and solids: by density each has its own.
  find_most(is_density) {
    const most = [0, 0, 0];
    for (const body of this.bodies.filter((b) => b.is_drawn && b.eta && b.drawing.matrix))
      for (const time of this.list_times(100))
        body.drawing.calc_energies(this.sample(body.eta, time), is_density).forEach((v, k) => {
          const kind = is_density ? body.drawing.elements.kind[k] : 0;
          if (v > most[kind]) most[kind] = v;
        });
    return most;
  }

  set_colors() {
    this.most = this.color_by > 1 ? this.find_most(this.color_by === 3) : null;
    const number = (v) => format_number(v, 4), unit = (path) => {
      const text = this.run.by_path.get(path)?.unit;
      return text && text !== "1" ? ` [${text}]` : "";
    };
    this.bar.element.hidden = this.color_by === 0;
    const moving = this.bodies.find((b) => b.is_drawn);
    if (this.color_by === 1) this.bar.update(0, this.reach, "displacement" + unit(`/bodies/${moving?.name}/position`), number);
    if (this.color_by === 2) this.bar.update(0, this.most[0], "strain energy of each element" + unit("/energy/strain"), number);
    if (this.color_by === 3) this.bar.update(0, 1, "strain energy per length, area or volume, of the largest of the run", (v) => format_number(100 * v, 3) + " %");
    this.color_note.textContent = this.color_by === 3 ? "Lines, surfaces and solids have a largest each." : "";
    this.draw();
  }

  get_levels(drawing, eta) {
    const { kind } = drawing.elements, is_density = this.color_by === 3;
    return drawing.calc_energies(eta, is_density).map((v, k) => v / (this.most[is_density ? kind[k] : 0] || 1));
  }

  // From now on the camera goes with the body.
  anchor() {
    if (this.follow < 0) this.viewer.target = this.viewer.home.get_middle();
    this.before = null;
    this.draw();
  }

  set_time(time) {
    this.time = Math.min(this.last, Math.max(this.first, time));
    const span = this.last - this.first || 1;
    this.scrubber.value = Math.round((1000 * (this.time - this.first)) / span);
    this.clock.textContent = `t = ${format_number(this.time, 5)}${["", "T"].includes(this.run.data.time_unit) ? "" : " " + this.run.data.time_unit}`;
    this.run.link.set_cursor(this.time, this);
    this.draw();
  }

  play(is_on) {
    if (is_on === this.is_playing) return;
    this.is_playing = is_on;
    this.play_button.textContent = is_on ? "❚❚ pause" : "▶ play";
    this.viewer.set_played(is_on && !this.recorder);  // a film has all faces
    if (!is_on) return this.recorder?.stop();
    if (this.time >= this.last) this.time = this.first;
    let before = performance.now();
    const step = (now) => {
      if (!this.is_playing || !this.element.isConnected) return;
      const time = this.time + (Math.min(0.1, (now - before) / 1000) / this.seconds) * (this.last - this.first);
      before = now;
      this.set_time(time);
      if (time >= this.last && this.is_looping) this.time = this.first;
      else if (time >= this.last) return this.play(false);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  // Plays once and saves what the canvas showed. A pause, or a click in a chart, ends the film there.
  film() {
    if (this.recorder) return;
    this.play(false);
    this.set_time(this.first);
    const type = ["video/webm;codecs=vp9", "video/webm"].find((t) => MediaRecorder.isTypeSupported(t));
    const parts = [], recorder = new MediaRecorder(this.viewer.canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 8e6 });
    recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
    recorder.addEventListener("stop", () => {
      this.recorder = null;
      this.saved = new Blob(parts, { type: "video/webm" });
      save_blob(this.saved, "motion.webm");
    });
    this.recorder = recorder;
    recorder.start();
    this.play(true);
  }

  // The bodies of the earlier run at this time, or at its end.
  make_ghosts() {
    if (!this.has_ghosts) return [];
    return this.ghosts.map((body) => {
      move_points(body, this.place(body, this.time, this.earlier), this.scale);
      const { edges, triangles } = body.drawing;
      return { points: body.world, edges, color: get_css("--ghost"), dots: triangles.length === 0 };
    });
  }

  draw() {
    if (!this.viewer?.home || !this.clock) return;
    const size = this.viewer.extent, things = [], boxes = [], nodes = [];
    const places = this.get_places();
    if (this.has_frames) things.push(...make_triad([0, 0, 0], kAxes, kFrameSize * size));
    this.bodies.forEach((body, k) => {
      if (!body.is_drawn) return;
      const { p, R, eta } = places[k], d = body.drawing;
      move_points(body, places[k], this.scale);
      // Boxes of rigid bodies are seen through, after what they may hold.
      const is_box = d.packed.length === 0 && d.triangles.length > 0;
      const colors = this.most && d.matrix && eta.length > 0 ? { elements: d.elements, levels: this.get_levels(d, eta) } : {};
      const marked = this.has_node_marks ? d.find_attachments() : null;
      if (marked && marked.size > 0) nodes.push({ points: Float32Array.from([...marked].flatMap((k) => [...body.world.subarray(3 * k, 3 * k + 3)])), color: get_css("--mark"), dots: true });
      const pick = d.ids.length > 0 ? { body: body.name, ids: d.ids, marked, describe: (k) => d.describe(k, body.name + ", ", `displacement ${format_number(d.size[k] / (this.scale || 1), 4)}`) } : {};
      (is_box ? boxes : things).push({ ...colors, ...pick, alpha: is_box ? 0.4 : 1, points: body.world, size: d.size, triangles: d.triangles, edges: d.edges, lines: d.find_lines(), ghosts: d.ghosts, color: get_style(k).color, by_level: this.color_by === 1 && eta.length > 0, dots: d.triangles.length === 0 });
      if (this.has_frames) things.push(...make_triad(p, [0, 1, 2].map((c) => R.map((row) => row[c])), kBodyFrameSize * size));
    });
    this.viewer.marks = [...nodes, ...this.marks.make_things(places, this.time, size), ...(this.make_overlay?.(places, size) ?? [])];
    if (this.follow >= 0) {
      const p = places[this.follow].p;
      if (this.before) this.viewer.target = this.viewer.target.map((t, i) => t + p[i] - this.before[i]);
      else this.viewer.target = [...p];
      this.before = p;
    }
    this.viewer.things = [...things, ...boxes, ...this.make_ghosts()];
    this.viewer.reach = this.reach * this.scale;
    this.viewer.draw();
  }
}
