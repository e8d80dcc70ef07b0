// A chapter of the report page, with the same interactive views.
import { ReportChapter, kViews } from "./chapter_views.js";
import { el } from "./page_parts.js";

/**
 * @param {string[]} skip  panels that are left out
 * @param {(name: string, view: any, data: ReportChapter) => void} [on_built]  called with each interactive view
 * @returns {{element: HTMLElement, data: ReportChapter | null, dispose: () => void}}
 */
export function make_chapter(chapter, skip = [], on_built = () => {}) {
  const data = chapter.data ? new ReportChapter(chapter.data) : null;
  const views = [];
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      watcher.unobserve(entry.target);
      build(entry.target);
    }
  }, { rootMargin: "400px" });
  const build = (place) => {
    try {
      const view = kViews[place.dataset.view](data);
      place.replaceChildren(view.element);
      place.classList.add("built");
      views.push(view);
      view.draw?.();
      on_built(place.dataset.view, view, data);
    } catch (error) {
      place.append(el("p", { class: "note" }, `The interactive view could not be made: ${error.message}`));
    }
  };
  const badge = (verdict) => el("span", { class: "badge " + verdict }, verdict);
  const checks = chapter.checks.map((c) => el("tr", {}, el("td", {}, badge(c.verdict)), el("td", { class: "text" }, c.what), el("td", {}, c.value), el("td", { class: "text" }, c.note)));
  const facts = (list) => el("dl", { class: "facts" }, ...list.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
  const has_trouble = ["look", "bad"].includes(chapter.verdict);
  const health = checks.length > 0 ? el("details", { open: has_trouble }, el("summary", {}, "Health ", badge(chapter.verdict)), el("table", { class: "health" }, el("tbody", {}, ...checks))) : "";
  const highlights = chapter.highlights.length > 0 ? el("dl", { class: "highlights" }, ...chapter.highlights.slice(0, 3).map((h) => el("div", {}, el("dt", {}, h.name), el("dd", {}, h.value), el("dd", { class: "note" }, h.note)))) : "";
  const panels = chapter.panels.filter((p) => !skip.includes(p.id)).map((p) => {
    const section = el("section", { class: "panel", "data-panel": p.id }, el("h3", {}, p.title));
    const host = el("div");
    host.innerHTML = p.html;  // made by the program, with all text of files escaped; the policy allows no script in it
    section.append(host);
    return section;
  });
  const element = el("div", { class: "chapter" }, highlights, ...panels.slice(0, 1), health, ...panels.slice(1),
    el("details", {}, el("summary", {}, "File and sources"), facts(chapter.facts), facts(chapter.settings)));
  if (data) for (const place of element.querySelectorAll(".live")) watcher.observe(place);
  const dispose = () => {
    watcher.disconnect();
    for (const view of views) {
      view.play?.(false);
      view.viewer?.dispose();
    }
  };
  return { element, data, dispose };
}
