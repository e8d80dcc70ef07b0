import { ask, find_job, follow_job, run_job } from "./api.js";
import { make_add_form } from "./add_form.js";
import { make_chapter } from "./chapter_panel.js";
import { ReportChapter } from "./chapter_views.js";
import { Chart } from "./chart.js";
import { DiagramPanels } from "./diagram_view.js";
import { HingeAxes } from "./hinge_axes.js";
import { HingePlaces } from "./hinge_places.js";
import { HistoryView, RunSet, label_time, with_unit } from "./history.js";
import { MotionView } from "./motion_view.js";
import { el, make_button } from "./page_parts.js";
import { FloatingScene, make_progress, show_history } from "./parts.js";
import { PolePanel } from "./pole_panel.js";
import { TextPane } from "./text_view.js";
import { Viewer } from "./viewer.js";

const stem = (file) => file.replace(/\.[^./]+$/, "");
const kMaxEarlier = 3;
const kLiveEvery = 1500;  // ms

/** A system file: text and scene side by side; run, equilibrium, poles. */
export class SystemView {
  constructor(studio, file, read) {
    this.studio = studio;
    this.file = file;
    this.output = this.choose_output();
    this.progress = make_progress();
    this.viewer = new Viewer("100%");
    this.scene = el("div", { class: "scene-host" });
    this.result = el("div", { class: "result" });
    this.picked = el("output", { class: "picked", "aria-live": "polite" });
    this.parameters = el("div", { class: "tools parameters" });
    this.set = new Map();
    /** Runs of this file that were shown, the last one first. @type {any[]} */
    this.earlier = [];
    this.add_form = make_add_form(studio, this);
    this.diagrams = new DiagramPanels(studio, this);
    this.hinge_axes = new HingeAxes(this);
    this.hinge_places = new HingePlaces(this);
    this.pane = new TextPane(studio, file, "system", read, { on_check: (answer) => this.update(answer) });
    const button = (text, title, action, name) => Object.assign(make_button(text, title, action), { className: name });
    this.actions = el("div", { class: "tools actions" }, button("Run", "bough run: time history", () => this.run(), "main run"),
      button("Resume", "bough run --resume: go on where the results file ends, after Stop or a longer duration", () => this.run([["--resume"]]), "resume"),
      button("Equilibrium", "bough equilibrium: rest or steady spin", () => this.solve("equilibrium", "-equilibrium.h5"), "equilibrium"),
      button("Linearize", "bough linearize: poles about the initial state", () => this.solve("linearize", "-linear.h5"), "linearize"),
      button("… at equilibrium", "bough linearize --equilibrium", () => this.solve("linearize", "-linear.h5", [["--equilibrium"]]), "linearize-rest"),
      button("Save as page", "bough report of the run and its bodies: one HTML file", () => this.report(), "save-page"),
      button("Copy commands …", "The lines that do the same in a shell", () => show_history(), "copy"));
    this.element = el("div", { class: "split reverse" }, el("div", { class: "side wide" }, this.add_form.element, this.pane.element), el("div", { class: "work-column" }, this.actions, this.parameters, this.progress.element, this.picked, this.hinge_axes.element, this.hinge_places.element, this.scene, this.diagrams.element, this.result));
    this.floating = new FloatingScene(this.scene, this.viewer.element);
    this.join().then((found) => !found && studio.has(this.output) && this.show_results());
  }

  /** True while a command of this file is followed: another one would wait for it. */
  get is_following() {
    return this.is_busy ?? false;
  }
  set is_following(is_on) {
    this.is_busy = is_on;
    for (const name of ["run", "resume", "equilibrium", "linearize", "linearize-rest"]) this.actions.querySelector(`button.${name}`).disabled = is_on;
  }

  /** Name of the results: that of the system file, unless a body or another kind of file has it. */
  choose_output() {
    const name = stem(this.file) + ".h5", found = this.studio.find(name);
    return found && found.kind !== "bough-results" && found.kind !== "unreadable" ? stem(this.file) + "-run.h5" : name;
  }

  /** After each check without errors: the system at its start. */
  async update(answer) {
    const has_errors = answer.messages.some((m) => m.severity === "error"), names = new Set(answer.parameters?.map((p) => p.name));
    if (!has_errors) for (const name of [...this.set.keys()]) if (!names.has(name)) this.set.delete(name);
    this.show_parameters(answer.parameters);
    this.add_form.update(answer);
    if (answer.tree) this.hinge_places.update(answer.tree);
    this.diagrams.update();
    if (this.is_running || has_errors || this.text_drawn === this.pane.text) return;
    this.bodies = (answer.bodies ?? []).map((path) => this.studio.to_name(path));
    try {
      await this.show_start();
    } catch (error) {
      if (error.messages) this.pane.messages.show(error.messages);
    }
  }

  /** Draws the system of the text at its start. */
  async show_start() {
    const text = this.pane.text;
    const { chapter } = await ask("preview", { file: this.file, text });
    if (text !== this.pane.text) return;  // another text is checked by now
    this.text_drawn = text;
    const run = new ReportChapter(chapter.data).run, list_bodies = (r) => r?.data.bodies.map((b) => b.name).join("\n");
    this.show_scene(run, false, list_bodies(run) === list_bodies(this.motion?.run));
  }

  /** Draws a run in the same viewer, its end while it grows; the camera stays if `is_kept` and there is one. */
  show_scene(run, at_end, is_kept = at_end, earlier = null) {
    const { yaw, pitch, distance, target, home } = this.viewer;
    const before = this.motion;
    before?.play(false);
    this.motion = new MotionView(run, this.viewer, earlier);
    this.mark_nodes();
    if (home && is_kept) Object.assign(this.viewer, { yaw, pitch, distance, target });
    if (at_end) this.motion.set_time(this.motion.last);
    this.attach_tools();
    this.motion.on_pick = (found) => this.pick(found);
    this.scene.replaceChildren(this.motion.element);
    this.viewer.draw();  // on the page: before, the canvas has no size
    if (before) this.motion.take_over(before);
    run.link.on("pick", () => this.floating.show());
    this.scene.dataset.samples = String(run.time.length);
    delete this.scene.dataset.pole;
  }

  /** Interface nodes, and nodes that no element draws, are marked while the form takes a node. */
  mark_nodes() {
    const is_on = this.add_form.takes_nodes();
    if (!this.motion || this.motion.has_node_marks === is_on) return;
    this.motion.has_node_marks = is_on;
    this.motion.draw();
  }

  /** Tools with handles in the scene; the first one that has a handle under the pointer takes a drag. */
  attach_tools() {
    const tools = [this.hinge_axes, this.hinge_places];
    this.motion.make_overlay = (places, size) => tools.flatMap((tool) => tool.make_things(places, size));
    this.viewer.on_grab = (event) => tools.find((tool) => tool.can_grab(event))?.grab(event) ?? null;
    this.viewer.can_grab = (event) => tools.some((tool) => tool.can_grab(event));
    for (const tool of tools) tool.attach(this.motion);
  }

  pick(found) {
    this.picked.textContent = found?.thing.body ? `body ${found.thing.body}, node ${found.id}` : "";
    if (found?.thing.body) this.add_form.take(found.thing.body, found.id);
  }

  show_parameters(parameters) {
    this.parameters.replaceChildren(...(parameters ?? []).map(({ name, value }) => {
      const now = this.set.get(name) ?? value, size = Math.abs(Number(value)) || 0.5;
      const field = el("input", { type: "number", step: "any", value: now, "aria-label": `parameter ${name}` });
      const [low, high] = Number(value) > 0 ? [0, 2 * size] : Number(value) < 0 ? [-2 * size, 0] : [-1, 1];
      const drag = el("input", { type: "range", min: low, max: high, step: (high - low) / 200, value: now, title: "Drag: the poles follow, once there are some", "aria-label": `${name} by dragging` });
      const change = (text) => {
        text === value || text === "" ? this.set.delete(name) : this.set.set(name, text);
        this.poles?.follow();
      };
      field.addEventListener("change", () => {
        drag.value = field.value;
        change(field.value);
      });
      drag.addEventListener("input", () => {
        field.value = String(Number(Number(drag.value).toPrecision(6)));
        change(field.value);
      });
      return el("label", {}, name + " ", field, drag);
    }));
    this.parameters.hidden = this.parameters.childElementCount === 0;
  }

  /** A file as the system file names it: relative to its folder. */
  get_path(name) {
    const here = this.file.split("/").slice(0, -1), there = name.split("/");
    while (here.length > 0 && here[0] === there[0]) {
      here.shift();
      there.shift();
    }
    return "../".repeat(here.length) + there.join("/");
  }

  list_set() {
    return [...this.set].map(([name, value]) => `${name}=${value}`);
  }
  get_set() {
    return this.list_set().map((text) => ["--set", text]);
  }

  run(more = []) {
    return this.studio.attempt(async () => {
      if (this.is_following || !(await this.pane.make_saved())) return;
      this.output = this.choose_output();
      const before = this.studio.find(this.output)?.time;
      await this.watch_run(before, (on_progress) => run_job({ verb: "run", files: [this.file], options: [...more, ...this.get_set(), ["-o", this.output]], before }, on_progress));
    });
  }

  /**
   * Follows a command for this file that runs already: the page was loaded again, or another tab started the command.
   * @returns {Promise<boolean>}  true if there was one
   */
  async join() {
    const found = await this.studio.attempt(() => find_job(this.file, ["run", "equilibrium", "linearize"]), false);
    if (!found || this.is_following) return Boolean(found);
    const { verb, options, before } = found.request, output = options.find(([name]) => name === "-o")[1];
    for (const [name, text] of options) if (name === "--set") this.set.set(text.slice(0, text.indexOf("=")), text.slice(text.indexOf("=") + 1));
    await this.studio.attempt(async () => {
      if (verb !== "run") return this.show_model(verb, output, options, (on_progress) => follow_job(found, on_progress));
      this.output = output;
      return this.watch_run(before, (on_progress) => follow_job(found, on_progress));
    });
    return true;
  }

  /** Follows a run until its results are shown. @param {number | undefined} before  time of its results file at the start */
  async watch_run(before, follow) {
    this.is_following = this.is_running = true;
    this.result.replaceChildren();
    this.shown?.dispose();
    const live = new LiveCharts(this, before);
    try {
      const done = await follow((text, job) => {
        this.progress.update(text, job);
        live.look();
      });
      live.end();
      this.progress.finish(done);
      this.pane.messages.show(done.messages, "The run ended without a message.");
      await this.studio.refresh();
      const found = this.studio.find(this.output);
      if (found) await this.show_results(found.time === before, done.code !== 0);
    } finally {
      this.is_following = this.is_running = false;
      live.end();
    }
  }

  /**
   * Whole results: scene, all panels; the run before stays in a chart of both.
   * @param {boolean} [is_old]  the last run wrote none  @param {boolean} [is_cut]  it was stopped: the scene stays at its end
   */
  async show_results(is_old = false, is_cut = false) {
    await this.studio.attempt(async () => {
      const { chapter } = await ask("chapter", { file: this.output, bodies: this.bodies ?? [] });
      this.shown?.dispose();
      this.poles = null;
      this.shown = make_chapter(chapter, ["system", "motion"]);
      const run = this.shown.data.run;
      this.show_scene(run, is_cut && !is_old, is_cut, is_old ? null : this.earlier[0]);
      this.shown_model = null;
      const note = is_old ? [el("p", { class: "banner", role: "alert" }, "The last run wrote no results. These are the results of a run before.")] : [];
      this.result.replaceChildren(el("h2", {}, this.output), ...note, ...(is_old ? [] : this.make_ghosts(run)), this.shown.element);
      this.result.dataset.ready = is_old ? "old" : "true";
      this.earlier = [run, ...this.earlier].slice(0, kMaxEarlier);
    });
  }

  /** Curves of this run and of those before, in the same charts. */
  make_ghosts(run) {
    if (this.earlier.length === 0) return [];
    const name = (k) => (k === 0 ? "run before" : `${k + 1} runs before`);
    const all = new HistoryView(new RunSet([{ name: "this run", run }, ...this.earlier.map((r, k) => ({ name: name(k), run: r }))]));
    return [el("details", { class: "panel earlier" }, el("summary", {}, `This run and the ${this.earlier.length > 1 ? `${this.earlier.length} runs` : "run"} before`), all.element)];
  }

  solve(verb, ending, options = []) {
    return this.studio.attempt(async () => {
      if (this.is_following || !(await this.pane.make_saved())) return;
      const output = stem(this.file) + ending;
      await this.show_model(verb, output, options, (on_progress) => run_job({ verb, files: [this.file], options: [...options, ...this.get_set(), ["-o", output]] }, on_progress));
    });
  }

  /** Follows a command until its messages, and what it wrote, are shown. */
  async show_model(verb, output, options, follow) {
    this.is_following = true;
    const done = await follow(this.progress.update).finally(() => (this.is_following = false));
    this.progress.finish(done);
    this.pane.messages.show(done.messages, "No messages.");
    await this.studio.refresh();
    if (done.code !== 0) return;
    const { chapter } = await ask("chapter", { file: output, bodies: this.bodies ?? [] });
    this.shown?.dispose();
    this.poles = null;
    this.shown = make_chapter(chapter, [], (name, chart, data) => {
      if (name === "poles") this.poles = new PolePanel(this, chart, data, options.some(([name]) => name === "--equilibrium"));
    });
    this.shown_model = output;
    this.result.replaceChildren(el("h2", {}, output), this.shown.element);
    this.result.dataset.ready = verb;
    this.result.scrollIntoView({ block: "start" });
  }

  report() {
    return this.studio.attempt(async () => {
      const output = stem(this.file) + ".html";
      // What is on the screen: the run, and poles or a state of rest that were computed after it.
      const files = [...(this.studio.has(this.output) ? [this.output] : []), ...(this.shown_model ? [this.shown_model] : [])];
      if (files.length === 0) throw new Error("there are no results yet: run or linearize first");
      const done = await run_job({ verb: "report", files: [...files, ...(this.bodies ?? [])], options: [["-o", output]] }, this.progress.update);
      this.progress.finish(done);
      await this.studio.refresh();
      if (done.code === 0) this.studio.say(`written: ${output}`);
    });
  }

  async notice() {
    await this.pane.notice();
    await this.join();
  }
  is_changed() {
    return this.pane.is_changed();
  }
  dispose() {
    this.is_following = true;  // joins no more
    this.motion?.play(false);
    this.viewer.dispose();
    this.floating.dispose();
    this.shown?.dispose();
  }
}

/** Curves and scene out of the results file while it grows. */
class LiveCharts {
  /** @param {any} view  @param {number | undefined} time_before  last change of the results file before this run */
  constructor(view, time_before) {
    this.view = view;
    this.time_before = time_before;
    this.last = performance.now();
  }
  async look() {
    if (this.is_over || this.is_asking || performance.now() - this.last < kLiveEvery) return;
    this.is_asking = true;
    try {
      const { files } = await ask("list"), found = files.find((f) => f.name === this.view.output);
      if (!found || found.time === this.time_before) return;
      const { chapter } = await ask("chapter", { file: this.view.output, bodies: this.view.bodies ?? [] });
      if (this.is_over || !chapter.data) return;
      const run = new ReportChapter(chapter.data).run;
      if (run.time.length < 2) return;
      this.view.show_scene(run, true);
      this.show(run);
    } catch {
      // The file is being made.
    } finally {
      this.is_asking = false;
      this.last = performance.now();
    }
  }
  show(run) {
    const channel = run.data.channels.find((c) => c.path.startsWith("/sensors/")) ?? run.data.channels.find((c) => c.path.endsWith("/q"));
    if (!channel) return;
    const series = channel.columns.map((column, i) => run.make_series(channel, i, column.name || channel.path));
    if (this.chart) return this.chart.set_series(series);
    this.chart = new Chart({ title: channel.path.slice(1), series, x_label: label_time(run), y_label: with_unit(channel.path.slice(1), channel.columns[0].unit), height: 240 });
    this.view.result.replaceChildren(this.chart.element);
  }
  end() {
    this.is_over = true;
  }
}

export async function open_system(studio, file) {
  return new SystemView(studio, file, await ask("read", { file }));
}
