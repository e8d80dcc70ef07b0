// Handles of the curves of [[function]]s, by type: where each one is, and which numbers of the table it changes when it
// is dragged along an axis.

/** @typedef {Record<string, number | string>} Changes  values of keys: numbers, or the text of a list */
/**
 * @typedef {{name: string, x: number, y: number, low?: number, high?: number, along_x?: (x: number) => Changes,
 *   along_y?: (y: number) => Changes}} Handle  with the limits of x
 * @typedef {{number: (key: string, otherwise?: number) => number, has: (key: string) => boolean, text: (key: string) => string,
 *   start: number, end: number}} Table  numbers of the table (NaN: no plain number), and the range of its curve
 */

const kList = /^\[[\s\d.,eE+\-_]*\]$/;
const kNumber = /^[+-]?[\d_]+(\.[\d_]+)?([eE][+-]?\d+)?$/;
export const list_texts = (text) => text.slice(1, -1).split(",").map((t) => t.trim()).filter(Boolean);
export const to_text = (v) => (Number.isInteger(v) && Math.abs(v) < 1e15 ? v.toFixed(1) : String(v));
export const to_number = (text) => Number(text.replaceAll("_", ""));
/** Without what rounding leaves of a sum. */
const tidy = (v, digits = 12) => Number(v.toPrecision(digits)) || 0;
const kDigits = 5;  // of a frequency or an angle that a place gives

/** A copy of a list, from place k on `count` entries replaced. */
export const splice = (list, k, count, ...entries) => [...list.slice(0, k), ...entries, ...list.slice(k + count)];
const join = (texts) => `[${texts.join(", ")}]`;

/** A list in which one number is another one. */
const put = (text, k, v) => join(splice(list_texts(text), k, 1, to_text(v)));

/** @param {Table} t @returns {Handle[]} */
function list_points({ text }) {
  const [x, y] = ["x", "y"].map(text);
  if (!kList.test(x) || !kList.test(y) || list_texts(x).length !== list_texts(y).length) return [];
  const [xs, ys] = [x, y].map((list) => list_texts(list).map(to_number));
  return xs.map((v, k) => ({ name: `point ${k + 1}`, x: v, y: ys[k], low: xs[k - 1], high: xs[k + 1],
    along_x: (to) => ({ x: put(x, k, to) }), along_y: (to) => ({ y: put(y, k, to) }) }));
}

/** A number whose handle moves along y. @returns {Handle} */
const level = (name, key, x, y, to_value = (v) => v) => ({ name, x, y, along_y: (v) => ({ [key]: tidy(to_value(v)) }) });
/** A number whose handle moves along x. @returns {Handle} */
const time = (name, key, x, y, to_value = (v) => v, low = -Infinity, high = Infinity) => ({ name, x, y, low, high, along_x: (v) => ({ [key]: tidy(to_value(v)) }) });

/** The angle at time 0, in the unit of the text. @param {Table} t */
const get_phase = ({ number, has }) => (has("phase_deg") ? { key: "phase_deg", unit: Math.PI / 180, phase: (number("phase_deg") * Math.PI) / 180 } : { key: "phase", unit: 1, phase: number("phase", 0) });

/** @type {Record<string, (t: Table) => Handle[]>} */
const kHandles = {
  table: list_points,
  constant: ({ number, start, end }) => [level("value", "value", (start + end) / 2, number("value"))],
  step({ number, start, end }) {
    const value = number("value"), at = number("at", 0), before = number("before", 0);
    return [level("before", "before", Math.min((start + at) / 2, at), before), time("at", "at", at, (before + value) / 2), level("value", "value", Math.max((at + end) / 2, at), value)];
  },
  ramp({ number }) {
    const value = number("value"), from = number("from", 0), to = number("to");
    return [time("from", "from", from, 0, undefined, -Infinity, to), { ...time("to", "to", to, value, undefined, from), along_y: (y) => ({ value: tidy(y) }) }];
  },
  pulse({ number }) {
    const value = number("value"), at = number("at", 0), width = number("width"), end = at + width;
    return [{ ...time("start", "at", at, value / 2, undefined, -Infinity, end), along_x: (x) => ({ at: tidy(x), width: tidy(end - x) }) },
      { ...level("value", "value", at + width / 2, value), along_x: (x) => ({ at: tidy(x - width / 2) }) }, time("end", "width", end, value / 2, (x) => x - at, at)];
  },
  doublet({ number }) {
    const value = number("value"), at = number("at", 0), width = number("width");
    return [time("start", "at", at, value / 2), level("value", "value", at + width / 2, value), time("width of each half", "width", at + width, 0, (x) => x - at, at),
      time("end", "width", at + 2 * width, -value / 2, (x) => (x - at) / 2, at)];
  },
  sine(t) {
    const { number, has, start } = t, amplitude = number("amplitude"), offset = number("offset", 0), { key, unit, phase } = get_phase(t);
    const omega = has("omega") ? number("omega") : 2 * Math.PI * number("frequency_hz");
    // Upward crossings of the mean value: the first one of the run, and the next one after time 0.
    const turn = 2 * Math.PI, k = Math.ceil((omega * start + phase) / turn - 1e-9), first = (turn * k - phase) / omega, next = Math.max(k + 1, Math.floor(phase / turn) + 1);
    const set_rate = (x) => {
      const rate = (turn * next - phase) / x;
      return has("omega") ? { omega: tidy(rate, kDigits) } : { frequency_hz: tidy(rate / turn, kDigits) };
    };
    if (!(omega > 0)) return [];
    return [{ ...level("phase and mean value", "offset", first, offset), along_x: (x) => ({ [key]: tidy((turn * k - omega * x) / unit, kDigits) }) },
      level("amplitude", "amplitude", first + turn / omega / 4, offset + amplitude, (y) => y - offset),
      { name: "frequency", x: (turn * next - phase) / omega, y: offset, low: 0, along_x: set_rate }];
  },
  sawtooth({ number, start }) {
    const amplitude = number("amplitude"), period = 1 / number("frequency_hz"), rise = number("rise", 1), at = number("at", 0), offset = number("offset", 0);
    // A period of the run.
    const shift = Math.ceil((start - at) / period - 1e-9) * period, from = at + shift, top = from + rise * period;
    const whole = time("frequency", "frequency_hz", from + period, offset - amplitude, (x) => tidy(1 / (x - from), kDigits), from);
    return [time("at", "at", from, offset - amplitude, (x) => x - shift), level("mean value", "offset", from + (rise * period) / 2, offset),
      { ...level("amplitude", "amplitude", top, offset + amplitude, (y) => y - offset), low: from, high: from + period * (1 + 1e-9), along_x: (x) => ({ rise: tidy(Math.min(1, (x - from) / period), kDigits) }) },
      // The handle moves at and frequency apart only as long as the shift is none.
      ...(shift === 0 ? [whole] : [])];
  },
  spinup({ number }) {
    const rate = number("rate"), duration = number("duration");
    return [{ name: "end", x: duration, y: (rate * duration) / 2, low: 0, along_x: (x) => ({ duration: tidy(x) }), along_y: (y) => ({ rate: tidy((2 * y) / duration, kDigits) }) }];
  },
};

/** @param {Table} t @returns {Handle[]} */
function list_swept({ number, start }) {
  const amplitude = number("amplitude"), at = number("at", 0), duration = number("duration"), offset = number("offset", 0);
  return [{ ...time("start", "at", at, offset), along_y: (y) => ({ offset: tidy(y) }) }, level("amplitude", "amplitude", Math.max(start, at) + duration / 2, offset + amplitude, (y) => y - offset),
    time("end", "duration", at + duration, offset, (x) => x - at, at)];
}
kHandles.chirp = kHandles.sweep = list_swept;

/**
 * Handles of a function; none of a type without, and none that would change what is no plain number.
 * @param {string} type  @param {Record<string, string>} values  the texts of its keys
 * @param {ArrayLike<number>} x  of its curve
 * @returns {Handle[]}
 */
export function list_handles(type, values, x) {
  const number = (key, otherwise = NaN) => (values[key] === undefined ? otherwise : kNumber.test(values[key]) ? to_number(values[key]) : NaN);
  const table = { number, has: (key) => values[key] !== undefined, text: (key) => values[key] ?? "", start: x[0], end: x[x.length - 1] };
  return (kHandles[type]?.(/** @type {any} */ (table)) ?? []).filter((h) => Number.isFinite(h.x) && Number.isFinite(h.y));
}
