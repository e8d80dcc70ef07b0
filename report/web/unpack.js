// Arrays as report/pack.hpp packs them.

function to_bytes(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export const unpack_floats = (text) => new Float32Array(to_bytes(text).buffer);
export const unpack_doubles = (text) => new Float64Array(to_bytes(text).buffer);
export const unpack_indices = (text) => new Uint32Array(to_bytes(text).buffer);
export const unpack_shorts = (text) => new Int16Array(to_bytes(text).buffer);

// 24 bits a sample; the last code stands for no number. Halves: a range may be larger than any number.
export function unpack_column(column, count) {
  const values = new Float64Array(count).fill(column.low);
  if (column.data === "") return values;
  const bytes = to_bytes(column.data);
  for (let i = 0, at = 0; i < count; ++i, at += 3) {
    const code = (bytes[at] << 16) | (bytes[at + 1] << 8) | bytes[at + 2];
    values[i] = code === 0xffffff ? NaN : 2 * (column.low / 2 + code * (column.step / 2));
  }
  return values;
}

export function unpack_time(time) {
  if (time.data !== undefined) return unpack_doubles(time.data);
  return Float64Array.from({ length: time.count }, (_, i) => time.first + i * time.step);
}

// Ascending indices: differences of `digits` characters of base 64 each (report/pack.cpp).
export function unpack_ascending(text, digits) {
  const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const value = new Map([...kDigits].map((letter, i) => [letter, i]));
  const indices = new Uint32Array(text.length / digits);
  let at = 0;
  for (let i = 0; i < indices.length; ++i) {
    let by = 0;
    for (let k = 0; k < digits; ++k) by = 64 * by + value.get(text[digits * i + k]);
    indices[i] = at += by;
  }
  return indices;
}

// The samples that a channel of this stride keeps.
export function thin_time(time, stride) {
  if (stride <= 1) return time;
  return Float64Array.from({ length: Math.ceil(time.length / stride) }, (_, i) => time[i * stride]);
}
