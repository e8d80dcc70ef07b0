// Numbers as text, ticks of axes.

export function format_number(value, digits = 6) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  return text.replace(/(\.\d*?)0+(e|$)/, "$1$2").replace(/\.(e|$)/, "$1").replace("-", "−");
}

// Round ticks inside [low, high], about `wanted`, with labels that tell them apart.
export function make_ticks(low, high, wanted) {
  if (!(high > low)) return [];
  const raw = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 2.5, 5].find((f) => f * power >= raw) ?? 10);
  const decimals = Math.max(0, -Math.floor(Math.log10(step)) + (step / power === 2.5 ? 1 : 0));
  const size = Math.max(Math.abs(low), Math.abs(high));
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && ticks.length < 50; ++k) {
    const value = k * step;
    let label;
    if (k === 0) label = "0";
    else if (size < 1e-3 || size >= 1e5) {
      const digits = Math.min(15, Math.max(0, Math.floor(Math.log10(size)) - Math.floor(Math.log10(step)) + (step / power === 2.5 ? 1 : 0)));
      label = value.toExponential(digits).replace("e+", "e");
    } else label = value.toFixed(Math.min(decimals, 15));
    ticks.push({ value, label: label.replace("-", "−").replace("e-", "e−") });
  }
  return ticks;
}

// Ticks at multiples of `base`, doubled until there are not many more than `wanted`: 45 degrees, 90, 180.
export function make_step_ticks(low, high, wanted, base) {
  let step = base;
  while ((high - low) / step > wanted + 1) step *= 2;
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push({ value: k * step, label: String(k * step).replace("-", "−") });
  return ticks;
}

// Decades between the logarithms low and high; few decades: 2 and 5 in between.
export function make_log_ticks(low, high, wanted) {
  const every = Math.max(1, Math.ceil((high - low) / wanted));
  const ticks = [];
  for (let d = Math.floor(low); d <= Math.ceil(high); ++d) {
    for (const f of high - low < 3 ? [1, 2, 5] : [1]) {
      const at = d + Math.log10(f);
      if (at < low - 1e-9 || at > high + 1e-9 || d % every !== 0) continue;
      const value = f * 10 ** d;
      ticks.push({ value: at, label: d >= -3 && d <= 4 ? String(Number(value.toPrecision(3))) : `${f}e${d}`.replace("-", "−") });
    }
  }
  return ticks;
}

// First index with x[i] >= value, x ascending.
export function find_index(x, value) {
  let low = 0, high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

export function find_nearest(x, value) {
  const i = find_index(x, value);
  if (i === 0) return 0;
  return i === x.length || value - x[i - 1] < x[i] - value ? i - 1 : i;
}

// Powers of units as a picture shows them: "kg m^2/s" becomes "kg m²/s".
export const write_powers = (text) => text.replace(/\^([234])/g, (_, digit) => "²³⁴"[digit - 2]);

// "frequency [Hz]" for seconds or a time without a label.
export function label_frequency(time_unit) {
  if (!time_unit || time_unit === "s" || time_unit === "T") return "frequency [Hz]";
  return time_unit === "ms" ? "frequency [kHz]" : `frequency [1/${time_unit}]`;
}
