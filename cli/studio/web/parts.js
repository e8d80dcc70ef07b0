import { ask, history } from "./api.js";
import { el, make_button } from "./page_parts.js";

/** @typedef {import("./api.js").Message} Message */

const kMarks = { error: ["✖", "bad"], warning: ["▲", "look"], note: ["ℹ", ""] };

/**
 * Messages as a list; a click on one calls `go`.
 * @param {(message: Message) => void} go
 */
export function make_message_list(go) {
  const list = el("ul", { class: "messages", "aria-live": "polite", "aria-label": "Messages" });
  /** @param {Message[]} messages */
  const show = (messages, none = "No messages.") => {
    const order = ["error", "warning", "note"];
    const sorted = [...messages].sort((a, b) => order.indexOf(a.severity) - order.indexOf(b.severity));
    list.replaceChildren(...sorted.slice(0, 300).map((m) => {
      const [mark, style] = kMarks[m.severity] ?? kMarks.note;
      const place = m.line > 0 ? `line ${m.line}: ` : "";
      return el("li", { class: style }, el("button", { type: "button", title: m.id, onclick: () => go(m) }, el("span", { "aria-label": m.severity }, mark), ` ${place}${m.what}`), m.advice ? el("span", { class: "note" }, m.advice) : "");
    }));
    if (sorted.length > 300) list.append(el("li", { class: "note" }, `${sorted.length - 300} more; bough check prints all.`));
    if (messages.length === 0) list.append(el("li", { class: "note" }, none));
  };
  return { element: list, show };
}

/** A dialog with buttons; gives the value of the one pressed, "" for Escape. */
export function ask_user(title, content, buttons) {
  return new Promise((done) => {
    const dialog = el("dialog", { "aria-label": title }, el("h3", {}, title), content,
      el("div", { class: "tools" }, ...buttons.map(([value, text]) => el("button", { type: "button", class: value === buttons[0][0] ? "main" : "", onclick: () => dialog.close(value) }, text))));
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** A menu over a view: opened at a place with its entries; Escape, Tab or a click elsewhere closes it. @param {HTMLElement} host */
export function make_menu(host) {
  const element = el("div", { class: "menu", role: "menu", hidden: true });
  let before = null;
  const close = (is_back = true) => {
    if (element.hidden) return;
    element.hidden = true;
    if (is_back) before?.focus();
  };
  element.addEventListener("keydown", (event) => {
    const buttons = [...element.querySelectorAll("button")], now = buttons.indexOf(/** @type {any} */ (document.activeElement));
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by) buttons[(now + by + buttons.length) % buttons.length].focus();
    else if (event.key === "Escape" || event.key === "Tab") close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  element.addEventListener("focusout", (event) => !element.contains(/** @type {any} */ (event.relatedTarget)) && close(false));
  host.append(element);
  return {
    element,
    /** @param {number[]} place  in the host  @param {string} title  @param {any[][]} entries  [text, action] */
    open(place, title, entries) {
      before = document.activeElement;
      element.replaceChildren(el("p", { class: "note" }, title), ...entries.map(([text, action]) => el("button", { type: "button", role: "menuitem", onclick: () => {
        close();
        action();
      } }, text)));
      element.hidden = false;
      element.style.left = Math.max(0, Math.min(place[0], host.clientWidth - element.offsetWidth)) + "px";
      element.style.top = Math.max(0, Math.min(place[1], host.clientHeight - element.offsetHeight)) + "px";
      element.querySelector("button")?.focus();
    },
  };
}

/** The lines of a diff with their colours. */
export function make_diff_view(diff) {
  return el("pre", { class: "diff", tabindex: "0" }, ...(diff || "no difference\n").split("\n").slice(0, 2000).map((line) =>
    el("span", { class: line.startsWith("+") ? "added" : line.startsWith("-") ? "removed" : line.startsWith("@@") ? "place" : "" }, line + "\n")));
}

/**
 * Shows what saving changes, then writes. A file that has changed since it was read is not overwritten without a choice.
 * @param {{file: string, text: string}[]} [others]  new files that are written with it
 * @returns {Promise<{hash: string, text: string} | null>}  null: not saved
 */
export async function save_text(file, before, text, hash, others = []) {
  const content = el("div", {}, make_diff_view((await ask("diff", { file, before, after: text })).diff));
  for (const other of others)
    content.append(el("h4", {}, `New file ${other.file}`), make_diff_view((await ask("diff", { file: other.file, before: "", after: other.text })).diff));
  const choice = await ask_user(hash === "" ? `New file ${file}` : `Save ${file}`, content, [["save", "Save"], ["", "Cancel"]]);
  if (choice !== "save") return null;
  try {
    const saved = await ask("save", { file, text, hash });
    for (const other of others) await ask("save", { ...other, hash: "" });
    return { ...saved, text };
  } catch (error) {
    if (!error.has?.("studio.changed-file") && !error.has?.("cli.output-exists")) throw error;
    return resolve_conflict(file, text, error);
  }
}

async function resolve_conflict(file, text, error) {
  const now = await ask("read", { file }).catch(() => ({ text: "", hash: "" }));
  const { diff } = await ask("diff", { file, before: now.text, after: text });
  const content = el("div", {}, el("p", {}, error.message + ". The difference between the file as it is now and the text here:"), make_diff_view(diff));
  const choice = await ask_user("The file has changed", content, [["", "Cancel"], ["take", "Take the file as it is now"], ["overwrite", "Overwrite it"]]);
  if (choice === "take") return { hash: now.hash, text: now.text };
  if (choice === "overwrite") return { ...(await ask("save", { file, text, hash: now.hash })), text };
  return null;
}

/** Shows text of a file around a line. */
export async function show_lines(file, line) {
  const { text } = await ask("read", { file });
  const lines = text.split("\n"), from = Math.max(0, line - 15);
  const shown = lines.slice(from, line + 15).map((t, i) => el("span", { class: from + i + 1 === line ? "here" : "" }, `${String(from + i + 1).padStart(6)}  ${t}\n`));
  await ask_user(`${file}, line ${line}`, el("pre", { class: "lines", tabindex: "0" }, ...shown), [["", "Close"]]);
}

/** Commands of this page so far, in a dialog from which they can be copied. */
export async function show_history(extra = []) {
  const text = [...history, ...extra].join("\n") + "\n";
  const area = el("textarea", { rows: 10, readonly: true, "aria-label": "commands", class: "code" });
  area.value = text;
  const note = el("p", { class: "note" }, "These lines, typed in the folder of the studio with its files as they are saved now, do the same.");
  const choice = await ask_user("Commands", el("div", {}, note, area), [["copy", "Copy"], ["", "Close"]]);
  if (choice === "copy") await navigator.clipboard.writeText(text).catch(() => {});
}

/** Progress of a command: the last line, a button to stop, all output folded. */
export function make_progress() {
  const line = el("output", { class: "progress-line", "aria-live": "polite" });
  const bar = el("progress", { max: 100, "aria-label": "progress" });
  const output = el("pre", {});
  const stop = make_button("Stop", "Interrupt the command, as Ctrl-C does", () => handle?.stop());
  const fold = el("details", {}, el("summary", {}, "Output"), output);
  const element = el("div", { class: "progress", hidden: true }, el("div", { class: "tools" }, bar, line, stop), fold);
  let handle = null;
  const update = (text, job) => {
    handle = job;
    element.hidden = false;
    stop.hidden = false;
    const last = text.trimEnd().split("\n").pop() ?? "";
    const share = /^\w+: +([\d.]+) %/.exec(last);
    if (share) bar.value = Number(share[1]);
    else bar.removeAttribute("value");
    line.textContent = last.slice(0, 160);
    output.textContent = text;
  };
  const finish = ({ code, line: words }) => {
    stop.hidden = true;
    // Of a command that was stopped the bar stays where it was.
    const is_stopped = code !== 0 && output.textContent.includes("stopped on request");
    if (code === 0) bar.value = 100;
    else if (!bar.hasAttribute("value")) bar.value = 0;
    line.textContent = is_stopped ? `stopped: ${words}` : (code === 0 ? "done: " : `ended with code ${code}: `) + words;
    fold.open = code !== 0 && !is_stopped;
  };
  return { element, update, finish };
}

/** A TOML text with line numbers, undo and marks of wrong lines. */
export class Editor {
  constructor(on_change) {
    this.area = el("textarea", { class: "code", spellcheck: "false", wrap: "off", "aria-label": "text of the file" });
    this.gutter = el("pre", { class: "gutter", "aria-hidden": "true" });
    this.element = el("div", { class: "editor" }, this.gutter, this.area);
    this.before = [];
    this.after = [];
    this.wrong = new Map();
    this.on_change = on_change;
    this.last = "";
    this.area.addEventListener("input", () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.keep(), 400);
      this.number();
    });
    this.area.addEventListener("scroll", () => (this.gutter.scrollTop = this.area.scrollTop));
  }
  get text() {
    return this.area.value;
  }
  keep() {
    clearTimeout(this.timer);
    if (this.area.value === this.last) return;
    this.before.push(this.last);
    this.after = [];
    this.last = this.area.value;
    this.on_change();
  }
  /** Without a way back: a file that was opened. */
  reset(text) {
    this.before = [];
    this.after = [];
    this.put(text);
  }
  /** A change that undo takes back. */
  change(text) {
    this.keep();
    if (text === this.last) return;
    this.before.push(this.last);
    this.after = [];
    this.put(text, this.last);
    this.on_change();
  }
  /** @param {string | null} before  brings the lines into view that differ from this text */
  put(text, before = null) {
    const { scrollTop } = this.area;
    this.area.value = this.last = text;
    this.area.scrollTop = scrollTop;
    if (before !== null) this.reveal(before.split("\n"), text.split("\n"));
    this.number();
  }
  /** Scrolls only if a changed line is out of view. @param {string[]} before  @param {string[]} now */
  reveal(before, now) {
    const first = now.findIndex((line, i) => line !== before[i]);
    if (first < 0) return;
    let same = 0;  // lines at the end
    while (same < Math.min(now.length, before.length) - first && now[now.length - 1 - same] === before[before.length - 1 - same]) ++same;
    const { scrollTop, clientHeight, scrollHeight } = this.area, height = scrollHeight / now.length;
    const top = first * height, bottom = (now.length - same) * height;
    if (top < scrollTop || bottom > scrollTop + clientHeight) this.area.scrollTop = Math.max(0, Math.min(top - 2 * height, bottom + 2 * height - Math.min(clientHeight, bottom - top + 4 * height)));
  }
  step(from, to) {
    this.keep();
    if (from.length === 0) return;
    to.push(this.last);
    this.put(from.pop(), this.last);
    this.on_change();
  }
  undo() {
    this.step(this.before, this.after);
  }
  redo() {
    this.step(this.after, this.before);
  }
  /** @param {Message[]} messages */
  mark(messages) {
    this.wrong = new Map(messages.filter((m) => m.line > 0 && m.severity !== "note").map((m) => [m.line, m]));
    this.number();
  }
  number() {
    const count = this.area.value.split("\n").length;
    this.gutter.replaceChildren(...Array.from({ length: count }, (_, i) => {
      const message = this.wrong.get(i + 1);
      return el("span", message ? { class: "wrong " + message.severity, title: message.what } : {}, String(i + 1) + "\n");
    }));
    this.gutter.scrollTop = this.area.scrollTop;
  }
  go(line) {
    const lines = this.area.value.split("\n");
    const from = lines.slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
    this.area.focus();
    this.area.setSelectionRange(from, from + (lines[line - 1]?.length ?? 0));
    const height = this.area.scrollHeight / lines.length;
    this.area.scrollTop = Math.max(0, (line - 6) * height);
  }
}

/** The scene in a corner of the window while its place is scrolled away: what moves it is below. */
export class FloatingScene {
  /** @param {HTMLElement} place  where the scene belongs, first in it  @param {HTMLElement} scene */
  constructor(place, scene) {
    this.place = place;
    this.scene = scene;
    scene.append(Object.assign(make_button("✕", "Back to its place", () => this.hide()), { className: "to-place" }));
    this.on_scroll = () => this.is_floating && !this.is_away() && this.hide();
    document.addEventListener("scroll", this.on_scroll, { capture: true, passive: true });
  }
  get is_floating() {
    return this.scene.classList.contains("floating");
  }
  /** Less than a third of it would be in view at its place. */
  is_away() {
    if (!this.is_floating) this.height = this.scene.offsetHeight;
    const { top } = this.place.getBoundingClientRect(), view = this.place.parentElement?.getBoundingClientRect();
    return view !== undefined && Math.min(view.bottom, top + this.height) - Math.max(view.top, top) < this.height / 3;
  }
  show() {
    if (this.is_floating || !this.is_away()) return;
    this.place.style.minHeight = `${this.place.offsetHeight}px`;  // the page below stays where it is
    this.scene.classList.add("floating");
  }
  hide() {
    this.scene.classList.remove("floating");
    this.place.style.minHeight = "";
  }
  dispose() {
    document.removeEventListener("scroll", this.on_scroll, { capture: true });
  }
}
