import { Chart, Link } from "./chart.js";
import { format_number } from "./numbers.js";
import { el, make_check, make_select } from "./page_parts.js";
import { unpack_doubles } from "./unpack.js";

// The s plane, or the z plane of a sampled model, with lines of constant damping.
export function list_pole_series({ poles, zeros, frequency_unit = "Hz" }) {
  const tip = (i) => `${poles.mode[i]}: ${format_number(poles.real[i], 5)} ${poles.imag[i] < 0 ? "−" : "+"} ${format_number(Math.abs(poles.imag[i]), 5)}j, ${format_number(poles.frequency[i], 5)} ${frequency_unit}, damping ${format_number(100 * poles.damping[i], 4)} %`;
  const series = [{ name: "poles", x: Float64Array.from(poles.x), y: Float64Array.from(poles.y), points: "cross", tip }];
  if (zeros.real.length > 0)
    series.push({ name: "zeros", x: Float64Array.from(zeros.real), y: Float64Array.from(zeros.imag), points: "circle", tip: (i) => `zero: ${format_number(zeros.real[i], 5)}, ${format_number(zeros.imag[i], 5)}j` });
  return series;
}

export function make_poles_chart(data) {
  return new Chart({ title: "Poles and zeros", series: list_pole_series(data), ...data.plane, height: 420 });
}

// Magnitude and phase of chosen pairs of input and output.
export class BodeView {
  constructor(data) {
    this.data = data;
    this.frequency = unpack_doubles(data.frequency);
    this.pairs = data.pairs.map((p) => ({ name: p.name, diagrams: p.diagrams, decibel: unpack_doubles(p.decibel), degrees: unpack_doubles(p.degrees) }));
    this.chosen = new Set([0]);
    const link = new Link();
    const make = (y_label) => new Chart({ series: [], link, x_log: true, x_label: `frequency [${data.frequency_unit ?? "Hz"}]`, y_label, height: 250 });
    this.magnitude = make("magnitude [dB]");
    this.phase = Object.assign(make("phase [degrees]"), { y_step: 45 });
    const boxes = this.pairs.map((p, k) => make_check(p.name, k === 0, (on) => {
      if (on) this.chosen.add(k);
      else this.chosen.delete(k);
      this.update();
    }));
    this.element = el("div", {}, el("div", { class: "tools pairs" }, ...boxes), this.magnitude.element, this.phase.element);
    this.update();
  }

  update() {
    const shown = [...this.chosen].sort((a, b) => a - b);
    const pick = (key, d) => [
      ...shown.map((k) => ({ name: this.pairs[k].name, style: k, x: this.frequency, y: this.pairs[k][key] })),
      ...shown.flatMap((k) => this.pairs[k].diagrams[d].marks.map((m) => ({ name: m.label, style: k + d + 1, points: "circle", x: Float64Array.from(m.x), y: Float64Array.from(m.y), tip: () => m.label })))];
    [this.magnitude, this.phase].forEach((chart, d) => {
      chart.guides = shown.flatMap((k) => this.pairs[k].diagrams[d].guides);
      chart.set_series(pick(["decibel", "degrees"][d], d));
    });
  }
}

// One column of a campaign against another.
export class ScatterView {
  constructor({ columns }) {
    this.columns = columns;
    const names = columns.map((c) => c.name);
    this.x = Math.min(1, columns.length - 1);
    this.y = Math.max(columns.findIndex((c) => c.output), 0);
    this.chart = new Chart({ series: [], height: 320 });
    const make = (text, key) => {
      const control = make_select(text, names, (i) => { this[key] = i; this.update(); });
      control.list.value = this[key];
      return control;
    };
    this.element = el("div", {}, el("div", { class: "tools" }, make("across", "x"), make("up", "y")), this.chart.element);
    this.update();
  }

  update() {
    const to_numbers = (column) => Float64Array.from(column.numbers, (v) => v ?? NaN);
    const [x, y] = [this.columns[this.x], this.columns[this.y]];
    this.chart.x_label = x.name;
    this.chart.y_label = y.name;
    const cases = this.columns.find((c) => c.name === "case")?.numbers;
    this.chart.set_series([{ name: `${y.name} against ${x.name}`, x: to_numbers(x), y: to_numbers(y), points: "circle", tip: (i) => `case ${cases?.[i] ?? i + 1}: ${format_number(x.numbers[i])}, ${format_number(y.numbers[i])}` }]);
  }
}
