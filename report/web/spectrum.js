// Amplitude of a history against frequency.

// Radix 2, in place, re and im of a power of two of numbers.
export function transform(re, im) {
  const n = re.length;
  for (let i = 1, j = 0; i < n; ++i) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
  }
  for (let size = 2; size <= n; size *= 2) {
    const half = size / 2;
    for (let k = 0; k < half; ++k) {
      const c = Math.cos((-2 * Math.PI * k) / size), s = Math.sin((-2 * Math.PI * k) / size);
      for (let i = k; i < n; i += size) {
        const j = i + half;
        const x = re[j] * c - im[j] * s, y = re[j] * s + im[j] * c;
        re[j] = re[i] - x;
        im[j] = im[i] - y;
        re[i] += x;
        im[i] += y;
      }
    }
  }
}

// Samples from..to of (x, y), less their straight line, under Hann's window: a sine of amplitude a has a peak of a.
// Uneven samples are interpolated on as many even ones. Cycles per unit of x.
export function calc_spectrum(x, y, from, to) {
  const count = to - from;
  if (count < 8) return { frequency: new Float64Array(0), amplitude: new Float64Array(0) };
  const length = x[to - 1] - x[from];
  const step = length / (count - 1);
  const even = new Float64Array(count);
  for (let k = 0, i = from; k < count; ++k) {
    const t = x[from] + k * step;
    while (i < to - 2 && x[i + 1] < t) ++i;
    const share = (t - x[i]) / (x[i + 1] - x[i]);
    const value = y[i] + share * (y[i + 1] - y[i]);
    even[k] = Number.isFinite(value) ? value : 0;
  }
  // The line of least squares.
  let mean = 0, slope = 0, weight = 0;
  for (const v of even) mean += v / count;
  for (let k = 0; k < count; ++k) {
    const d = k - (count - 1) / 2;
    slope += d * even[k];
    weight += d * d;
  }
  slope /= weight;
  const size = 2 ** Math.ceil(Math.log2(count) + 1);
  const re = new Float64Array(size), im = new Float64Array(size);
  let sum = 0;
  for (let k = 0; k < count; ++k) {
    const w = 0.5 - 0.5 * Math.cos((2 * Math.PI * (k + 0.5)) / count);
    sum += w;
    re[k] = w * (even[k] - mean - slope * (k - (count - 1) / 2));
  }
  transform(re, im);
  const half = size / 2;
  const frequency = new Float64Array(half - 1), amplitude = new Float64Array(half - 1);
  for (let k = 1; k < half; ++k) {
    frequency[k - 1] = k / (size * step);
    amplitude[k - 1] = (2 * Math.hypot(re[k], im[k])) / sum;
  }
  return { frequency, amplitude };
}
