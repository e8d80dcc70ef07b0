import { Chart, Link } from "./chart.js";
import { el, make_button, make_check, make_file_name, make_select } from "./page_parts.js";
import { find_index, format_number, label_frequency, write_powers } from "./numbers.js";
import { calc_spectrum } from "./spectrum.js";
import { thin_time, unpack_ascending, unpack_column, unpack_time } from "./unpack.js";

export const with_unit = (what, unit) => (unit && unit !== "1" ? `${what} [${unit}]`.trimStart() : what);
export const label_time = (run) => with_unit("time", run.data.time_unit);

const kXyz = ["x", "y", "z"];
// Coordinates and rates of a free hinge (docs/formats/system-toml.md).
const kFreeHinge = { q: ["quaternion w", ...kXyz.map((c) => "quaternion " + c), ...kXyz.map((c) => "position " + c)], qdot: [...kXyz.map((c) => "angular velocity " + c), ...kXyz.map((c) => "velocity " + c)] };

// The channels of one run, unpacked when they are first asked for.
export class Run {
  constructor(data) {
    this.data = data;
    this.time = unpack_time(data.time);
    this.link = new Link();
    this.marks = data.events.filter((e) => e.time !== null).map((e) => ({ x: e.time, label: e.what }));
    this.times = new Map();
    this.columns = new Map();
    this.by_path = new Map(data.channels.map((c) => [c.path, c]));
    // The scene has all hinges but free ones.
    const drawn = new Set(data.hinges?.map((h) => h.name));
    for (const channel of data.channels) {
      const [, name, what] = /^\/hinges\/(.+)\/(q|qdot)$/.exec(channel.path) ?? [], labels = kFreeHinge[what];
      if (data.hinges && name && !drawn.has(name) && labels?.length === channel.columns.length) channel.columns.forEach((column, i) => (column.label = labels[i]));
      if (/\/reaction_(force|moment)$/.test(channel.path) && channel.columns.length === 3) channel.columns.forEach((column, i) => (column.label = "xyz"[i]));
    }
  }
  // Times and values of what is drawn from one of `stride` samples, all columns at the same times (the motion).
  get_time(channel) {
    if (!this.times.has(channel.stride)) this.times.set(channel.stride, thin_time(this.time, channel.stride));
    return this.times.get(channel.stride);
  }
  get_values(channel, index) {
    const key = channel.path + ":" + index;
    if (!this.columns.has(key)) this.columns.set(key, unpack_column(channel.columns[index], this.get_time(channel).length));
    return this.columns.get(key);
  }
  // Of a long run the page has the smallest and the largest of each few samples of a column, where they are; `of_all`:
  // means of all samples, and how many there are.
  make_series(channel, index, name) {
    const { extremes } = channel.columns[index];
    if (!extremes) return { name, x: this.get_time(channel), y: this.get_values(channel, index) };
    const key = channel.path + ":" + index + ":extremes";
    if (!this.columns.has(key)) {
      const at = unpack_ascending(extremes.at, extremes.digits);
      this.columns.set(key, { x: Float64Array.from(at, (i) => this.time[i]), y: unpack_column(extremes, at.length) });
    }
    return { name, ...this.columns.get(key), of_all: extremes, every: 2 * channel.stride };
  }
  list_series(channel, index, name) {
    return [this.make_series(channel, index, name)];
  }
}

const kColorCount = 7;

// Several runs whose curves share charts: the channels of all of them, each with a curve for every run that has it.
export class RunSet {
  constructor(runs) {
    this.runs = runs;  // [{ name, run }]
    this.link = new Link();
    this.marks = [];
    const channels = new Map();
    for (const { run } of runs) for (const c of run.data.channels) if (!channels.has(c.path)) channels.set(c.path, c);
    this.data = { channels: [...channels.values()], time_unit: runs[0].run.data.time_unit };
  }
  // One colour for each run; of several components, for each component, and dashes for each run.
  list_series(channel, index, name) {
    const is_single = channel.columns.length === 1;
    return this.runs.flatMap(({ name: of, run }, r) => {
      const own = run.by_path.get(channel.path);
      if (!own || index >= own.columns.length) return [];
      return [{ ...run.make_series(own, index, is_single ? of : `${of} ${name}`), style: is_single ? r : index + kColorCount * r }];
    });
  }
}

const short_name = (path) => path.replace(/^\/sensors\//, "").replace(/^\//, "");
// Legend of a modal coordinate: the mode and its frequency.
const label_column = (channel, i) => channel.columns[i].label ?? channel.columns[i].name;
const name_column = (channel, i) => short_name(channel.path) + (channel.columns[i].name ? ":" + channel.columns[i].name : "");

// A chart of whole channels that goes with the run's others. Components that are noise are left out.
export function make_fixed_chart(run, title, paths) {
  const channels = paths.map((p) => run.by_path.get(p)).filter(Boolean);
  const series = channels.flatMap((c) => c.columns.map((column, i) => [column, i]).filter(([column]) => !column.noise)
    .map(([column, i]) => run.make_series(c, i, channels.length > 1 || !column.name ? c.path.split("/").pop() : column.name)));
  return new Chart({ title, series, marks: run.marks, link: run.link, x_label: label_time(run), y_label: with_unit(title.toLowerCase(), channels[0]?.columns[0].unit), height: 240 });
}

// Channel tree, charts, spectra, statistics of the window.
export class HistoryView {
  constructor(run) {
    this.run = run;
    this.chosen = new Map();  // "path:index" -> [channel, index]
    this.is_log = this.is_spectrum = this.is_by_unit = false;
    this.charts_host = el("div", { class: "charts" });
    this.statistics = el("table", { class: "statistics" });
    this.spectrum_link = new Link();
    this.element = el("div", { class: "history" }, this.make_tree(), el("div", { class: "plots" }, this.make_tools(), this.charts_host, el("div", { class: "scroll" }, this.statistics)));
    run.link.on("window", () => this.update_window());
    this.choose_first();
    this.rebuild();
  }

  choose_first() {
    const all = this.run.data.channels;
    let first = all.filter((c) => c.path.startsWith("/sensors/") || c.path.startsWith("/signals/"));
    if (first.length === 0) first = all.filter((c) => c.path.startsWith("/hinges/") && c.path.endsWith("/q"));
    if (first.length === 0) first = all.slice(0, 1);
    let count = 0;
    for (const channel of first) {
      if (count > 0 && count + channel.columns.length > 14) break;
      channel.columns.forEach((column, i) => column.noise || this.choose(channel, i, true));
      count += channel.columns.length;
    }
  }

  choose(channel, index, is_on) {
    const key = channel.path + ":" + index;
    if (is_on) this.chosen.set(key, [channel, index]);
    else this.chosen.delete(key);
    const box = this.boxes.get(key);
    if (box) box.checked = is_on;
  }

  make_tree() {
    this.boxes = new Map();
    const search = el("input", { type: "search", placeholder: "find a channel", "aria-label": "find a channel" });
    const list = el("div", { class: "tree" });
    const groups = new Map();
    for (const channel of this.run.data.channels) {
      const parts = channel.path.split("/");
      const name = parts.length > 3 ? parts.slice(1, 3).join("/") : parts[1];
      if (!groups.has(name)) groups.set(name, el("details", { open: name === "sensors" }, el("summary", {}, name)));
      const row = el("div", { class: "channel", title: channel.description, "data-path": channel.path.toLowerCase() }, el("span", {}, parts[parts.length - 1]));
      channel.columns.forEach((column, i) => {
        const box = el("input", { type: "checkbox", "aria-label": name_column(channel, i) });
        box.addEventListener("change", () => {
          this.choose(channel, i, box.checked);
          this.rebuild();
        });
        this.boxes.set(channel.path + ":" + i, box);
        row.append(el("label", { title: column.label }, box, column.name));
      });
      groups.get(name).append(row);
    }
    list.append(...groups.values());
    search.addEventListener("input", () => {
      const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      for (const group of groups.values()) {
        let any = false;
        for (const row of group.querySelectorAll(".channel")) {
          row.hidden = !words.every((w) => row.dataset.path.includes(w));
          any ||= !row.hidden;
        }
        group.hidden = !any;
        if (words.length > 0) group.open = any;
      }
    });
    return el("div", { class: "picker" }, search, list);
  }

  make_tools() {
    return el("div", { class: "tools" },
      make_check("log y", false, (on) => { this.is_log = on; this.rebuild(); }),
      make_check("spectrum of the window", false, (on) => { this.is_spectrum = on; this.rebuild(); }),
      make_select("one chart for", ["each channel", "each unit"], (i) => { this.is_by_unit = i === 1; this.rebuild(); }).list,
      make_button("whole time", "Reset the zoom (double click)", () => this.run.link.charts[0]?.reset()),
      make_button("none", "Take all curves away", () => { for (const [c, i] of [...this.chosen.values()]) this.choose(c, i, false); this.rebuild(); }),
      make_button("CSV", "Save the samples in the window", () => this.save_csv()));
  }

  rebuild() {
    this.run.link.charts = this.run.link.charts.filter((c) => !this.charts?.includes(c));
    this.spectrum_link.charts = [];
    const groups = new Map();
    for (const [channel, i] of this.chosen.values()) {
      const key = this.is_by_unit ? channel.columns[i].unit : channel.path;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push([channel, i]);
    }
    this.charts = [];
    this.spectra = [];
    for (const [, members] of groups) {
      const same = members.every(([c]) => c === members[0][0]);
      const units = new Set(members.map(([c, i]) => c.columns[i].unit));
      const title = same ? short_name(members[0][0].path) : "";
      const unit = units.size === 1 ? [...units][0] : "";
      const name = (c, i) => {
        const own = same ? label_column(c, i) || short_name(c.path) : name_column(c, i);
        return units.size === 1 ? own : with_unit(own, c.columns[i].unit);
      };
      const series = members.flatMap(([c, i]) => this.run.list_series(c, i, name(c, i)));
      const what = same ? (members.length === 1 ? name_column(...members[0]) : title) : "";
      const make_label = (wrap) => with_unit(what ? wrap(what) : "", unit) || "value";
      const chart = new Chart({ title, series, marks: this.run.marks, link: this.run.link, y_log: this.is_log, x_label: label_time(this.run), y_label: make_label(this.is_log ? (w) => `|${w}|` : (w) => w) });
      this.charts.push(chart);
      if (this.is_spectrum)
        this.spectra.push(series.some((s) => s.of_all) ? make_spectrum_note(title || "channels", members, Math.max(...series.map((s) => s.every ?? 1))) : new Chart({ title: "spectrum of " + (title || with_unit("channels", unit)), link: this.spectrum_link, series: [], x_label: label_frequency(this.run.data.time_unit), y_label: make_label((w) => "amplitude of " + w), y_log: this.is_log, height: 220 }));
    }
    this.charts_host.replaceChildren(...this.charts.flatMap((c, k) => (this.spectra[k] ? [c.element, this.spectra[k].element] : [c.element])));
    if (this.charts.length === 0) this.charts_host.append(el("p", { class: "note" }, "Choose channels on the left."));
    this.update_window();
  }

  find_window(x) {
    const window = this.run.link.window;
    return window ? [find_index(x, window[0]), Math.min(x.length, find_index(x, window[1]) + 1)] : [0, x.length];
  }

  update_window() {
    this.charts.forEach((chart, k) => {
      this.spectra[k]?.set_series?.(chart.series.map((s) => {
        const { frequency, amplitude } = calc_spectrum(s.x, s.y, ...this.find_window(s.x));
        return { name: s.name, style: s.style, x: frequency, y: amplitude };
      }));
    });
    const window = this.run.link.window;
    const head = el("tr", {}, ...["channel", "unit", "min", "max", "max − min", "mean", "rms", "samples"].map((t, i) => el("th", i > 1 ? {} : { class: "text" }, t)));
    let is_thinned = false;
    const rows = [...this.chosen.values()].flatMap(([channel, i]) => this.run.list_series(channel, i, name_column(channel, i)).map(({ x, y, name, of_all }) => {
      const [from, to] = this.find_window(x);
      is_thinned ||= Boolean(of_all);
      let low = Infinity, high = -Infinity, sum = 0, square = 0, count = 0;
      for (let k = from; k < to; ++k) {
        const v = y[k];
        if (!Number.isFinite(v)) continue;
        if (v < low) low = v;
        if (v > high) high = v;
        sum += v;
        square += v * v;
        ++count;
      }
      // The means of a part of the time need the samples that the page does not have.
      const means = !of_all ? [sum / count, Math.sqrt(square / count)] : window ? [NaN, NaN] : [of_all.mean ?? NaN, of_all.rms ?? NaN];
      const cells = [low, high, high - low, ...means].map((v) => el("td", {}, format_number(v)));
      if (of_all && !window) count = of_all.count;
      const own = this.run.runs && channel.columns.length === 1 ? `${name} ${name_column(channel, i)}` : name;
      return el("tr", {}, el("td", { class: "text" }, own), el("td", { class: "text" }, write_powers(channel.columns[i].unit)), ...cells, el("td", {}, String(count)));
    }));
    const range = window ? `${format_number(window[0])} to ${format_number(window[1])}` : "the whole time";
    const note = !is_thinned ? "" : window ? "; mean and rms need samples that the page does not have" : ", from all samples";
    this.statistics.replaceChildren(el("caption", {}, "In the window: " + range + note), el("thead", {}, head), el("tbody", {}, ...rows));
  }

  // One table; of several runs one below the other, with the run before the time.
  save_csv() {
    const members = [...this.chosen.values()];
    if (members.length === 0) return;
    const runs = this.run.runs ?? [{ name: "", run: this.run }], has_many = runs.length > 1;
    const has_labels = !["", "T"].includes(this.run.data.time_unit);
    const head = (name, unit) => quote(has_labels ? with_unit(name, unit) : name);
    const lines = [[...(has_many ? ["run"] : []), head("time", this.run.data.time_unit), ...members.map(([c, i]) => head(name_column(c, i), c.columns[i].unit))].join(",")];
    for (const { name, run } of runs) {
      const own = members.map(([c]) => run.by_path.get(c.path));
      const columns = own.map((c, m) => (c ? run.make_series(c, members[m][1], "") : { x: [], y: [] }));
      // Of a long run each column has times of its own: a cell is empty where the page has no sample.
      const is_thinned = columns.some((c) => c.of_all);
      const time = is_thinned ? Float64Array.from(new Set(columns.flatMap((c) => [...c.x]))).sort() : run.time;
      const found = columns.map((c) => (is_thinned ? new Map(Array.from(c.x, (t, k) => [t, c.y[k]])) : null));
      const [from, to] = this.find_window(time);
      for (let k = from; k < to; ++k)
        lines.push([...(has_many ? [quote(name)] : []), time[k], ...columns.map((c, m) => (!own[m] ? "" : is_thinned ? found[m].get(time[k]) ?? "" : c.y[k]))].join(","));
    }
    save_text(lines.join("\n") + "\n", make_file_name([...new Set(members.map(([c]) => short_name(c.path)))].slice(0, 4).join("-"), "csv"));
  }
}

// In the place of a spectrum of curves that have lost samples: it would show frequencies that are not there.
function make_spectrum_note(title, members, every) {
  const [channel, i] = members[0], what = channel.path.replace(/^\/sensors\//, "") + (channel.columns[i].name ? ":" + channel.columns[i].name : "");
  return { element: el("p", { class: "note no-spectrum" }, `No spectrum of ${title}: of each ${every} samples the page has the smallest and the largest, and no frequency can be told from these. From all samples: bough plot RESULTS.h5 --sensor ${what} --spectrum; or a page of fewer channels: bough report RESULTS.h5 --channel ${what}.`) };
}

const quote = (text) => (/[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

function save_text(text, name) {
  const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })), download: name });
  link.click();
}
