// Poles of a linear model in the studio: a click moves the system in the shape of the pole, and the poles follow the
// parameters while these are dragged.
import { ask } from "./api.js";
import { ReportChapter } from "./chapter_views.js";
import { list_pole_series } from "./linear_view.js";
import { format_number } from "./numbers.js";
import { make_select } from "./page_parts.js";

const describe = ({ frequency, damping, mode }, i) => `${format_number(frequency[i], 5)} Hz, damping ${format_number(100 * damping[i], 4)} %, ${mode[i]}`;

export class PolePanel {
  /** @param {any} view  the SystemView  @param {any} chart  its chart of poles  @param {ReportChapter} data */
  constructor(view, chart, data, is_at_rest) {
    this.view = view;
    this.chart = chart;
    this.is_at_rest = is_at_rest;
    this.poles = data.data.poles;
    this.base = list_pole_series(data.data);
    this.trail = { x: [], y: [] };
    chart.on_point = (series, i) => series.name.startsWith("poles") && this.show(this.poles.index[i], this.poles, i);
    // Of a pair the pole with the positive part; for the keyboard.
    const upper = this.poles.index.map((_, i) => i).filter((i) => this.poles.imag[i] >= 0);
    const list = make_select("move in the shape of", ["no pole", ...upper.map((i) => describe(this.poles, i))], (k) => k > 0 && this.show(this.poles.index[upper[k - 1]], this.poles, upper[k - 1]));
    list.list.classList.add("pole-picker");
    chart.element.prepend(list);
  }

  get request() {
    return { file: this.view.file, text: this.view.pane.text, set: this.view.list_set(), equilibrium: this.is_at_rest };
  }

  /** The scene moves in the shape of the pole until another run or pole is shown. */
  show(pole, poles, i) {
    return this.view.studio.attempt(async () => {
      const { chapter } = await ask("pole-motion", { ...this.request, pole });
      this.view.show_scene(new ReportChapter(chapter.data).run, false, true);
      const motion = this.view.motion;
      motion.is_looping = true;
      motion.seconds = 1.5;
      motion.play(true);
      this.view.picked.textContent = `shape of the pole ${describe(poles, i)}`;
      this.view.scene.dataset.pole = String(pole);
    });
  }

  /** Poles with the parameters as they are now; what is asked while an answer is on its way waits, the last one alone. */
  async follow() {
    this.is_late = true;
    if (this.is_asking) return;
    this.is_asking = true;
    try {
      while (this.is_late) {
        this.is_late = false;
        const request = this.request;
        const { chapter } = await ask("poles", request);
        const { poles } = JSON.parse(chapter.data);
        this.poles = poles;
        this.trail.x.push(...poles.x);
        this.trail.y.push(...poles.y);
        const tip = (i) => describe(poles, i);
        this.chart.set_series([...this.base.map((s) => ({ ...s, name: s.name.replace("poles", "at the start: poles") })),
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
