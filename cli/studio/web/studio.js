import { ask, call, list_jobs, StudioError } from "./api.js";
import { open_body } from "./body_view.js";
import { open_deck } from "./deck_view.js";
import { open_chapter, open_report, open_text } from "./file_views.js";
import { el, make_button, make_theme_button } from "./page_parts.js";
import { ask_user, make_message_list } from "./parts.js";
import { open_system } from "./system_view.js";

/** @type {[string, string[] | null][]} */
const kKinds = [["Decks", ["deck"]], ["Bodies", ["body", "bough-flexbody"]], ["Systems", ["system"]], ["Results", ["bough-results"]], ["Modes, linear models and more", null], ["Pages", ["report"]]];
const kViews = { deck: open_deck, body: open_body, system: open_system, report: open_report, campaign: open_text, toml: open_text };
const kLookEvery = 3000;  // ms: for changes outside

class Studio {
  constructor() {
    this.files = [];
    this.list = document.querySelector("nav.files");
    this.work = /** @type {HTMLElement} */ (document.querySelector("main.work"));
    this.notes = el("div", { class: "notes", role: "status" });
    document.body.append(this.notes);
    this.jobs = el("span", { class: "jobs", role: "status", "aria-label": "commands that run" });
    document.querySelector("header .spacer").before(this.jobs);
    const end = make_button("End", "End bough studio", () => this.end());
    document.querySelector("header").append(make_theme_button(), end);
    addEventListener("beforeunload", (event) => this.view?.is_changed?.() && event.preventDefault());
  }

  async start() {
    const state = await call("state", {});
    this.folder = state.folder;
    document.querySelector("header .folder").textContent = `${state.folder} · Bough ${state.version}`;
    document.title = `${state.folder} – Bough studio`;
    await this.refresh();
    const before = decodeURIComponent(location.hash.slice(1));  // of this page before it was loaded again
    if (this.has(before)) await this.open(before);
    else if (state.files.length > 0) await this.open(state.files[0]);
    else this.show_welcome();
    document.documentElement.dataset.ready = "true";
    setInterval(() => document.visibilityState === "visible" && this.look(), kLookEvery);
    addEventListener("focus", () => this.look());
  }

  show_welcome() {
    const steps = ["Open a deck: its mesh, cards and messages.", "Click the grids where other bodies, hinges or forces will be, and make a body.", "Reduce it: its modes.", "Open the system file: place bodies, add hinges; run; linearize.", "Save the run as a page."];
    this.work.replaceChildren(el("div", { class: "page welcome" }, el("h2", {}, "Files of this folder are on the left"), el("ol", {}, ...steps.map((s) => el("li", {}, s))), el("p", { class: "note" }, "The studio writes nothing that it has not shown, and only in this folder and below.")));
  }

  /**
   * Runs an action; its failure is shown, and stays until an action that began later succeeds.
   * @param {boolean} [is_own]  false: no action of the user, failures stay
   * @returns the value of the action, false if it failed
   */
  async attempt(action, is_own = true) {
    const before = this.list_errors();
    try {
      const value = await action();
      if (is_own) before.forEach((box) => box.remove());
      return value;
    } catch (error) {
      this.show_error(error);
      return false;
    }
  }

  /** Failures that are shown. @returns {Element[]} */
  list_errors() {
    return [...this.notes.querySelectorAll(".toast.bad")];
  }

  show_error(error) {
    const list = make_message_list(() => {});
    list.show(error instanceof StudioError ? error.messages : [{ severity: "error", id: "", file: "", line: 0, what: String(error.message ?? error), advice: "" }]);
    const box = el("div", { class: "toast bad" }, list.element, make_button("✕", "Close", () => box.remove()));
    this.notes.append(box);
  }

  say(text) {
    const box = el("div", { class: "toast" }, text + " ", make_button("✕", "Close", () => box.remove()));
    this.notes.append(box);
    setTimeout(() => box.remove(), 6000);
  }

  find(name) {
    return this.files.find((f) => f.name === name);
  }
  has(name) {
    return this.find(name) !== undefined;
  }
  /** A file of a message, which may be absolute, as the list has it. */
  to_name(path) {
    return this.files.find((f) => f.name === path)?.name ?? this.files.find((f) => path.endsWith("/" + f.name))?.name ?? path;
  }

  /** Commands that run, of this page and of others; a click opens the file of one, with its progress and Stop. */
  async show_jobs() {
    const jobs = await list_jobs();
    const text = jobs.map((j) => j.line).join("\n");
    if (this.jobs.dataset.lines === text) return;
    this.jobs.dataset.lines = text;
    this.jobs.replaceChildren(...jobs.map(({ line, request: { verb, files } }) => make_button(`${verb} ${files[0]} …`, `Runs: ${line}`, () => files[0] !== this.name && this.open(files[0]))));
  }

  async refresh() {
    await this.show_jobs();
    const { files } = await ask("list");
    this.files = files;
    const left = new Set(files);
    /** @type {[string, any[]][]} */
    const groups = [];
    for (const [title, kinds] of kKinds) {
      const members = [...left].filter((f) => (kinds ? kinds.includes(f.kind) : f.kind !== "report"));
      members.forEach((f) => left.delete(f));
      if (members.length > 0) groups.push([title, members]);
    }
    this.list.replaceChildren(...groups.map(([title, members]) => el("details", { open: true }, el("summary", {}, title), el("ul", {}, ...members.map((f) => el("li", {}, el("button", { type: "button", "data-file": f.name, title: `${f.kind}, ${Math.ceil(f.size / 1024)} kB`, "aria-current": f.name === this.name ? "true" : undefined, onclick: () => this.open(f.name) }, f.name)))))));
    if (files.length === 0) this.list.append(el("p", { class: "note" }, "There is no deck, TOML or HDF5 file in this folder. bough init lists examples."));
  }

  /** Changes outside: of the list, and of the file that is open. */
  async look() {
    if (this.is_looking || this.is_over) return;
    this.is_looking = true;
    try {
      const before = new Map(this.files.map((f) => [f.name, f.time]));
      await this.show_jobs();
      const { files } = await ask("list");
      const is_other = files.length !== before.size || files.some((f) => before.get(f.name) !== f.time);
      if (!is_other) return;
      await this.refresh();
      await this.view?.notice?.();
    } catch {
      // The next look, or the next request of the user, reports it.
    } finally {
      this.is_looking = false;
    }
  }

  async open(name) {
    if (this.view?.is_changed?.()) {
      const choice = await ask_user("Not saved", el("p", {}, `${this.name} has changes that are not saved.`), [["", "Stay"], ["leave", "Leave them"]]);
      if (choice !== "leave") return;
    }
    const file = this.files.find((f) => f.name === name) ?? { name, kind: "" };
    await this.attempt(async () => {
      this.work.setAttribute("aria-busy", "true");
      const make = kViews[file.kind] ?? open_chapter;
      const view = await make(this, name, file.kind);
      this.view?.dispose?.();
      this.view = view;
      this.name = name;
      history.replaceState(null, "", "#" + encodeURIComponent(name));
      const title = el("h2", { class: "file-title", tabindex: "-1" }, name, " ", el("small", {}, file.kind));
      this.work.replaceChildren(title, view.element);
      if (document.activeElement === document.body) title.focus();  // what had the focus is gone
      this.work.dataset.file = name;
    });
    this.work.removeAttribute("aria-busy");
    for (const button of /** @type {NodeListOf<HTMLElement>} */ (this.list.querySelectorAll("button[data-file]"))) button.toggleAttribute("aria-current", button.dataset.file === this.name);
  }

  async end() {
    if (this.view?.is_changed?.() && (await ask_user("Not saved", el("p", {}, `${this.name} has changes that are not saved.`), [["", "Stay"], ["end", "End"]])) !== "end") return;
    await this.attempt(() => call("end", {}));
    this.is_over = true;
    this.view?.dispose?.();
    this.view = null;
    this.work.replaceChildren(el("p", { class: "page" }, "The studio has ended. This page can be closed."));
  }
}

const studio = new Studio();
studio.attempt(() => studio.start());
globalThis.studio = studio;  // for the console of the browser
