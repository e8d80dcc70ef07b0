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
const kExamples = { "body.inertia": "[Ixx, Iyy, Izz] about cg" };
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

/** Types of the table that a key belongs to: its description begins with them, "step, pulse: the time …". @param {Key} key @param {string[]} types */
const list_types = (key, types) => {
  const words = /^([\w, ]+):/.exec(key.description)?.[1].split(", ") ?? [];
  return words.every((word) => types.includes(word)) ? words : [];
};

/** What a key means; a key in degrees has the description of the one in radians. @param {Kind} kind @param {Key} key */
const describe_key = (kind, key) => {
  const other = key.name.endsWith("_deg") ? kind.keys.find((k) => `${k.name}_deg` === key.name) : undefined;
  return key.description || (other ? `${other.description} Here in degrees.` : "");
};

/** What an empty field shows. @param {Kind} kind @param {Key} key */
const get_example = (kind, key) => kExamples[`${kind.kind}.${key.name}`] ?? (key.default && key.default !== "[0,0,0]" ? key.default : key.type === "array of 3" ? "[x, y, z]" : key.default || key.type);

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
  let given_name = "";  // of a new table, by the form
  let was_added = false, shown_text = "", next = "";
  let is_end_chosen = false;
  /** Keys that are shown because of the type. @type {Set<string>} */
  const of_type = new Set();
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
    const choices = get_choices(kind, key), title = describe_key(kind, key), name = key.name;
    const field = /** @type {HTMLInputElement | HTMLSelectElement} */ (choices.length > 0
      ? el("select", { name, title, required: key.required }, el("option", { value: "" }, key.required ? "choose …" : key.default ? `default: ${key.default}` : "none"), ...[...new Set([...choices, ...(value ? [value] : [])])].map((c) => el("option", { value: c }, c)))
      : el("input", { type: "text", name, placeholder: get_example(kind, key), title, required: key.required }));
    field.value = value;
    fields.set(name, field);
    const along = name.startsWith("axis") ? [el("span", { class: "along" }, ...Object.entries(kAxes).map(([axis, text]) => make_button(axis, `Along ${axis}`, () => (field.value = text))))] : [];
    more.before(el("label", {}, name + " ", field), ...along);
    if (name === "type") field.addEventListener("change", () => follow_type(kind));
    if (kind.kind === "body" && name === "file") field.addEventListener("change", () => name_by_file(field.value));
  };
  // The list of further keys. A letter or an arrow key chooses in the closed list before the key is the wanted one: then
  // Enter takes it, or leaving the list.
  const more = el("select", { "aria-label": "another key", title: "A further key of the table; Enter takes it" });
  let is_by_key = false;
  const list_rest = (kind) => {
    const rest = kind.keys.filter((k) => !fields.has(k.name));
    more.replaceChildren(el("option", { value: "" }, "another key …"), ...rest.map((k) => el("option", { value: k.name, title: describe_key(kind, k) }, k.name)));
    more.hidden = rest.length === 0;
  };
  const take_key = (is_left = false) => {
    const kind = get_kind(), key = kind?.keys.find((k) => k.name === more.value);
    if (!kind || !key) return;
    add_field(kind, key);
    list_rest(kind);
    is_by_key = false;
    if (!is_left) fields.get(key.name)?.focus();
  };
  more.addEventListener("pointerdown", () => (is_by_key = false));
  more.addEventListener("keydown", (event) => {
    is_by_key = ![" ", "F4"].includes(event.key) && !event.altKey;  // these open the list
    if (event.key !== "Enter" || !more.value) return;
    event.preventDefault();
    take_key();
  });
  more.addEventListener("change", () => !is_by_key && take_key());
  more.addEventListener("blur", () => is_by_key && take_key(true));
  /** Fields of the keys of the type that is chosen; those of the type before go if they are empty. @param {Kind} kind */
  const follow_type = (kind) => {
    const type = get_value("type"), types = kind.keys.find((k) => k.name === "type")?.choices ?? [];
    const wanted = type ? kind.keys.filter((k) => list_types(k, types).includes(type)) : [];
    for (const name of of_type) {
      if (wanted.some((k) => k.name === name) || get_value(name) !== "") continue;
      fields.get(name)?.closest("label")?.remove();
      fields.delete(name);
      of_type.delete(name);
    }
    for (const key of wanted.filter((k) => !fields.has(k.name))) {
      add_field(kind, key);
      of_type.add(key.name);
    }
    list_rest(kind);
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
    const kind = get_kind();
    for (const [name, field] of fields) {
      const key = kind?.keys.find((k) => k.name === name);
      if (!kind || !key || field.tagName !== "SELECT") continue;
      const there = new Set([.../** @type {HTMLSelectElement} */ (field).options].map((o) => o.value));
      field.append(...get_choices(kind, key).filter((c) => !there.has(c)).map((c) => el("option", { value: c }, c)));
    }
  };
  /** The kind of the table in the form. */
  const get_kind = () => all.find((k) => k.kind === (item ? item.kind : tables.selectedOptions[0]?.dataset.kind));
  const make_name = (kind) => {
    let k = 1;
    while (items.some((i) => i.name === kind + k)) ++k;
    return kind + k;
  };
  /** A new body that nobody has named yet gets the name of its file. @param {string} file */
  const name_by_file = (file) => {
    const field = fields.get("name"), stem = file.replace(/^.*\//, "").replace(/\.[^.]*$/, "");
    if (item || !field || !stem || field.value !== given_name) return;
    given_name = items.some((i) => i.kind === "body" && i.name === stem) ? make_name(stem) : stem;
    field.value = given_name;
  };
  const list_shown = (kind, values) => {
    const first = kCommon[kind.kind] ?? ["name"], order = (k) => (first.includes(k.name) ? first.indexOf(k.name) : 99);
    return kind.keys.filter((k) => k.required || first.includes(k.name) || values.has(k.name)).sort((a, b) => order(a) - order(b));
  };
  /** @param {Kind} kind @param {Map<string, string>} values */
  const show_fields = (kind, values) => {
    host.replaceChildren(more);
    fields.clear();
    of_type.clear();
    before = values;
    for (const key of list_shown(kind, values)) add_field(kind, key, values.get(key.name));
    follow_type(kind);
    ends.hidden = !fields.has("parent");
    hint.hidden = ends.hidden && !(fields.has("body") && fields.has("node"));
    view.mark_nodes();
    set_end(ends.hidden || (get_value("parent") && get_value("parent") !== "ground") || !item && list_names("body").length > 1 ? "parent" : "child");
  };
  const is_shown = (values) => fields.size > 0 && values.size === before.size && [...values].every(([name, text]) => before.get(name) === text);
  /** @param {boolean} is_refresh  the same table after a change of the text: a form that has its values stays */
  const show = (is_refresh = false) => studio.attempt(async () => {
    const at = Number(tables.value);
    item = at < 0 ? null : (items[at] ?? null);
    const kind = get_kind();
    add_button.textContent = item ? "Change" : "Add";
    delete_button.hidden = !item || !kind?.list;
    if (!kind) return host.replaceChildren();
    if (!item) {
      given_name = make_name(kind.kind);
      const values = new Map(kind.keys.some((k) => k.name === "name") ? [["name", given_name]] : []);
      return show_fields(kind, kind.kind === "hinge" ? set_hinge(values) : values);
    }
    const { path } = item, { values } = await ask("table", { text: view.pane.text, path });
    const shown = new Map(Object.entries(values).map(([name, text]) => /** @type {[string, string]} */ ([name, to_shown(text)])));
    if (item?.path === path && !(is_refresh && is_shown(shown))) show_fields(kind, shown);
  });
  const apply = () => studio.attempt(async () => {
    const kind = get_kind();
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
  fold.addEventListener("toggle", () => view.mark_nodes());
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
  /** True if the form is open with fields for a node. */
  const takes_nodes = () => fold.open && !hint.hidden;
  return { element: fold, take, update, takes_nodes };
}
