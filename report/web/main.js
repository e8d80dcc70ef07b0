import { set_printing } from "./chart.js";
import { ReportChapter, kViews } from "./chapter_views.js";
import { HistoryView, RunSet } from "./history.js";
import { el, make_theme_button, set_theme } from "./page_parts.js";

kViews.overlay = () => new HistoryView(new RunSet([.../** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll('.chapter[data-kind="results"]'))].map((section) => ({ name: section.dataset.title, run: by_section.get(section).run }))));

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
