import { ask, find_job, follow_job, run_job } from "./api.js";
import { make_chapter } from "./chapter_panel.js";
import { DeckStage } from "./deck_view.js";
import { make_compare } from "./file_views.js";
import { el, get_css, make_button, make_check, make_select } from "./page_parts.js";
import { make_progress, show_history } from "./parts.js";
import { TextPane } from "./text_view.js";

const kTargets = ["an interface node", "an output node", "a load", "nothing"];
const stem = (file) => file.replace(/\.[^./]+$/, "");

/** A body file: text and deck side by side, reduce, then its modes. */
export class BodyView {
  constructor(studio, file, read) {
    this.studio = studio;
    this.file = file;
    this.stage_host = el("div", { class: "stage-host" });
    this.result = el("div", { class: "result" });
    this.comparison = el("div", { class: "comparison" });
    this.progress = make_progress();
    this.target = kTargets[0];
    this.picked = el("output", { class: "picked", "aria-live": "polite" });
    this.pane = new TextPane(studio, file, "body", read, { on_check: (answer) => this.show_deck(answer) });
    const reduce = this.reduce_button = Object.assign(make_button("Reduce", "bough reduce: modes, mass integrals, geometric stiffness", () => this.reduce()), { className: "main reduce" });
    this.energy = make_check("with strain energy", false, () => {});
    const actions = el("div", { class: "tools actions" }, reduce, this.energy, make_select("a click sets", kTargets, (i) => (this.target = kTargets[i])), this.picked, make_button("Copy commands …", "The lines that do the same in a shell", () => show_history()));
    this.element = el("div", { class: "split reverse" }, el("div", { class: "side wide" }, this.pane.element), el("div", { class: "work-column" }, actions, this.progress.element, this.stage_host, this.result));
    this.output = stem(file) + ".h5";
    this.join().then((found) => !found && studio.has(this.output) && this.show_result());
  }

  get is_following() {
    return this.is_busy ?? false;
  }
  set is_following(is_on) {
    this.is_busy = is_on;
    this.reduce_button.disabled = is_on;
  }

  async show_deck(answer) {
    if (!answer.deck) return;
    if (answer.deck !== this.deck) {
      this.deck = answer.deck;
      await this.studio.attempt(async () => {
        const name = this.studio.to_name(answer.deck);
        this.deck_time = this.studio.find(name)?.time;
        const deck = await ask("deck", { file: name });
        this.stage?.dispose();
        this.stage = new DeckStage(deck, (grid) => this.pick(grid), "100%");
        this.stage_host.replaceChildren(this.stage.viewer.make_view_buttons(), this.stage.element);
      });
    }
    if (!this.stage) return;
    this.stage.chosen = new Set(this.pane.answer.interface);
    this.outputs = await this.read_outputs();
    this.loads = [...this.pane.text.matchAll(/^\s*name\s*=\s*"load_(\d+)"/gm)].map((m) => Number(m[1]));
    this.stage.marked = [[this.outputs, get_css("--sensor")], [this.loads, get_css("--applied")]];
    this.stage.draw();
  }

  /** Grids of body.output.nodes; of "all" none is marked. */
  async read_outputs() {
    const { values } = await ask("table", { text: this.pane.text, path: "body.output" });
    return (values.nodes ?? "").startsWith("[") ? (values.nodes.match(/\d+/g) ?? []).map(Number) : [];
  }

  /** A grid that was clicked is set, or taken out if it is set: an interface node, an output node, unit loads. */
  pick(grid) {
    this.picked.textContent = grid ? `grid ${grid} ${this.stage.scene.describe_place(this.stage.scene.point_of_grid.get(grid))}` : "";
    if (!grid || this.target === "nothing") return;
    const change = (now, path) => {
      const next = now.includes(grid) ? now.filter((g) => g !== grid) : [...now, grid];
      return next.length > 0 ? `set ${path}=[${next.join(", ")}]` : `unset ${path}`;
    };
    const command = this.target === "an interface node" ? change(this.pane.answer?.interface ?? [], "body.interface")
      : this.target === "an output node" ? change(this.outputs ?? [], "body.output.nodes")
      : this.loads?.includes(grid) ? `delete load_${grid}` : `add body.load name=load_${grid} node=${grid}`;
    this.studio.attempt(() => this.pane.edit([command]));
  }

  reduce() {
    return this.studio.attempt(async () => {
      if (this.is_following || !(await this.pane.make_saved())) return;
      const with_energy = this.energy.querySelector("input").checked;
      await this.watch((on_progress) => run_job({ verb: "reduce", files: [this.file], options: [["-o", this.output], ...(with_energy ? [["--strain-energy"]] : [])] }, on_progress));
    });
  }

  /** Follows a reduction that runs already, of this page before it was loaded again or of another tab. */
  async join() {
    const found = await this.studio.attempt(() => find_job(this.file, ["reduce"]));
    if (found && !this.is_following) await this.studio.attempt(() => this.watch((on_progress) => follow_job(found, on_progress)));
    return Boolean(found);
  }

  async watch(follow) {
    this.is_following = true;
    const done = await follow(this.progress.update).finally(() => (this.is_following = false));
    this.progress.finish(done);
    this.pane.messages.show(done.messages, "Reduced.");
    await this.studio.refresh();
    if (done.code !== 0) return;
    await this.show_result();
    this.result.scrollIntoView({ block: "start" });
  }

  async show_result() {
    await this.studio.attempt(async () => {
      const { chapter } = await ask("chapter", { file: this.output });
      this.shown?.dispose();
      this.shown = make_chapter(chapter);
      const compare = make_compare(this.studio, this.output, this.progress, (output) => this.show_comparison(output));
      this.result.replaceChildren(el("h2", {}, this.output), el("div", { class: "tools" }, compare), this.comparison, this.shown.element);
      this.result.dataset.ready = "true";
    });
  }

  /** MAC and frequencies against another body, above the modes. */
  async show_comparison(output) {
    const { chapter } = await ask("chapter", { file: output });
    this.compared?.dispose();
    this.compared = make_chapter(chapter);
    this.comparison.replaceChildren(el("h3", {}, chapter.title || output, " ", make_button("✕", "Close the comparison", () => this.comparison.replaceChildren())), this.compared.element);
    this.comparison.dataset.file = output;
    this.comparison.scrollIntoView({ block: "start" });
  }

  async notice() {
    await this.pane.notice();
    this.join();
    if (!this.deck || this.studio.find(this.studio.to_name(this.deck))?.time === this.deck_time) return;
    this.deck = "";
    await this.show_deck(this.pane.answer);
  }
  is_changed() {
    return this.pane.is_changed();
  }
  dispose() {
    this.stage?.dispose();
    this.shown?.dispose();
    this.compared?.dispose();
  }
}

export async function open_body(studio, file) {
  return new BodyView(studio, file, await ask("read", { file }));
}
