// Poles of a linear model in the studio: a click moves the system in the shape of the pole, and the poles follow the
// parameters while these are dragged.
import { ask } from "./api.js";
import { ReportChapter } from "./chapter_views.js";
import { list_pole_series } from "./linear_view.js";
import { format_number } from "./numbers.js";
import { el, make_select } from "./page_parts.js";

const describe = ({ frequency, damping, mode }, i, unit) => `${format_number(frequency[i], 5)} ${unit}, damping ${format_number(100 * damping[i], 4)} %, ${mode[i]}`;

export class PolePanel {
  /** @param {any} view  the SystemView  @param {any} chart  its chart of poles  @param {ReportChapter} data */
  constructor(view, chart, data, is_at_rest) {
    this.view = view;
    this.chart = chart;
    this.is_at_rest = is_at_rest;
    this.poles = data.data.poles;
    this.unit = data.data.frequency_unit ?? "Hz";
    this.base = list_pole_series(data.data);
    this.trail = { x: [], y: [] };
    chart.on_point = (series, i) => series.name.startsWith("poles") && this.choose(i);
    this.picker = make_select("move in the shape of", [], (k) => (k > 0 ? this.choose(this.upper[k - 1]) : this.stop()));
    this.picker.list.classList.add("pole-picker");
    chart.element.prepend(this.picker);
    this.list_poles();
  }

  /** Fills the list with the poles as they are now: of a pair the one with the positive part; for the keyboard. */
  list_poles() {
    const { list } = this.picker, chosen = list.selectedIndex, before = list.length;
    this.upper = this.poles.index.map((_, i) => i).filter((i) => this.poles.imag[i] >= 0);
    list.replaceChildren(...["no pole", ...this.upper.map((i) => describe(this.poles, i, this.unit))].map((name, i) => el("option", { value: i }, name)));
    if (list.length === before) list.selectedIndex = chosen;
  }

  /** The pole at `i` in the list, or of a pair the one with the positive part, and its motion. @param {number} i */
  choose(i) {
    const { real, imag, index } = this.poles;
    const of_pair = imag[i] >= 0 ? i : this.upper.reduce((best, k) => (Math.hypot(real[k] - real[i], imag[k] + imag[i]) < Math.hypot(real[best] - real[i], imag[best] + imag[i]) ? k : best), this.upper[0]);
    this.picker.list.selectedIndex = 1 + this.upper.indexOf(of_pair);
    return this.show(index[i]);
  }

  /** Ends the motion; the scene is the system at its start again. */
  stop() {
    this.last_shown = (this.last_shown ?? 0) + 1;  // what is asked already is not shown
    this.view.motion?.play(false);
    this.view.picked.textContent = "";
    return this.view.studio.attempt(() => this.view.show_start());
  }

  get request() {
    return { file: this.view.file, text: this.view.pane.text, set: this.view.list_set(), equilibrium: this.is_at_rest };
  }

  /** The scene moves in the shape of the pole until another run or pole is shown; of several requests the last one. */
  show(pole) {
    const number = (this.last_shown = (this.last_shown ?? 0) + 1);
    return this.view.studio.attempt(async () => {
      await this.following;
      if (number !== this.last_shown) return;
      const { poles } = this, i = poles.index.indexOf(pole);
      if (i < 0) return;
      const { chapter } = await ask("pole-motion", { ...this.request, pole });
      if (number !== this.last_shown || this.view.poles !== this) return;
      this.view.show_scene(new ReportChapter(chapter.data).run, false, true);
      const motion = this.view.motion;
      motion.is_looping = true;
      motion.seconds = 1.5;
      motion.play(true);
      this.view.floating.show();
      this.view.picked.textContent = `shape of the pole ${describe(poles, i, this.unit)}`;
      this.view.scene.dataset.pole = String(pole);
    });
  }

  /** Poles with the parameters as they are now; what is asked while an answer is on its way waits, the last one alone. */
  follow() {
    this.is_late = true;
    if (!this.is_asking) this.following = this.ask_poles();
    return this.following;
  }

  /** Above every table and curve of the file's poles: with which parameters they were computed. @param {string[]} set */
  mark_stale(set) {
    const chapter = this.chart.element.closest(".chapter"), own = this.chart.element.closest(".panel");
    if (!chapter) return;
    const text = `With the parameters of the file that was linearized, not with ${set.join(", ")}: Linearize computes this again.`;
    for (const panel of chapter.querySelectorAll(".panel")) {
      if (!panel.querySelector("table, .live")) continue;
      let note = panel.querySelector(":scope > .stale");
      if (!note) {
        note = el("p", { class: "note stale", role: "status" });
        panel.querySelector("h3")?.after(note);
      }
      note.textContent = panel === own ? `The table: ${text.charAt(0).toLowerCase()}${text.slice(1)}` : text;
      /** @type {any} */ (note).hidden = set.length === 0 || (panel === own && !panel.querySelector("table"));
    }
  }

  async ask_poles() {
    this.is_asking = true;
    const errors = this.view.studio.list_errors();
    try {
      while (this.is_late) {
        this.is_late = false;
        const request = this.request;
        const { chapter } = await ask("poles", request);
        const { poles } = JSON.parse(chapter.data);
        this.poles = poles;
        errors.forEach((box) => box.remove());
        this.list_poles();
        this.mark_stale(request.set);
        this.trail.x.push(...poles.x);
        this.trail.y.push(...poles.y);
        const tip = (i) => describe(poles, i, this.unit);
        this.chart.set_series([...this.base.map((s) => ({ ...s, name: s.name.replace("poles", "at the start: poles"), tip: undefined })),
          { name: "on the way", x: Float64Array.from(this.trail.x), y: Float64Array.from(this.trail.y), points: "dot", style: 4 },
          { name: "poles with " + request.set.join(", "), x: Float64Array.from(poles.x), y: Float64Array.from(poles.y), points: "cross", style: 1, tip }]);
        this.chart.element.dataset.followed = String(this.trail.x.length);
      }
    } catch (error) {
      this.view.studio.show_error(error);
    } finally {
      this.is_asking = false;
    }
  }
}
