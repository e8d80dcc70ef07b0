import { Chart, Link } from "./chart.js";
import { format_number } from "./numbers.js";
import { el, make_select, make_slider } from "./page_parts.js";
import { unpack_doubles } from "./unpack.js";

const kShownModes = 6;

// Frequencies of a body against the rate at which its frame spins, and all of them at the rate of the slider.
export class SpinView {
  constructor({ spin }) {
    this.curves = spin.map((c) => ({ ...c, rate: unpack_doubles(c.rate), frequency: c.frequency.map(unpack_doubles), without: c.without.map(unpack_doubles) }));
    this.axis = 0;
    this.share = 0.25;
    this.link = new Link();
    this.link.on("pick", (rate) => this.set_rate(rate));
    this.chart = new Chart({ series: [], link: this.link, x_label: "spin rate [1/T, radians]", y_label: "frequency [Hz]", height: 300 });
    this.body = el("tbody");
    this.note = el("p", { class: "note" });
    this.slider = make_slider("spin rate", { min: 0, max: 1, step: 0.005, value: this.share }, (share) => {
      this.share = share;
      this.update_table();
      return format_number(share * this.get_last(), 4);
    });
    const head = el("tr", {}, ...["mode", "at rest [Hz]", "at this rate [Hz]", "without K_G [Hz]"].map((t) => el("th", {}, t)));
    this.element = el("div", { class: "spin" }, el("div", { class: "tools" }, make_select("about the axis", this.curves.map((c) => c.axis), (i) => { this.axis = i; this.update(); }), this.slider), this.chart.element, this.note, el("table", {}, el("thead", {}, head), this.body));
    this.update();
  }

  get now() {
    return this.curves[this.axis];
  }
  get_last() {
    return this.now.rate[this.now.rate.length - 1];
  }
  set_rate(rate) {
    this.slider.slider.value = Math.min(1, Math.max(0, rate / this.get_last()));
    this.slider.update();
  }

  update() {
    const { rate, frequency, without, has_stiffness } = this.now;
    const series = frequency.slice(0, kShownModes).flatMap((y, k) => [
      { name: `mode ${k + 1}`, x: rate, y, style: k },
      ...(has_stiffness ? [{ name: `mode ${k + 1} without K_G`, x: rate, y: without[k], style: k + 7 }] : [])]);
    series.push({ name: "1 per turn", x: rate, y: rate.map((v) => v / (2 * Math.PI)), style: 20 });
    this.chart.title = `Spin about ${this.now.axis}`;
    this.chart.set_series(series);
    // Of the curves without K_G the first is enough to begin with; the others are shown by their entry in the legend.
    series.forEach((s, i) => s.style >= 8 && s.style < 20 && this.chart.hidden.add(i));
    this.chart.show_hidden();
    this.slider.update();
  }

  // Linear between the rates of the file.
  update_table() {
    if (!this.slider) return;
    const { rate, frequency, without, has_stiffness } = this.now;
    const at = this.share * (rate.length - 1), i = Math.min(Math.floor(at), rate.length - 2), part = at - i;
    const mix = (y) => (1 - part) * y[i] + part * y[i + 1];
    this.body.replaceChildren(...frequency.map((y, k) => el("tr", {}, ...[String(k + 1), format_number(y[0], 5), format_number(mix(y), 5), has_stiffness ? format_number(mix(without[k]), 5) : "not computed"].map((t) => el("td", {}, t)))));
    this.note.textContent = `At ${format_number(this.share * this.get_last(), 4)}: in the spinning frame, about the undeformed body.`;
    this.link.set_cursor(this.share * this.get_last(), this.chart);
  }
}
