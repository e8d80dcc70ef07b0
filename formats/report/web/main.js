import { set_printing } from "./chart.js";
import { HistoryView, Run, RunSet, make_fixed_chart } from "./history.js";
import { BodeView, ScatterView, make_poles_chart } from "./linear_view.js";
import { ModesView } from "./modes_view.js";
import { MotionView } from "./motion_view.js";
import { el, make_theme_button, set_theme } from "./page_parts.js";

// What stands in the place of the static picture: data-view of the element -> an object with `element`.
const kViews = {
  history: (chapter) => new HistoryView(chapter.run),
  overlay: () => new HistoryView(new RunSet([...document.querySelectorAll('.chapter[data-kind="results"]')].map((section) => ({ name: section.dataset.title, run: by_section.get(section).run })))),
  motion: (chapter) => new MotionView(chapter.run),
  energy: (chapter) => make_fixed_chart(chapter.run, "Energy", ["kinetic", "strain", "potential", "work", "dissipated"].map((p) => "/energy/" + p)),
  balance: (chapter) => make_fixed_chart(chapter.run, "Error of the energy balance", ["/energy/balance"]),
  "momentum-linear": (chapter) => make_fixed_chart(chapter.run, "Linear momentum", ["/momentum/linear"]),
  "momentum-angular": (chapter) => make_fixed_chart(chapter.run, "Angular momentum", ["/momentum/angular"]),
  modes: (chapter) => new ModesView(chapter.data),
  poles: (chapter) => make_poles_chart(chapter.data),
  bode: (chapter) => new BodeView(chapter.data),
  scatter: (chapter) => new ScatterView(chapter.data),
};

class ReportChapter {
  constructor(text) {
    this.data = JSON.parse(text);
  }
  get run() {
    this.kept ??= new Run(this.data);
    return this.kept;
  }
}

// A view is built when it comes near the screen: long pages open at once.
function build(place, chapter, failures) {
  try {
    const view = kViews[place.dataset.view](chapter);
    place.replaceChildren(view.element);
    place.classList.add("built");
    place.view = view;
    view.draw?.();
  } catch (error) {
    failures.push(`${place.dataset.view}: ${error.message}`);
    place.append(el("p", { class: "note" }, `The living view could not be made: ${error.message}`));
  }
  const root = document.documentElement;
  root.dataset.failures = failures.join("; ");
  root.dataset.built = String(document.querySelectorAll(".built").length);
}

document.querySelector("header").append(make_theme_button());
const failures = [];
const chapters = new Map(), by_section = new Map();
const watcher = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    watcher.unobserve(entry.target);
    build(entry.target, chapters.get(entry.target), failures);
  }
}, { rootMargin: "600px" });
const places = [];
for (const section of document.querySelectorAll(".chapter")) {
  const data = section.querySelector(":scope > script.data");
  if (!data) continue;
  const chapter = new ReportChapter(data.textContent);
  by_section.set(section, chapter);
  for (const place of section.querySelectorAll(".live")) {
    chapters.set(place, chapter);
    places.push(place);
    watcher.observe(place);
  }
}
// Printed whole, and light.
let theme;
addEventListener("beforeprint", () => {
  theme = document.documentElement.dataset.theme;
  for (const place of places) {
    if (place.classList.contains("built")) continue;
    watcher.unobserve(place);
    build(place, chapters.get(place), failures);
  }
  set_printing(true);
  set_theme("light");
});
addEventListener("afterprint", () => {
  set_printing(false);
  set_theme(theme);
});
document.documentElement.dataset.ready = "true";
