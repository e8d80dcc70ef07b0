// The text of a body or system file: editor, live check, undo, saving, outside changes.
import { ask } from "./api.js";
import { el, make_button } from "./page_parts.js";
import { Editor, make_message_list, save_text } from "./parts.js";

export class TextPane {
  /**
   * @param {{on_check?: (answer: any) => void, on_saved?: () => void}} hooks
   */
  constructor(studio, file, kind, { text, hash }, hooks = {}) {
    this.studio = studio;
    this.file = file;
    this.kind = kind;
    this.hash = hash;
    this.saved = text;
    this.hooks = hooks;
    this.editor = new Editor(() => this.check());
    this.editor.reset(text);
    this.messages = make_message_list((m) => m.line > 0 && this.editor.go(m.line));
    this.state = el("span", { class: "badge", role: "status" });
    this.outside = el("div", { class: "banner", hidden: true, role: "alert" });
    const command = el("input", { type: "text", class: "command", placeholder: `command of bough edit: set ${kind === "body" ? "body.modes.number=12" : "simulation.duration=5"}`, "aria-label": "command of bough edit" });
    command.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || !command.value.trim()) return;
      studio.attempt(async () => {
        await this.edit([command.value]);
        command.value = "";
      });
    });
    this.save_button = Object.assign(make_button("Save …", "Shows the difference, then writes (Ctrl+S)", () => this.save()), { className: "main save" });
    this.element = el("div", { class: "text-pane" }, this.outside,
      el("div", { class: "tools" }, this.save_button, make_button("Undo", "Take the last change back", () => this.editor.undo()), make_button("Redo", "Make it again", () => this.editor.redo()), this.state),
      this.editor.element, command, this.messages.element);
    this.element.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey)) return;
      const action = { s: () => this.save(), z: () => this.editor.undo(), y: () => this.editor.redo() }[event.key];
      if (!action || (event.key !== "s" && event.target !== this.editor.area)) return;
      event.preventDefault();
      action();
    });
    this.check();
  }

  get text() {
    return this.editor.text;
  }
  is_changed() {
    return this.text !== this.saved;
  }

  /**
   * Commands of `bough edit`, as one step of undo. Of several calls each begins with the text of the one before.
   * @param {string[]} commands
   */
  edit(commands) {
    const done = (this.edits ?? Promise.resolve()).then(() => this.apply(commands));
    this.edits = done.catch(() => {});
    return done;
  }

  async apply(commands) {
    this.editor.keep();
    const { text } = await ask("edit", { file: this.file, text: this.text, kind: this.kind, commands });
    this.editor.change(text);
  }

  async check() {
    this.show_state();
    const text = this.text;
    this.waiting = text;
    if (this.is_checking) return;
    this.is_checking = true;
    try {
      const answer = await ask("check", { file: this.file, text, kind: this.kind });
      if (this.text === text) {
        this.answer = answer;
        this.messages.show(answer.messages, "The text is valid.");
        this.editor.mark(answer.messages);
        this.element.dataset.checked = String(answer.messages.filter((m) => m.severity === "error").length);
        this.hooks.on_check?.(answer);
      }
    } catch (error) {
      this.studio.show_error(error);
    } finally {
      this.is_checking = false;
      if (this.waiting !== text) this.check();
    }
  }

  show_state() {
    const is_changed = this.is_changed();
    this.state.textContent = is_changed ? "not saved" : "saved";
    this.state.className = "badge " + (is_changed ? "look" : "ok");
  }

  save() {
    return this.studio.attempt(async () => {
      this.editor.keep();
      const done = await save_text(this.file, this.saved, this.text, this.hash);
      if (!done) return false;
      this.hash = done.hash;
      this.saved = done.text;
      if (this.text !== done.text) this.editor.change(done.text);
      this.outside.hidden = true;
      this.show_state();
      await this.studio.refresh();
      this.hooks.on_saved?.();
      return true;
    });
  }

  /** Saved, if the text has changed and the user agrees. */
  async make_saved() {
    return !this.is_changed() || this.save();
  }

  /** Called when the list of files has another time of this file. */
  async notice() {
    const now = await ask("read", { file: this.file }).catch(() => null);
    if (!now || now.hash === this.hash) return;
    if (!this.is_changed()) {
      this.hash = now.hash;
      this.saved = now.text;
      this.editor.change(now.text);
      this.show_state();
      return;
    }
    this.outside.replaceChildren("The file has changed outside the studio. ", make_button("Take it as it is now", "The text here can be had back by Undo", () => {
      this.hash = now.hash;
      this.saved = now.text;
      this.editor.change(now.text);
      this.outside.hidden = true;
    }), " ", make_button("Keep the text here", "Saving shows both", () => (this.outside.hidden = true)));
    this.outside.hidden = false;
  }
}
