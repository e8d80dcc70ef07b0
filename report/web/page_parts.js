// Elements, controls, colours.
import { write_powers } from "./numbers.js";

// el("button", { class: "x", onclick: f }, "text", child): attributes, functions as listeners, children.
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

export function make_button(text, title, action) {
  return el("button", { type: "button", title, onclick: action }, text);
}

export function make_check(text, is_on, action) {
  const box = el("input", { type: "checkbox", checked: is_on });
  box.addEventListener("change", () => action(box.checked));
  return el("label", {}, box, " " + text);
}

export function make_slider(text, { min, max, step, value }, action) {
  const slider = el("input", { type: "range", min, max, step, value, "aria-label": text });
  const shown = el("output");
  const update = () => {
    shown.textContent = action(Number(slider.value)) ?? "";
  };
  slider.addEventListener("input", update);
  update();
  return Object.assign(el("label", { class: "slider" }, text + " ", slider, " ", shown), { slider, update });
}

// Options are names, or [group, name] with the names of a group one after the other.
export function make_select(text, options, action) {
  const list = el("select", { "aria-label": text });
  let group = "", host = list;
  options.forEach((entry, i) => {
    const [of, name] = Array.isArray(entry) ? entry : ["", entry];
    if (of !== group) {
      group = of;
      host = of ? el("optgroup", { label: of }) : list;
      if (of) list.append(host);
    }
    host.append(el("option", { value: i }, name));
  });
  list.addEventListener("change", () => action(Number(list.value)));
  return Object.assign(el("label", {}, text + " ", list), { list });
}

// Colours from `low` to `high` with numbers: update(low, high, what).
export function make_color_bar() {
  const what = el("span"), low = el("span"), middle = el("span"), high = el("span");
  const element = el("div", { class: "color-bar" }, what, el("div", { class: "ramp", "aria-hidden": "true" }), el("div", { class: "ends" }, low, middle, high));
  const update = (from, to, name, format) => {
    [low.textContent, middle.textContent, high.textContent] = [from, (from + to) / 2, to].map(format);
    what.textContent = write_powers(name);
  };
  return { element, update };
}

// Okabe & Ito without yellow; in the dark the black one is white. Each seven curves another dash.
const kColors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"];
const kDarkColors = ["#4aa8e0", "#f0803c", "#2cc79a", "#e29cc4", "#8fd0f5", "#f2b83a", "#ffffff"];
const kDashes = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

// Asked of the page once a theme: a picture asks hundreds of times, and the page would be laid out again each time.
const known = new Map();
const ask_once = (name, ask) => known.get(name) ?? (known.set(name, ask()), known.get(name));

export const is_dark = () => ask_once("is dark", () => {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
});

export function get_style(index) {
  const colors = is_dark() ? kDarkColors : kColors;
  return { color: colors[index % colors.length], dash: kDashes[Math.floor(index / colors.length) % kDashes.length] };
}

export const get_css = (name) => ask_once(name, () => getComputedStyle(document.documentElement).getPropertyValue(name).trim());

const repainters = [];
// What is to be drawn again when the theme changes.
export const on_theme = (draw) => repainters.push(draw);

// A square in the colour of a curve or body, of a legend.
export function make_swatch(index) {
  const swatch = el("span", { class: "swatch" }), paint = () => (swatch.style.background = get_style(index).color);
  paint();
  on_theme(paint);
  return swatch;
}

// "light", "dark", or undefined: as the reader's system has it.
export function set_theme(theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  repaint();
}

function repaint() {
  known.clear();
  for (const draw of repainters) draw();
}

export function make_theme_button() {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  return make_button("Light / dark", "Change the colours of the page", () => set_theme(is_dark() ? "light" : "dark"));
}

// "tip_deflection:y [m]" -> "tip_deflection-y-m.png"
export function make_file_name(what, ending) {
  const words = what.replace(/[^\p{L}\p{N}_.]+/gu, "-").replace(/^-+|-+$/g, "");
  return (words.slice(0, 80) || "picture") + "." + ending;
}

export function save_blob(blob, name) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
