// Connections of the block diagram, made and deleted by mouse and keys. Each change is commands of `bough edit`: a new
// connection is a [[connect]], one that a key names is taken out of that key.
import { el, make_button, make_select } from "./page_parts.js";
import { ask_user } from "./parts.js";

const kSources = ["sensor", "controller", "actuator", "function", "input"], kTargets = ["controller", "actuator", "force"];
const kFar = 6;  // pixels from where a press becomes a drag

/** A prescribed motion is one of a list with a place for each coordinate: it is changed in the text. */
export const is_editable = (edge) => Boolean(edge.table) && edge.key !== "motion";
const quote = (text) => `"${text.replaceAll('"', "")}"`;

export class Connections {
  /** @param {any} studio  @param {any} view  the SystemView  @param {HTMLElement} host  with the picture */
  constructor(studio, view, host) {
    this.studio = studio;
    this.view = view;
    this.host = host;
    this.source = null;  // id of the block from which a connection is being made
    this.erase = make_button("Delete connection", "Takes the chosen connection out of the text (Delete)", () => this.remove(this.chosen));
    this.erase.disabled = true;
    this.status = el("output", { class: "note", "aria-live": "polite" });
    this.element = el("div", { class: "tools" }, this.erase, this.status);
    host.addEventListener("pointerdown", (event) => this.press(event));
    host.addEventListener("keydown", (event) => this.key(event));
    this.say();
  }

  /** A picture that was drawn: its blocks and connections. */
  attach({ nodes, edges }, go) {
    this.nodes = new Map(nodes.map((n) => [n.id, n]));
    this.edges = edges;
    this.go = go;
    this.chosen = null;
    this.erase.disabled = true;
    this.set_source(null);
  }

  say(text = "") {
    this.status.textContent = text || "Drag from a block to another, or press c on both: a connection. A click on a connection chooses it.";
  }

  find_node(target) {
    return this.nodes?.get(target?.closest?.("[data-node]")?.dataset.node) ?? null;
  }

  mark() {
    const list = (name) => /** @type {NodeListOf<HTMLElement>} */ (this.host.querySelectorAll(`[${name}]`));
    for (const group of list("data-edge")) group.classList.toggle("chosen", this.edges[Number(group.dataset.edge)] === this.chosen);
    for (const group of list("data-node")) group.classList.toggle("source", group.dataset.node === this.source);
    this.erase.disabled = !this.chosen;
  }

  set_source(id) {
    this.source = id;
    this.mark();
    this.say(id ? `From ${id}: to which block? c or Enter there, Escape: none.` : "");
  }

  choose(edge) {
    this.chosen = edge;
    this.mark();
    this.say(`${edge.from} → ${edge.to}${edge.label ? ", " + edge.label : ""}: Delete takes it away.`);
  }

  press(event) {
    if (event.button !== 0) return;
    const group = event.target.closest("[data-edge]"), node = this.find_node(event.target);
    if (group) return this.choose(this.edges[Number(group.dataset.edge)]);
    if (!node) return;
    const picture = this.host.querySelector("svg"), matrix = picture.getScreenCTM().inverse();
    const place = (e) => new DOMPoint(e.clientX, e.clientY).matrixTransform(matrix), from = place(event);
    const line = document.createElementNS(picture.namespaceURI, "path");
    line.setAttribute("class", "wire making");
    let is_drag = false;
    const move = (e) => {
      is_drag ||= Math.hypot(e.clientX - event.clientX, e.clientY - event.clientY) > kFar;
      if (!is_drag || !kSources.includes(node.kind)) return;
      if (!line.isConnected) picture.append(line);
      const to = place(e), over = this.find_node(document.elementFromPoint(e.clientX, e.clientY));
      line.setAttribute("d", `M ${from.x} ${from.y} L ${to.x} ${to.y}`);
      this.host.classList.toggle("may-drop", Boolean(over && over !== node && kTargets.includes(over.kind)));
    };
    const end = (e) => {
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
      line.remove();
      this.host.classList.remove("may-drop");
      if (e.type === "pointercancel") return;
      if (!is_drag) return this.act(node);
      const over = this.find_node(document.elementFromPoint(e.clientX, e.clientY));
      if (over && over !== node) this.connect(node, over);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
    event.preventDefault();  // no text is selected
    event.target.closest("[data-node]").focus();
  }

  /** A click or Enter: the end of a connection that is being made, else the line of the text. */
  act(node) {
    if (this.source && this.source !== node.id) return this.connect(this.nodes.get(this.source), node);
    if (node.line > 0) this.go(node.line);
  }

  key(event) {
    const group = event.target.closest("[data-edge]"), node = this.find_node(event.target);
    const is_enter = event.key === "Enter" || event.key === " ";
    if (event.key === "Escape" && this.source) this.set_source(null);
    else if (group && (event.key === "Delete" || event.key === "Backspace")) this.remove(this.edges[Number(group.dataset.edge)]);
    else if (group && is_enter) this.choose(this.edges[Number(group.dataset.edge)]);
    else if (this.chosen && (event.key === "Delete" || event.key === "Backspace")) this.remove(this.chosen);
    else if (node && is_enter) this.act(node);
    else if (node && event.key === "c" && this.source) this.act(node);
    else if (node && event.key === "c") this.begin(node);
    else return;
    event.preventDefault();
  }

  begin(node) {
    if (kSources.includes(node.kind)) this.set_source(node.id);
    else this.say(`${node.kind} ${node.name} has no output.`);
  }

  /** Components of the output of a block, from the run that is shown. */
  list_components({ kind, name }) {
    const path = { sensor: "sensors", controller: "controllers", actuator: "actuators" }[kind];
    const channel = path && this.view.motion?.run.by_path.get(`/${path}/${name}`);
    return channel && channel.columns.length > 1 ? channel.columns.map((c, i) => c.name || String(i + 1)) : [];
  }

  /** Asks for what is not clear from the two blocks, and writes. */
  async connect(from, to) {
    this.set_source(null);
    if (!kSources.includes(from.kind)) return this.say(`${from.kind} ${from.name} has no output.`);
    if (!kTargets.includes(to.kind)) return this.say(`${to.kind} ${to.name} takes no signal: connections end at controllers, actuators and forces.`);
    const components = this.list_components(from), held = to.kind === "controller" ? [] : this.edges.filter((e) => e.to === to.id && is_editable(e));
    const ports = to.kind === "controller" ? ["the next input", "reference", "rate"] : [];
    let component = 0, port = 0;
    const gain = el("input", { type: "number", step: "any", value: 1, "aria-label": "gain" });
    const content = el("div", { class: "tools connect-form" },
      ...(components.length > 0 ? [make_select("component", ["all", ...components], (i) => (component = i))] : []),
      ...(ports.length > 0 ? [make_select("as", ports, (i) => (port = i))] : []), el("label", {}, "gain ", gain),
      ...(held.length > 0 ? [el("p", { class: "note" }, `In place of ${held.map((e) => e.signal).join(", ")}.`)] : []));
    if ((await ask_user(`Connect ${from.name} to ${to.name}`, content, [["connect", "Connect"], ["", "Cancel"]])) !== "connect") return;
    const signal = from.name + (component > 0 ? ":" + components[component - 1] : ""), end = to.name + (port > 0 ? ":" + ports[port] : "");
    const words = [`from=${quote(signal)}`, `to=${quote(end)}`, ...(Number(gain.value) === 1 || gain.value === "" ? [] : [`gain=${Number(gain.value)}`])];
    await this.write([...held.flatMap((e) => this.list_commands(e)), `add connect ${words.join(" ")}`]);
  }

  /** Commands that take a connection out of the text. */
  list_commands(edge) {
    if (edge.key === "from") return [`delete ${edge.table}`];
    const path = `${edge.table}.${edge.key}`, others = this.edges.filter((e) => e !== edge && e.table === edge.table && e.key === edge.key);
    return others.length > 0 ? [`set ${path}=[${others.map((e) => quote(e.signal)).join(", ")}]`] : [`unset ${path}`];
  }

  remove(edge) {
    return edge && this.write(this.list_commands(edge));
  }

  write(commands) {
    return this.studio.attempt(() => this.view.pane.edit(commands));
  }
}
