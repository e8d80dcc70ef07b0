// Tables of a system file by a form: kinds and keys come from the schema, the text from the commands of bough edit.
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
};

export function make_add_form(studio, view) {
  const host = el("div", { class: "fields" });
  const kinds = el("select", { "aria-label": "kind of table" });
  const fields = new Map();
  let all = [], items = [];
  const list_names = (kind) => items.filter((i) => i.kind === kind && i.name).map((i) => i.name);

  const add_field = (kind, key) => {
    const names = ["parent", "child", "body", "to_body"].includes(key.name) ? [...(key.name === "parent" ? ["ground"] : []), ...list_names("body")] : key.name === "hinge" ? list_names("hinge") : key.name === "function" ? list_names("function") : key.name === "file" && kind.kind === "body" ? studio.files.filter((f) => f.kind === "bough-flexbody").map((f) => view.get_path(f.name)) : key.choices;
    const id = `choices-${kind.kind}-${key.name}`;
    const field = el("input", { type: "text", name: key.name, placeholder: key.default || key.type, title: key.description, list: names.length > 0 ? id : undefined, required: key.required });
    fields.set(key.name, field);
    host.append(el("label", {}, key.name + " ", field, names.length > 0 ? el("datalist", { id }, ...names.map((n) => el("option", { value: n }))) : ""));
  };
  const show = () => {
    const kind = all[Number(kinds.value)];
    host.replaceChildren();
    fields.clear();
    if (!kind) return;
    const first = kCommon[kind.kind] ?? ["name"];
    const is_first = (k) => k.required || first.includes(k.name);
    const order = (k) => (first.includes(k.name) ? first.indexOf(k.name) : 99);
    for (const key of kind.keys.filter(is_first).sort((a, b) => order(a) - order(b))) add_field(kind, key);
    const rest = kind.keys.filter((k) => !is_first(k));
    if (rest.length > 0) {
      const more = el("select", { "aria-label": "another key" }, el("option", { value: "" }, "another key …"), ...rest.map((k) => el("option", { value: k.name }, k.name)));
      more.addEventListener("change", () => {
        const name = more.value;
        add_field(kind, rest.find((k) => k.name === name));
        more.selectedOptions[0].remove();
        more.value = "";
        host.append(more);  // below the new field
        fields.get(name).focus();
      });
      host.append(more);
    }
  };
  const add = () => studio.attempt(async () => {
    const kind = all[Number(kinds.value)];
    const words = [...fields].filter(([, f]) => f.value.trim() !== "").map(([key, f]) => `${key}=${to_word(f.value.trim())}`);
    await view.pane.edit([`add ${kind.kind} ${words.join(" ")}`]);
    show();
  });
  const fold = el("details", { class: "add-form" }, el("summary", {}, "Add a body, hinge, force, sensor …"), el("div", { class: "tools" }, kinds, Object.assign(make_button("Add", "Adds the table to the text", add), { className: "main add" })), el("p", { class: "note" }, "A click on a node in the scene fills in its body and its number: parent, then child."), host);
  kinds.addEventListener("change", show);
  fold.addEventListener("toggle", () => fold.open && all.length === 0 && studio.attempt(async () => {
    const answer = await ask("schema", { kind: "system" });
    const rank = (k) => (kFirst.includes(k.kind) ? kFirst.indexOf(k.kind) : 99);
    all = answer.kinds.filter((k) => k.list).sort((a, b) => rank(a) - rank(b));
    kinds.replaceChildren(...all.map((k, i) => el("option", { value: i, title: k.description }, k.kind)));
    show();
  }));
  /** The node that was clicked: of a hinge first the parent, then the child. */
  const take = (body, node) => {
    const put = (name, value) => fields.has(name) && (fields.get(name).value = value);
    if (fields.has("parent") && (!fields.get("parent").value || fields.get("child").value)) {
      put("parent", body);
      put("parent_node", node);
      put("child", "");
      put("child_node", "");
    } else if (fields.has("child")) {
      put("child", body);
      put("child_node", node);
    } else {
      put("body", body);
      put("node", node);
    }
  };
  const update = (answer) => {
    items = answer.items ?? [];
  };
  return { element: fold, take, update };
}

// A value with blanks outside brackets and quotes is one word of a command in quotes.
const to_word = (value) => (/^["'[{]/.test(value) || !/\s/.test(value) ? value : `"${value.replaceAll('"', "")}"`);
