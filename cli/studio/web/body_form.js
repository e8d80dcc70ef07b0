// From picked grids and a few choices to a body file and a first system file: the texts of bough init, then edited by
// the commands of bough edit.
import { StudioError, ask, history } from "./api.js";
import { el, make_button, make_check, make_select } from "./page_parts.js";
import { save_text } from "./parts.js";

const kFrames = ["as the deck", "fixed", "free", "mean"];
const kBases = ["normal", "craig-bampton", "craig-chang"];
const kJoints = ["as the deck", "revolute hinge at the first grid"];


/** @param {(grids: number[]) => void} on_change  called with the chosen grids */
export function make_body_form(studio, deck, on_change) {
  const grids = [];
  let frame = 0, basis = 0, joint = 0, is_picking = true;
  const list = el("output", { class: "chosen", "aria-label": "interface nodes" });
  const number = el("input", { type: "number", min: 0, max: 1000, step: 1, placeholder: "of the deck", "aria-label": "number of modes" });
  const update = () => {
    list.replaceChildren(...(grids.length === 0 ? [el("span", { class: "note" }, "none: click grids, or find one by its id")] : grids.map((g) => make_button(`${g} ✕`, "Leave this grid out", () => {
      grids.splice(grids.indexOf(g), 1);
      update();
    }))));
    on_change(grids);
  };
  const make_texts = async () => {
    const { files } = await ask("start", { file: deck, hinge: joint === 1 ? (grids[0] ?? 0) : 0 });
    const commands = [];
    // bough init writes "fixed" for each deck whose constraints hold the body, as long as no hinge does.
    if (kFrames[frame] === "fixed" && joint === 0 && !/^frame = "fixed"/m.test(files[0].text))
      throw new StudioError([{ severity: "error", id: "", file: "", line: 0, what: `no constraints that ${deck} selects hold the body, as frame "fixed" needs`, advice: "choose frame free or mean, or give the deck SPC cards and SPC = n in its case control" }]);
    if (frame > 0) commands.push(`set body.frame=${kFrames[frame]}`);
    if (grids.length > 0) commands.push(`set body.interface=[${grids.join(", ")}]`);
    if (basis > 0) commands.push(`set body.modes.basis=${kBases[basis]}`);
    if (Number(number.value) >= 0 && number.value !== "") commands.push(`set body.modes.number=${Number(number.value)}`);
    let start = files[0].text;
    // Comments of bough init that the choices make untrue: the list to be filled in, where the number comes from.
    if (grids.length > 0) start = start.replace(/^# interface = .*\n/m, "");
    if (number.value !== "") start = start.replace(/^(number = \d+) +# as .*$/m, "$1");
    const { text } = await ask("edit", { file: files[0].name, text: start, kind: "body", commands });
    return { body: { name: files[0].name, text }, system: files[1] };
  };
  const make = () => studio.attempt(async () => {
    button.disabled = true;  // the texts take a moment
    const { body, system } = await make_texts().finally(() => (button.disabled = false));
    const known = await ask("read", { file: body.name }).catch(() => ({ text: "", hash: "" }));
    const is_there = await ask("read", { file: system.name }).then(() => true, () => false);
    const saved = await save_text(body.name, known.text, body.text, known.hash, is_there ? [] : [{ file: system.name, text: system.text }]);
    if (!saved) return;
    // bough init would not overwrite these files, and their later edits are in them: no command makes them again.
    history.push(`# ${[body.name, ...(is_there ? [] : [system.name])].join(" and ")}: made from ${deck}, in this folder`);
    await studio.refresh();
    await studio.open(body.name);
  });
  const button = Object.assign(make_button("Make body file …", "Shows the file before it is written", make), { className: "main make-body" });
  const element = el("section", { class: "body-form" }, el("h3", {}, "Make a body"),
    el("div", { class: "tools" }, make_check("a click adds an interface node", true, (on) => (is_picking = on))),
    el("div", { class: "row" }, "interface ", list),
    el("div", { class: "tools" }, make_select("frame", kFrames, (i) => (frame = i)), make_select("basis", kBases, (i) => (basis = i)), el("label", {}, "modes ", number)),
    el("div", { class: "tools" }, make_select("in the system", kJoints, (i) => (joint = i)), button));
  update();
  /** @param {number} grid  @param {boolean} is_asked  clicks count by the check box, a button always */
  const take = (grid, is_asked = false) => {
    if (!(is_picking || is_asked) || grids.includes(grid)) return;
    grids.push(grid);
    update();
  };
  return { element, take };
}
