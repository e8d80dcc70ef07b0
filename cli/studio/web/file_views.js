// Views of files that are looked at: results, bodies, modes, linear models, pages.
import { ask, run_job } from "./api.js";
import { make_chapter } from "./chapter_panel.js";
import { el, make_button } from "./page_parts.js";
import { make_message_list, make_progress, show_history } from "./parts.js";

const kComparable = ["bough-flexbody", "bough-modes"];
const stem = (file) => file.replace(/\.[^./]+$/, "");

/** Buttons of what may be done with a file of this kind. */
function make_actions(studio, file, kind, progress) {
  const run = (verb, output, options = []) => () => studio.attempt(async () => {
    const done = await run_job({ verb, files: [file], options: [...options, ["-o", output]] }, progress.update);
    progress.finish(done);
    await studio.refresh();
    if (done.code === 0) await studio.open(output);
  });
  const buttons = [Object.assign(make_button("Save as page", "bough report: one HTML file for any browser", run("report", stem(file) + ".html")), { className: "save-page" })];
  if (kind === "bough-linear") buttons.push(make_button("Frequency response", "bough response: Bode data, largest gain, margins", run("response", stem(file) + "-response.h5")));
  buttons.push(make_button("Copy commands …", "The lines that do the same in a shell", () => show_history()));
  return buttons;
}

export async function open_chapter(studio, file, kind) {
  const { chapter, messages } = await ask("chapter", { file });
  const shown = make_chapter(chapter), progress = make_progress();
  const list = make_message_list(() => {});
  list.show(messages);
  const compare = kComparable.includes(kind) ? make_compare(studio, file, progress, (output) => studio.open(output)) : "";
  const element = el("div", { class: "page" }, el("div", { class: "tools actions" }, ...make_actions(studio, file, kind, progress), compare), progress.element, messages.length > 0 ? list.element : "", shown.element);
  return { element, dispose: shown.dispose };
}

/**
 * MAC and frequencies against another body or modes file.
 * @param {(output: string) => Promise<any>} show  called with the file that was written
 */
export function make_compare(studio, file, progress, show) {
  const list = el("select", { "aria-label": "compare with", title: "bough compare: MAC, differences of the frequencies" });
  const fill = () => {
    const others = studio.files.filter((f) => f.name !== file && kComparable.includes(f.kind)).map((f) => f.name), chosen = list.value;
    list.replaceChildren(...["", ...others].map((name) => el("option", { value: name }, name || (others.length > 0 ? "compare with …" : "compare with … (no other body here)"))));
    list.value = others.includes(chosen) ? chosen : "";
  };
  fill();
  list.addEventListener("focus", fill);  // files that came since
  list.addEventListener("change", () => list.value && studio.attempt(async () => {
    const output = stem(file) + "-comparison.h5";
    const done = await run_job({ verb: "compare", files: [file, list.value], options: [["-o", output]] }, progress.update);
    progress.finish(done);
    await studio.refresh();
    if (done.code === 0) await show(output);
  }));
  return list;
}

/** The text of a file that the studio does not edit. */
export async function open_text(studio, file) {
  const { text } = await ask("read", { file });
  return { element: el("div", { class: "page" }, el("p", { class: "note" }, "This kind of file is shown as text; an editor changes it."), el("pre", { class: "lines", tabindex: "0" }, text)), dispose() {} };
}

/** A page that bough report saved: named, not shown, since its own policy is another one. */
export async function open_report(studio, file) {
  const note = el("p", {}, el("strong", {}, file), " is a page for any browser. Open it from the folder; it needs no program and no network.");
  return { element: el("div", { class: "page saved-page" }, note, el("div", { class: "tools" }, make_button("Copy commands …", "The lines that made it", () => show_history()))), dispose() {} };
}
