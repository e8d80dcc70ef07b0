// The block diagram of a system and the curves of its functions; a click goes to the line in the text.
import { ask } from "./api.js";
import { Chart } from "./chart.js";
import { Connections, is_editable } from "./connections.js";
import { CurveEditor } from "./curve_editor.js";
import { lay_out } from "./diagram_layout.js";
import { list_handles } from "./function_handles.js";
import { el, make_button } from "./page_parts.js";

const kNamespace = "http://www.w3.org/2000/svg";
function svg(tag, attributes, ...children) {
  const element = document.createElementNS(kNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// Blocks with an output, and blocks that a [[connect]] may end at.
const kSources = ["sensor", "controller", "actuator", "function", "input"], kTargets = ["controller", "actuator", "force"];
const kMarks = { push: "wide", measurement: "dashed", hinge: "mount", constraint: "mount", element: "dotted", event: "dotted", signal: "" };

/** A smooth curve through the points, level at both ends. @param {number[][]} points */
function make_path(points) {
  let path = `M ${points[0][0]} ${points[0][1]}`;
  for (let i = 1; i < points.length; ++i) {
    const [[x0, y0], [x1, y1]] = [points[i - 1], points[i]], middle = (x0 + x1) / 2;
    path += ` C ${middle} ${y0}, ${middle} ${y1}, ${x1} ${y1}`;
  }
  return path;
}

function draw_node(node, box) {
  const { x, y, width, height, lines } = box;
  const round = { function: 12, input: 12, event: 12, body: 0 }[node.kind] ?? 4;
  const hint = kSources.includes(node.kind) ? "; drag to another block, or c: connect" : "";
  return svg("g", { class: `block ${node.kind}`, tabindex: "0", role: "button", "aria-label": `${node.kind} ${node.name}`, "data-node": node.id },
    svg("title", {}, document.createTextNode(`${node.kind} ${node.name}${node.line > 0 ? `, line ${node.line}` : ""}${hint}`)),
    svg("rect", { x, y, width, height, rx: round }),
    ...lines.map((line, i) => svg("text", { x: x + width / 2, y: y + 18 + 15 * i, class: i === 0 ? "name" : "" }, document.createTextNode(line))),
    ...(kSources.includes(node.kind) ? [svg("circle", { cx: x + width, cy: y + height / 2, r: 4, class: "port" })] : []));
}

const describe = (edge) => `${edge.from} → ${edge.to}${edge.label ? ": " + edge.label : ""}`;

/** @param {{nodes: any[], edges: any[]}} diagram */
export function draw_diagram({ nodes, edges }) {
  const { boxes, paths, width, height } = lay_out(nodes, edges);
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, class: "diagram", role: "group", "aria-label": "block diagram" },
    svg("defs", {}, svg("marker", { id: "arrow", viewBox: "0 0 8 8", refX: 8, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" }, svg("path", { d: "M 0 0 L 8 4 L 0 8 z" }))));
  picture.style.minWidth = `${Math.round(0.65 * width)}px`;  // smaller it could not be read: it is scrolled
  for (const { edge, points } of paths) {
    const is_mount = kMarks[edge.link] === "mount", d = make_path(points);
    const wire = svg("path", { d, class: `wire ${kMarks[edge.link]}`, ...(is_mount ? {} : { "marker-end": "url(#arrow)" }) });
    const title = svg("title", {}, document.createTextNode(describe(edge) + (is_editable(edge) ? "; Delete: take it away" : "")));
    if (is_editable(edge)) picture.append(svg("g", { class: "connection", tabindex: "0", role: "button", "aria-label": `connection ${describe(edge)}`, "data-edge": edges.indexOf(edge) }, title, wire, svg("path", { d, class: "reach" })));
    else picture.append(svg("g", {}, title, wire));
    if (!edge.label) continue;
    // In the first gap that the edge crosses.
    const [[x0, y0], [x1, y1]] = points;
    picture.append(svg("text", { x: (x0 + x1) / 2, y: (y0 + y1) / 2 - 3, class: "wire-label" }, document.createTextNode(edge.label)));
  }
  for (const node of nodes) picture.append(draw_node(node, boxes.get(node.id)));
  return picture;
}

/** Two folded panels of the system view, filled when they are opened and with each valid text. */
export class DiagramPanels {
  constructor(studio, view) {
    this.studio = studio;
    this.view = view;
    this.diagram = el("div", { class: "diagram-host", tabindex: "0" });
    this.connections = new Connections(studio, view, this.diagram);
    this.curves = el("div", { class: "function-curves" });
    /** By name of the function. @type {Map<string, CurveEditor>} */
    this.editors = new Map();
    const fold = (name, title, host) => {
      const details = el("details", { class: `panel ${name}` }, el("summary", {}, title), host);
      details.addEventListener("toggle", () => details.open && this.update());
      return details;
    };
    this.folds = [fold("block-diagram", "Block diagram", el("div", {}, this.connections.element, this.diagram)), fold("functions", "Functions", this.curves)];
    this.element = el("div", {}, ...this.folds);
  }

  /** After each check, and when a panel is opened. A text that cannot be drawn leaves the picture before. */
  async update() {
    const text = this.view.pane.text;
    if (text === this.drawn || !this.folds.some((f) => f.open)) return;
    const answer = await ask("diagram", { file: this.view.file, text }).catch(() => null);
    if (!answer || text !== this.view.pane.text || [...this.editors.values()].some((e) => e.pending > 0)) return;
    this.drawn = text;
    const go = (line) => this.view.pane.editor.go(line);
    this.diagram.replaceChildren(answer.nodes.length > 0 ? draw_diagram(answer) : el("p", { class: "note" }, "The system has no blocks."));
    this.connections.attach(answer, go);
    this.diagram.dataset.blocks = String(answer.nodes.length);
    this.curves.replaceChildren(...answer.functions.map((f) => this.draw_function(f, go)));
    for (const editor of this.editors.values()) editor.settle();
    if (answer.functions.length === 0) this.curves.append(el("p", { class: "note" }, "The file has no [[function]]; one is added by the form on the left."));
    this.curves.dataset.count = String(answer.functions.length);
  }

  draw_function(curve, go) {
    const { name, type, of_time, line, x, y, values } = curve;
    if (values && list_handles(type, values, x).length > 0) {
      const editor = new CurveEditor(this.view, curve, this.editors.get(name));
      this.editors.set(name, editor);
      return el("div", {}, make_button(`${name}: line ${line}`, "Go to the function in the text", () => go(line)), editor.element);
    }
    const chart = new Chart({ title: "", series: [{ name: `${name} (${type})`, x: Float64Array.from(x), y: Float64Array.from(y, (v) => v ?? NaN) }], x_label: of_time ? "time" : "argument", y_label: name, height: 170 });
    return el("div", {}, make_button(`${name}: line ${line}`, "Go to the function in the text", () => go(line)), chart.element);
  }
}
