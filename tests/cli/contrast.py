"""Contrast of the text of a page with its ground: WCAG 2.1, 1.4.3, level AA (4.5, large text 3)."""

# Texts of the page that are too faint. Pictures (figure), disabled controls and curves that are hidden are left out.
FIND_FAINT = r"""(() => {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  canvas.canvas.width = canvas.canvas.height = 1;
  const parse = (color) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = "#000";
    canvas.fillStyle = color;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = (top, below) => [0, 1, 2].map((i) => top[i] * top[3] + below[i] * (1 - top[3])).concat(1);
  const luminance = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, w, i) => {
    const v = c[i] / 255;
    return sum + w * (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  }, 0);
  const find_ground = (element) => {
    const layers = [];
    for (let e = element; e; e = e.parentElement) {
      const box = e.tagName === "g" ? e.querySelector(":scope > rect") : null;
      const color = parse(box ? getComputedStyle(box).fill : getComputedStyle(e).backgroundColor);
      if (color[3] > 0) layers.push(color);
      if (color[3] === 1) break;
    }
    return layers.reverse().reduce((below, top) => over(top, below), parse(getComputedStyle(document.body).backgroundColor));
  };
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const seen = new Set();
  for (let n = walker.nextNode(); n; n = walker.nextNode()) {
    const e = n.parentElement;
    if (!n.textContent.trim() || seen.has(e) || ["SCRIPT", "STYLE", "NOSCRIPT", "TITLE"].includes(e.tagName.toUpperCase()) || e.closest(":disabled, figure, [aria-pressed=false]")) continue;
    seen.add(e);
    if (!e.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || e.getClientRects().length === 0) continue;
    const style = getComputedStyle(e), ground = find_ground(e);
    const color = over(parse(e.namespaceURI.endsWith("svg") ? style.fill : style.color), ground);
    const [high, low] = [luminance(color), luminance(ground)].sort((a, b) => b - a), ratio = (high + 0.05) / (low + 0.05);
    const size = parseFloat(style.fontSize), is_large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    if (ratio < (is_large ? 3 : 4.5)) found.push(`${ratio.toFixed(2)} ${e.tagName}.${e.className?.baseVal ?? e.className} "${n.textContent.trim().slice(0, 40)}" ${style.color} on ${ground.slice(0, 3)}`);
  }
  for (const field of document.querySelectorAll("input, textarea")) {
    if (!field.checkVisibility() || !field.placeholder) continue;
    const ground = find_ground(field), color = over(parse(getComputedStyle(field, "::placeholder").color), ground);
    const [high, low] = [luminance(color), luminance(ground)].sort((a, b) => b - a), ratio = (high + 0.05) / (low + 0.05);
    if (ratio < 4.5) found.push(`${ratio.toFixed(2)} placeholder "${field.placeholder}"`);
  }
  return [...new Set(found)];
})()"""
