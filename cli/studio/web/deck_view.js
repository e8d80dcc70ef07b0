import { ask, run_job } from "./api.js";
import { make_body_form } from "./body_form.js";
import { DeckScene } from "./deck_scene.js";
import { el, get_css, make_button, make_check, make_select, make_swatch } from "./page_parts.js";
import { make_menu, make_message_list, make_progress, show_lines } from "./parts.js";
import { Viewer } from "./viewer.js";

/** The mesh of a deck in a viewer: picking, groups, symbols. `on_pick(grid)` is called for each grid that is clicked. */
export class DeckStage {
  /** @param {any} answer  @param {(grid: number, row: number) => void} on_pick  0: no grid; -1: no element */
  constructor(answer, on_pick, height = "100%") {
    this.scene = new DeckScene(answer);
    this.chosen = new Set();
    /** More grids and their colours. @type {[number[], string][]} */
    this.marked = [];
    this.picked = 0;
    this.viewer = new Viewer(height);
    this.viewer.name = "deck";
    this.viewer.on_pick = (found, element) => {
      this.picked = found ? found.id : 0;
      on_pick(this.picked, element ? element.element : -1);
      this.draw();
    };
    this.viewer.repaint = () => this.draw();
    this.element = this.viewer.element;
    this.viewer.face(this.scene.box);
    this.draw();
    this.viewer.fit(this.scene.box);
  }
  draw() {
    const { things, marks } = this.scene.make_things();
    if (this.chosen.size > 0) marks.push(this.scene.make_marks(this.chosen, "#d55e00"));
    for (const [grids, color] of this.marked) if (grids.length > 0) marks.push(this.scene.make_marks(grids, color));
    if (this.picked) marks.push(this.scene.make_marks([this.picked], get_css("--mark")));
    this.viewer.things = things;
    this.viewer.marks = marks;
    this.viewer.draw();
  }
  /** Shows a grid in the middle; false: the deck has no such grid. */
  go(grid) {
    const place = this.scene.get_place(grid);
    if (!place) return false;
    this.picked = grid;
    this.viewer.target = place;
    this.viewer.distance = Math.min(this.viewer.distance, 0.6 * this.scene.size);
    this.draw();
    this.viewer.name_node(grid);
    return true;
  }
  dispose() {
    this.viewer.dispose();
  }
}

// Key, text and colour of each symbol of a deck.
const kSymbols = [["sections", "bar sections"], ["pins", "pin flags", "hinge"], ["masses", "masses", "sensor"], ["spiders", "rigid elements", "reaction"], ["supports", "SPC", "hinge"], ["loads", "loads", "applied"], ["systems", "coordinate systems"], ["edges", "edges"]];

export class DeckView {
  constructor(studio, file, answer) {
    this.studio = studio;
    this.file = file;
    this.answer = answer;
    this.form = make_body_form(studio, file, (grids) => {
      this.chosen = new Set(grids);
      if (!this.stage) return;
      this.stage.chosen = this.chosen;
      this.stage.draw();
    });
    this.picked = el("output", { class: "picked", "aria-live": "polite" }, "Click a grid.");
    this.messages = make_message_list((m) => this.go(m));
    this.all = answer.messages;
    this.groups = el("div", { class: "groups" });
    this.side = el("aside", { class: "side" });
    this.stage_host = el("div", { class: "stage-host" });
    this.element = el("div", { class: "split" }, this.stage_host, this.side);
    this.fill();
  }

  /** Mesh, messages and lists of the answer. */
  fill() {
    this.times = this.get_times();
    this.stage = new DeckStage(this.answer, (grid, row) => {
      this.pick(grid, row);
      if (grid) this.form.take(grid);
    });
    this.menu = make_menu(this.stage.element);
    this.stage.viewer.on_menu = (found, place) => this.open_menu(found ? found.element : -1, place);
    this.stage.viewer.on_key = (event) => this.key(event);
    this.stage.chosen = this.chosen;
    this.stage_host.replaceChildren(this.stage.viewer.make_view_buttons(), this.stage.element, el("p", { class: "note hint" }, "Drag turns, shift moves, the wheel comes nearer; a click names a grid and an element, a right click hides and shows. Arrow keys, + and − do the same; h hides the group of the element that was clicked, a shows all."));
    this.side.replaceChildren(this.make_find(), this.form.element, this.make_messages(), this.make_solve(), this.make_show(), this.make_cards());
    this.messages.show(this.all, "Reading found nothing. “Check” builds the model too.");
    this.list_groups();
    this.stage.draw();
  }

  /** When the deck and the files that it includes were changed last. */
  get_times() {
    const names = new Set([this.file, ...this.answer.files.map((f) => this.studio.to_name(f))]);
    return this.studio.files.filter((f) => names.has(f.name)).map((f) => `${f.name} ${f.time}`).join("\n");
  }

  /** Reads the deck again if one of its files has changed; interface nodes and the camera stay. */
  async notice() {
    if (this.get_times() === this.times) return;
    this.times = this.get_times();
    await this.studio.attempt(async () => {
      this.answer = await ask("deck", { file: this.file });
      const { yaw, pitch, distance, target } = this.stage.viewer;
      this.stage.dispose();
      this.all = this.answer.messages;
      this.fill();
      Object.assign(this.stage.viewer, { yaw, pitch, distance, target, is_fitted_late: false });
      this.stage.draw();
      this.pick(0);
      this.studio.say(`${this.file} has changed outside and was read again.`);
    });
  }

  /** Names the grid, 0 for none, and the element in this row, -1 for none. */
  pick(grid, row = -1) {
    this.row = row;
    if (!grid && row < 0) {
      this.picked.textContent = "Click a grid.";
      return;
    }
    this.picked.replaceChildren(...(grid ? this.name_grid(grid) : []), ...(grid && row >= 0 ? [el("br")] : []), ...(row >= 0 ? this.name_element(row) : []));
  }

  name_grid(grid) {
    const { scene } = this.stage, k = scene.point_of_grid.get(grid), row = scene.row_of_grid.get(grid);
    const parts = this.answer.num_parts > 1 ? `, part ${scene.grids.part[row]} of ${this.answer.num_parts}` : "";
    return [el("strong", {}, `grid ${grid}`), ` ${scene.describe_place(k)}${parts} `, make_button("card", "Show the card in the deck", () => this.show_card(scene.grids.file[row], scene.grids.line[row])), " ",
      make_button("interface", "Make it an interface node, as one that elements hide", () => this.form.take(grid, true))];
  }

  name_element(row) {
    const { scene } = this.stage, { elements } = scene, group = scene.find_group(row);
    return [el("strong", {}, `${elements.cards[elements.card[row]]} ${elements.id[row]}`), ` ${scene.describe_element(row).split(", ").slice(1).join(", ")} `, make_button("card", "Show the card in the deck", () => this.show_card(elements.file[row], elements.line[row])),
      ...(group ? [" ", make_button("hide", `Hide ${group.name} (h)`, () => this.show_groups([group.name], false)), " ", make_button("only", `Show ${group.name} only`, () => this.show_only(group.name))] : [])];
  }

  /** What a right click, or the menu key after a click, offers. @param {number} row  -1: no element is there */
  open_menu(row, place) {
    const { scene } = this.stage, group = row >= 0 ? scene.find_group(row) : null;
    const entries = group ? [[`Hide ${group.name}`, () => this.show_groups([group.name], false)], [`Show ${group.name} only`, () => this.show_only(group.name)]] : [];
    this.menu.open(place, row >= 0 ? scene.describe_element(row) : "no element", [...entries, ["Show all", () => this.show_only("")]]);
  }

  key(event) {
    const act = { h: () => this.row >= 0 && this.show_groups([this.stage.scene.find_group(this.row).name], false), a: () => this.show_only("") }[event.key];
    const { clientWidth, clientHeight } = this.stage.viewer.canvas;
    if (event.key === "ContextMenu" || (event.key === "F10" && event.shiftKey)) this.open_menu(this.row ?? -1, [clientWidth / 2, clientHeight / 2]);
    else if (act && !event.ctrlKey && !event.metaKey) act();
    else return false;
    event.preventDefault();
    return true;
  }

  /** @param {string[]} names  of groups */
  show_groups(names, is_on) {
    const { hidden } = this.stage.scene;
    for (const name of names) is_on ? hidden.delete(name) : hidden.add(name);
    this.list_groups();
    this.stage.draw();
  }
  /** @param {string} name  of the group that is left; "": all are shown */
  show_only(name) {
    const { scene } = this.stage;
    scene.hidden = new Set(name ? scene.groups.map((g) => g.name).filter((other) => other !== name) : []);
    this.list_groups();
    this.stage.draw();
  }

  show_card(file, line) {
    this.studio.attempt(() => show_lines(this.studio.to_name(this.answer.files[file]), line));
  }

  make_find() {
    const field = el("input", { type: "search", placeholder: "grid or element id", "aria-label": "find an id", inputmode: "numeric" });
    const find = () => {
      const id = Number(field.value);
      if (!(id > 0)) return;
      if (this.stage.go(id)) return this.pick(id);
      const { elements, drawing } = this.stage.scene, row = elements.id.indexOf(id);
      if (row < 0) {
        this.picked.textContent = `No grid and no drawn element ${id}.`;
        return;
      }
      const t = elements.of_triangle.indexOf(row), e = elements.of_edge.indexOf(row);
      const point = t >= 0 ? drawing.triangles[3 * t] : e >= 0 ? drawing.edges[2 * e] : -1;
      if (point >= 0) this.stage.go(drawing.ids[point]);
      this.pick(0, row);
    };
    field.addEventListener("change", find);
    return el("section", {}, el("div", { class: "tools" }, field, make_button("Find", "Show this grid or element", find)), this.picked);
  }

  make_messages() {
    const button = make_button("Check", "bough check: builds the model and reports all errors", () => this.studio.attempt(async () => {
      button.disabled = true;
      try {
        const { output, messages } = await run_job({ verb: "check", files: [this.file], options: [["--json"]] });
        this.all = messages;
        const sum = /"num_nodes": (\d+)/.exec(output), free = /"num_free_dofs": (\d+)/.exec(output);
        this.messages.show(messages, sum ? `No errors. ${sum[1]} nodes, ${free?.[1] ?? "?"} free DOFs.` : "No messages.");
      } finally {
        button.disabled = false;
      }
    }));
    return el("section", {}, el("h3", {}, "Messages ", button), this.messages.element);
  }

  /** Solutions of the case control, shown when they are there: stresses of a static one as colours. */
  make_solve() {
    const stem = this.file.replace(/\.[^./]+$/, ""), progress = make_progress();
    const solve = (text, title, verb, options, ending) => {
      const button = make_button(text, title, () => this.studio.attempt(async () => {
        button.disabled = true;
        try {
          const output = stem + ending, done = await run_job({ verb, files: [this.file], options: [...options, ["-o", output]] }, progress.update);
          progress.finish(done);
          this.messages.show(done.messages);
          await this.studio.refresh();
          if (done.code === 0) await this.studio.open(output);
        } finally {
          button.disabled = false;
        }
      }));
      return button;
    };
    return el("section", {}, el("h3", {}, "Solve"), el("div", { class: "tools" }, solve("Static", "bough static: displacements, stresses, failure indices of each subcase", "static", [], "-static.h5"),
      solve("Modes", "bough modes: normal modes with the strain energy of their elements", "modes", [["--ese"]], "-modes.h5")), progress.element);
  }

  /** To the grid or element that a message names, else to its line. */
  go(message) {
    const grid = /\bgrid (\d+)/.exec(message.what);
    if (grid && this.stage.go(Number(grid[1]))) this.pick(Number(grid[1]));
    if (message.line > 0 && message.file) this.studio.attempt(() => show_lines(this.studio.to_name(message.file), message.line));
  }

  make_show() {
    const { scene } = this.stage;
    const choose = make_select("colour by", ["property", "card", "connected part"], (i) => {
      scene.set_coloring(["property", "card", "part"][i]);
      scene.hidden.clear();
      this.list_groups();
      this.stage.draw();
    });
    const boxes = kSymbols.map(([key, text, color]) => {
      const label = make_check(text, scene.show[key], (on) => {
        scene.show[key] = on;
        this.stage.draw();
      });
      if (color) label.append(" ", el("span", { class: "swatch " + color, "aria-hidden": "true" }));
      return label;
    });
    const all = (on) => () => this.show_groups(scene.groups.map((g) => g.name), on);
    return el("section", {}, el("h3", {}, "Show"), el("div", { class: "tools" }, choose, make_button("all", "Show all groups", all(true)), make_button("none", "Hide all groups", all(false))), this.groups, el("div", { class: "tools" }, ...boxes), el("p", { class: "note" }, scene.thinned.join("; ")));
  }

  list_groups() {
    const { scene } = this.stage;
    this.groups.replaceChildren(...scene.groups.map((g) => {
      const card = this.answer.properties.find((p) => p.id === g.property && !p.card.startsWith("MAT"));
      const box = make_check(g.name, !scene.hidden.has(g.name), (on) => {
        if (on) scene.hidden.delete(g.name);
        else scene.hidden.add(g.name);
        this.stage.draw();
      });
      const only = make_button("only", `Show ${g.name} only`, () => this.show_only(g.name));
      const shape = scene.sections.shapes.find((s) => s.equivalent && card && s.card === card.card && s.id === card.id);
      return el("div", { class: "group" }, make_swatch(g.style), box, " ", only, card ? el("span", { class: "note" }, ` ${card.card} ${card.values}${shape ? `, ${scene.sections.describe_shape(shape)}` : ""}`) : "");
    }));
  }

  make_cards() {
    const { cards, properties, files, sol } = this.answer;
    const rows = Object.entries(cards).map(([name, count]) => el("tr", {}, el("td", { class: "text" }, name), el("td", {}, String(count))));
    const items = properties.map((p) => el("li", {}, el("button", { type: "button", title: "Show the card", onclick: () => this.show_card(p.file, p.line) }, `${p.card} ${p.id}`), ` ${p.values}`));
    return el("section", {}, el("details", {}, el("summary", {}, `Properties and materials (${properties.length})`), el("ul", { class: "cards" }, ...items)),
      el("details", {}, el("summary", {}, `Cards of ${files.length} file${files.length > 1 ? "s" : ""}, SOL ${sol || "–"}`), el("table", {}, el("tbody", {}, ...rows))));
  }

  dispose() {
    this.stage.dispose();
  }
}

export async function open_deck(studio, file) {
  return new DeckView(studio, file, await ask("deck", { file }));
}
