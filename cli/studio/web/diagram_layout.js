// Places of the boxes of a block diagram in columns from left to right: layers by the longest path, order within a
// layer by barycentres (Sugiyama, Tagawa & Toda, IEEE Trans. SMC 11 (1981) 109), edges through the gaps of the layers.

/** @typedef {{id: string, kind: string, label: string}} Node */
/** @typedef {{from: string, to: string, label: string, link: string}} Edge */

const kColumnGap = 70, kRowGap = 16, kSweeps = 12, kCharacter = 6.6, kLine = 15;
// Where the search for cycles begins: what closes a loop is the way back from the bodies to the sensors.
const kOrder = ["function", "input", "event", "sensor", "controller", "actuator", "force", "ground", "body"];

const measure = (label) => {
  const lines = label.split("\n");
  return { lines, width: 22 + kCharacter * Math.max(...lines.map((l) => l.length)), height: 12 + kLine * lines.length };
};

/** Edges with their direction such that no cycle is left. */
function find_forward(nodes, edges) {
  const out = new Map(nodes.map((n) => [n.id, []]));
  for (const edge of edges) if (edge.from !== edge.to) out.get(edge.from).push(edge);
  const state = new Map(), backward = new Set();
  const visit = (id) => {
    state.set(id, "open");
    for (const edge of out.get(id)) {
      if (state.get(edge.to) === "open") backward.add(edge);
      else if (!state.has(edge.to)) visit(edge.to);
    }
    state.set(id, "done");
  };
  for (const node of [...nodes].sort((a, b) => kOrder.indexOf(a.kind) - kOrder.indexOf(b.kind))) if (!state.has(node.id)) visit(node.id);
  return backward;
}

function assign_layers(boxes, links) {
  const layer = new Map([...boxes.keys()].map((id) => [id, 0]));
  for (let changed = true, turns = 0; changed && turns <= boxes.size; ++turns) {
    changed = false;
    for (const { from, to } of links)
      if (layer.get(to) < layer.get(from) + 1) {
        layer.set(to, layer.get(from) + 1);
        changed = true;
      }
  }
  // A source stands just before the first that it feeds.
  for (const id of boxes.keys()) {
    if (links.some((l) => l.to === id)) continue;
    const next = links.filter((l) => l.from === id).map((l) => layer.get(l.to));
    if (next.length > 0) layer.set(id, Math.min(...next) - 1);
  }
  return layer;
}

function count_crossings(upper, lower, pairs) {
  const place = new Map(lower.map((id, i) => [id, i]));
  const ends = upper.flatMap((id) => pairs.filter((p) => p[0] === id).map((p) => place.get(p[1])).sort((a, b) => a - b));
  let count = 0;
  for (let i = 0; i < ends.length; ++i) for (let j = i + 1; j < ends.length; ++j) if (ends[i] > ends[j]) ++count;
  return count;
}

/** Orders the layers; pairs: between neighbours, by ids. */
function order_layers(layers, pairs) {
  const forward = new Map(), backward = new Map();
  for (const [a, b] of pairs) {
    forward.set(a, [...(forward.get(a) ?? []), b]);
    backward.set(b, [...(backward.get(b) ?? []), a]);
  }
  const total = (all) => all.slice(1).reduce((sum, layer, i) => sum + count_crossings(all[i], layer, pairs.filter(([a]) => all[i].includes(a))), 0);
  let best = layers.map((l) => [...l]), least = total(best), now = layers.map((l) => [...l]);
  for (let sweep = 0; sweep < kSweeps && least > 0; ++sweep) {
    const is_down = sweep % 2 === 0, neighbours = is_down ? backward : forward;
    const indices = now.map((_, i) => i);
    for (const i of is_down ? indices.slice(1) : indices.slice(0, -1).reverse()) {
      const place = new Map(now[i + (is_down ? -1 : 1)].map((id, k) => [id, k]));
      const weight = new Map(now[i].map((id, k) => {
        const near = (neighbours.get(id) ?? []).map((n) => place.get(n));
        return [id, near.length > 0 ? near.reduce((a, b) => a + b) / near.length : k];
      }));
      now[i].sort((a, b) => weight.get(a) - weight.get(b));
    }
    const crossings = total(now);
    if (crossings < least) [best, least] = [now.map((l) => [...l]), crossings];
  }
  return best;
}

/** Heights: each box near the middle of its neighbours, in the order of its layer. */
function place_rows(layers, boxes, pairs) {
  for (const layer of layers) {
    let y = 0;
    for (const id of layer) {
      boxes.get(id).y = y;
      y += boxes.get(id).height + kRowGap;
    }
  }
  const middle = (id) => boxes.get(id).y + boxes.get(id).height / 2;
  for (let turn = 0; turn < 8; ++turn) {
    const order = turn % 2 === 0 ? layers : [...layers].reverse();
    for (const layer of order) {
      const wished = layer.map((id) => {
        const near = pairs.filter((p) => p.includes(id)).map(([a, b]) => middle(a === id ? b : a));
        return near.length > 0 ? near.reduce((a, b) => a + b) / near.length : middle(id);
      });
      // Pushed apart from the top, then from the bottom, and the mean of both: nobody is favoured.
      const down = [], up = [];
      layer.forEach((id, i) => {
        const half = boxes.get(id).height / 2, free = i > 0 ? down[i - 1] + boxes.get(layer[i - 1]).height / 2 + kRowGap + half : -Infinity;
        down.push(Math.max(wished[i], free));
      });
      for (let i = layer.length - 1; i >= 0; --i) {
        const half = boxes.get(layer[i]).height / 2, free = i + 1 < layer.length ? up[0] - boxes.get(layer[i + 1]).height / 2 - kRowGap - half : Infinity;
        up.unshift(Math.min(wished[i], free));
      }
      layer.forEach((id, i) => (boxes.get(id).y = (down[i] + up[i]) / 2 - boxes.get(id).height / 2));
    }
  }
}

/**
 * @param {Node[]} nodes
 * @param {Edge[]} edges
 * @returns {{boxes: Map<string, {x: number, y: number, width: number, height: number, lines: string[]}>, paths: {edge: Edge, points: number[][]}[], width: number, height: number}}
 */
export function lay_out(nodes, edges) {
  const boxes = new Map(nodes.map((n) => [n.id, { x: 0, y: 0, ...measure(n.label) }]));
  edges = edges.filter((e) => boxes.has(e.from) && boxes.has(e.to));
  const backward = find_forward(nodes, edges);
  const links = edges.filter((e) => e.from !== e.to).map((edge) => (backward.has(edge) ? { edge, from: edge.to, to: edge.from } : { edge, from: edge.from, to: edge.to }));
  const layer_of = assign_layers(boxes, links);
  const lowest = Math.min(0, ...layer_of.values());
  const layers = [];
  for (const [id, at] of layer_of) (layers[at - lowest] ??= []).push(id);
  for (let i = 0; i < layers.length; ++i) layers[i] ??= [];
  // A long edge has a place of its own in each layer that it passes.
  const pairs = [], ways = new Map();
  links.forEach((link, k) => {
    const way = [link.from];
    for (let at = layer_of.get(link.from) + 1; at < layer_of.get(link.to); ++at) {
      const id = `\n${k} ${at}`;
      boxes.set(id, { x: 0, y: 0, width: 0, height: 6, lines: [] });
      layers[at - lowest].push(id);
      way.push(id);
    }
    way.push(link.to);
    for (let i = 1; i < way.length; ++i) pairs.push([way[i - 1], way[i]]);
    ways.set(link, way);
  });
  const ordered = order_layers(layers, pairs);
  place_rows(ordered, boxes, pairs);
  let x = 10;
  for (const layer of ordered) {
    const width = Math.max(0, ...layer.map((id) => boxes.get(id).width));
    for (const id of layer) boxes.get(id).x = x + (width - boxes.get(id).width) / 2;
    x += width + kColumnGap;
  }
  const top = Math.min(...[...boxes.values()].map((b) => b.y));
  for (const box of boxes.values()) box.y += 14 - top;
  const paths = links.map((link) => {
    const way = ways.get(link).map((id) => boxes.get(id));
    const points = way.flatMap((box, i) => {
      const y = box.y + box.height / 2;
      return [...(i > 0 ? [[box.x, y]] : []), ...(i + 1 < way.length ? [[box.x + box.width, y]] : [])];
    });
    return { edge: link.edge, points: backward.has(link.edge) ? points.reverse() : points };
  });
  const height = Math.max(...[...boxes.values()].map((b) => b.y + b.height)) + 14;
  for (const id of [...boxes.keys()]) if (id.startsWith("\n")) boxes.delete(id);
  return { boxes, paths, width: x - kColumnGap + 10, height };
}
