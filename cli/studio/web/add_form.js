// Tables of a system file by a form: added, changed, deleted. Kinds and keys come from the schema, the text from the
// commands of bough edit.
import { ask } from "./api.js";
import { el, make_button } from "./page_parts.js";

const kFirst = ["body", "hinge", "force", "sensor", "function", "actuator", "controller", "constraint", "event"];
// Keys that a form begins with, besides the required ones; the others are in the list below them.
const kCommon = {
  body: ["name", "file", "mass", "cg", "inertia"],
  hinge: ["name", "type", "parent", "parent_node", "parent_position", "child", "child_node", "axis"],
  force: ["name", "body", "node", "force", "moment", "function"],
  sensor: ["name", "type", "body", "node", "hinge"],
  function: ["name", "type"],
  simulation: ["duration", "output_step", "gravity"],
};
// Examples of values that no type alone tells.
const kExamples = { "body.inertia": "[Ixx, Iyy, Izz] about cg", "body.cg": "[x, y, z]" };
const kAxes = { x: "[1.0, 0.0, 0.0]", y: "[0.0, 1.0, 0.0]", z: "[0.0, 0.0, 1.0]" };

/**
 * @typedef {{name: string, type: string, choices: string[], default: string, description: string, required: boolean}} Key
 * @typedef {{kind: string, description: string, list: boolean, keys: Key[]}} Kind
 * @typedef {{path: string, kind: string, name: string, type: string, line: number}} Item  a table of the text
 */

const escape_words = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** Value of a key as a form shows it: a plain string of TOML without its quotes. @param {string} text */
const to_shown = (text) => /^"([^"\\]*)"$|^'([^']*)'$/.exec(text)?.slice(1).find((part) => part !== undefined) ?? text;

// A value with blanks outside brackets and quotes is one word of a command in quotes.
const to_word = (value) => (/^["'[{]/.test(value) || !/\s/.test(value) ? value : `"${value.replaceAll('"', "")}"`);

export function make_add_form(studio, view) {
  const host = el("div", { class: "fields" });
  const tables = el("select", { "aria-label": "table of the form" });
  /** @type {Map<string, HTMLInputElement | HTMLSelectElement>} */
  const fields = new Map();
  /** @type {Kind[]} */
  let all = [];
  /** @type {Item[]} */
  let items = [];
  /** @type {Item | null} the table that is changed; null: a new one */
  let item = null;
  /** @type {Map<string, string>} what its fields showed first */
  let before = new Map();
  let was_added = false, shown_text = "", next = "";
  let is_end_chosen = false;
  let end = "parent";  // which end of a hinge a click in the scene fills in
  const list_names = (kind) => items.filter((i) => i.kind === kind && i.name).map((i) => i.name);
  const get_value = (name) => fields.get(name)?.value ?? "";

  const get_choices = (kind, key) => {
    if (["parent", "child", "body", "to_body"].includes(key.name)) return [...(key.name === "parent" ? ["ground"] : []), ...list_names("body")];
    if (["hinge", "function"].includes(key.name)) return list_names(key.name);
    if (key.name === "file" && kind.kind === "body") return studio.files.filter((f) => f.kind === "bough-flexbody").map((f) => view.get_path(f.name));
    return key.choices;
  };
  /** @param {Kind} kind @param {Key} key @param {string} value */
  const add_field = (kind, key, value = "") => {
    const choices = get_choices(kind, key), title = key.description, name = key.name;
    const field = /** @type {HTMLInputElement | HTMLSelectElement} */ (choices.length > 0
      ? el("select", { name, title, required: key.required }, el("option", { value: "" }, key.required ? "choose …" : key.default ? `default: ${key.default}` : "none"), ...[...new Set([...choices, ...(value ? [value] : [])])].map((c) => el("option", { value: c }, c)))
      : el("input", { type: "text", name, placeholder: kExamples[`${kind.kind}.${name}`] ?? (key.default || key.type), title, required: key.required }));
    field.value = value;
    fields.set(name, field);
    const along = name.startsWith("axis") ? [el("span", { class: "along" }, ...Object.entries(kAxes).map(([axis, text]) => make_button(axis, `Along ${axis}`, () => (field.value = text))))] : [];
    host.append(el("label", {}, name + " ", field), ...along);
  };
  // A new hinge holds the first body that no hinge has as its child: on the parent of the last hinge, else on the first
  // other body, or the ground.
  const set_hinge = (values) => {
    const bodies = list_names("body"), child = bodies.find((name) => !new RegExp(`^\\s*child\\s*=\\s*["']${escape_words(name)}["']`, "m").test(view.pane.text));
    const others = bodies.filter((name) => name !== child), parents = [...view.pane.text.matchAll(/^\s*parent\s*=\s*["'](.*?)["']/gm)].map((m) => m[1]);
    values.set("type", "revolute").set("parent", child && others.length > 0 ? (parents.filter((name) => others.includes(name)).pop() ?? others[0]) : "ground");
    return child ? values.set("child", child) : values;
  };
  // Names that were added after the form was shown.
  const refresh_choices = () => {
    const kind = all.find((k) => k.kind === (item ? item.kind : tables.selectedOptions[0]?.dataset.kind));
    for (const [name, field] of fields) {
      const key = kind?.keys.find((k) => k.name === name);
      if (!kind || !key || field.tagName !== "SELECT") continue;
      const there = new Set([.../** @type {HTMLSelectElement} */ (field).options].map((o) => o.value));
      field.append(...get_choices(kind, key).filter((c) => !there.has(c)).map((c) => el("option", { value: c }, c)));
    }
  };
  const make_name = (kind) => {
    let k = 1;
    while (items.some((i) => i.name === kind + k)) ++k;
    return kind + k;
  };
  const list_shown = (kind, values) => {
    const first = kCommon[kind.kind] ?? ["name"], order = (k) => (first.includes(k.name) ? first.indexOf(k.name) : 99);
    return kind.keys.filter((k) => k.required || first.includes(k.name) || values.has(k.name)).sort((a, b) => order(a) - order(b));
  };
  /** @param {Kind} kind @param {Map<string, string>} values */
  const show_fields = (kind, values) => {
    host.replaceChildren();
    fields.clear();
    before = values;
    const shown = list_shown(kind, values);
    for (const key of shown) add_field(kind, key, values.get(key.name));
    const rest = kind.keys.filter((k) => !shown.includes(k));
    if (rest.length > 0) {
      const more = el("select", { "aria-label": "another key" }, el("option", { value: "" }, "another key …"), ...rest.map((k) => el("option", { value: k.name }, k.name)));
      more.addEventListener("change", () => {
        const name = more.value;
        add_field(kind, /** @type {Key} */ (rest.find((k) => k.name === name)));
        more.selectedOptions[0].remove();
        more.value = "";
        host.append(more);  // below the new field
        fields.get(name)?.focus();
      });
      host.append(more);
    }
    ends.hidden = !fields.has("parent");
    hint.hidden = ends.hidden && !(fields.has("body") && fields.has("node"));
    set_end(ends.hidden || (get_value("parent") && get_value("parent") !== "ground") || !item && list_names("body").length > 1 ? "parent" : "child");
  };
  const is_shown = (values) => fields.size > 0 && values.size === before.size && [...values].every(([name, text]) => before.get(name) === text);
  /** @param {boolean} is_refresh  the same table after a change of the text: a form that has its values stays */
  const show = (is_refresh = false) => studio.attempt(async () => {
    const at = Number(tables.value);
    item = at < 0 ? null : (items[at] ?? null);
    const kind = all.find((k) => k.kind === (item ? item.kind : tables.selectedOptions[0]?.dataset.kind));
    add_button.textContent = item ? "Change" : "Add";
    delete_button.hidden = !item || !kind?.list;
    if (!kind) return host.replaceChildren();
    if (!item) {
      const values = new Map(kind.keys.some((k) => k.name === "name") ? [["name", make_name(kind.kind)]] : []);
      return show_fields(kind, kind.kind === "hinge" ? set_hinge(values) : values);
    }
    const { path } = item, { values } = await ask("table", { text: view.pane.text, path });
    const shown = new Map(Object.entries(values).map(([name, text]) => /** @type {[string, string]} */ ([name, to_shown(text)])));
    if (item?.path === path && !(is_refresh && is_shown(shown))) show_fields(kind, shown);
  });
  const apply = () => studio.attempt(async () => {
    const kind = all.find((k) => k.kind === (item ? item.kind : tables.selectedOptions[0].dataset.kind));
    const now = [...fields].map(([key, f]) => /** @type {[string, string]} */ ([key, f.value.trim()]));
    if (!item) {
      const words = now.filter(([, v]) => v !== "").map(([key, v]) => `${key}=${to_word(v)}`);
      was_added = true;
      // The next thing that a body needs is its hinge.
      next = kind?.kind === "body" && list_names("body").length > 0 ? "hinge" : "";
      await view.pane.edit([`add ${kind?.kind} ${words.join(" ")}`]);
      return;
    }
    const changed = now.filter(([key, v]) => v !== (before.get(key) ?? "")), name = changed.find(([key]) => key === "name");
    const set = changed.filter(([key, v]) => key !== "name" && v !== ""), lost = changed.filter(([key, v]) => key !== "name" && v === "");
    const commands = lost.map(([key]) => `unset ${item.path}.${key}`);
    if (set.length > 0) commands.push(`set ${set.map(([key, v]) => `${item.path}.${key}=${to_word(v)}`).join(" ")}`);
    if (name) commands.push(`rename ${item.path} ${to_word(name[1])}`);
    if (commands.length === 0) return;
    await view.pane.edit(commands);
    before = new Map(now.filter(([, v]) => v !== ""));
  });
  const remove = () => studio.attempt(async () => {
    if (!item) return;
    const { path } = item;
    item = null;
    was_added = true;
    await view.pane.edit([`delete ${path}`]);
  });

  const add_button = Object.assign(make_button("Add", "Writes the table into the text; Undo takes it back", apply), { className: "main add" });
  const delete_button = Object.assign(make_button("Delete", "Takes the table out of the text", remove), { className: "delete", hidden: true });
  const radios = ["parent", "child"].map((name) => el("input", { type: "radio", name: "end-of-hinge", value: name, onchange: () => ([end, is_end_chosen] = [name, true]) }));
  const set_end = (name) => {
    [end, is_end_chosen] = [name, false];
    for (const radio of radios) radio.checked = radio.value === name;
  };
  const ends = el("span", { class: "ends", hidden: true, role: "radiogroup", "aria-label": "end that a click fills in" }, "a click is the ", ...radios.map((radio) => el("label", {}, radio, ` ${radio.value} `)));
  const hint = el("p", { class: "note", hidden: true }, "A click on a node in the scene fills in its body and its number.");
  const fold = el("details", { class: "add-form" }, el("summary", {}, "Add or change a body, hinge, force, sensor …"), el("div", { class: "tools" }, tables, add_button, delete_button, ends), hint, host);
  tables.addEventListener("change", () => show());

  /** The lists of new and of present tables; the chosen one stays chosen. */
  const fill_list = () => {
    const chosen = item?.path, kind = tables.selectedOptions[0]?.dataset.kind;
    const rank = (k) => (kFirst.includes(k.kind) ? kFirst.indexOf(k.kind) : 99);
    const fresh = all.filter((k) => k.list).sort((a, b) => rank(a) - rank(b)).map((k) => el("option", { value: -1, "data-kind": k.kind, title: k.description }, k.kind));
    const present = items.flatMap((i, k) => (all.some((one) => one.kind === i.kind) ? [el("option", { value: k, "data-path": i.path }, i.name ? `${i.kind} ${i.name}` : i.path)] : []));
    tables.replaceChildren(el("optgroup", { label: "new" }, ...fresh), el("optgroup", { label: "change" }, ...present));
    const option = present.find((o) => o.dataset.path === chosen) ?? fresh.find((o) => o.dataset.kind === kind);
    if (option) option.selected = true;
  };
  fold.addEventListener("toggle", () => fold.open && all.length === 0 && studio.attempt(async () => {
    all = (await ask("schema", { kind: "system" })).kinds;
    fill_list();
    await show();
  }));
  /** The node that was clicked. */
  const take = (body, node) => {
    const put = (name, value) => {
      const field = fields.get(name);
      if (field) field.value = value;
    };
    if (!fields.has("parent")) {
      put("body", body);
      put("node", node);
      return;
    }
    // A body that is at one end already gets its node there, unless the end was chosen.
    const at = is_end_chosen ? undefined : ["child", "parent"].find((name) => get_value(name) === body);
    if (at) return put(`${at}_node`, node);
    put(end, body);
    put(`${end}_node`, node);
    set_end(end === "parent" || get_value("parent") === "ground" ? "child" : "parent");
  };
  const update = (answer) => {
    if (answer.items?.length > 0) items = answer.items;  // none: the text is no TOML at the moment
    if (all.length === 0 || view.pane.text === shown_text) return;
    shown_text = view.pane.text;
    fill_list();
    const wanted = was_added && next ? [...tables.options].find((o) => o.dataset.kind === next) : null;
    if (wanted) wanted.selected = true;
    next = "";
    refresh_choices();
    if (item || was_added) show(Boolean(item));
    was_added = false;
  };
  return { element: fold, take, update };
}
