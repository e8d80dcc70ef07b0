import { make_coarse_mesh } from "./coarse_mesh.js";
import { find_distance_to_segment, find_front, is_hidden } from "./picking.js";
import { el, get_css, make_button, make_file_name, on_theme, save_blob } from "./page_parts.js";

// 4 x 4 matrices, columns first, as WebGL takes them.
const multiply = (a, b) => {
  const c = new Float32Array(16);
  for (let j = 0; j < 4; ++j) for (let i = 0; i < 4; ++i) for (let k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
};
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const kVertex = `#version 300 es
uniform mat4 view;
uniform float reach, lift;
in vec3 place;
in float size;
out float level;
out vec3 at;
void main() {
  level = size < -0.5 ? -1.0 : reach > 0.0 ? clamp(size / reach, 0.0, 1.0) : 0.0;
  at = place;
  gl_Position = view * vec4(place, 1.0);
  gl_Position.z -= lift * gl_Position.w;
  gl_PointSize = 5.0;
}`;
// Colours of displacement: five stops of viridis (Smith & van der Walt 2015, CC0), read by the colour-blind too.
const kFragment = `#version 300 es
precision highp float;
uniform vec4 color;
uniform float by_level, lit;
uniform vec3 eye;
in float level;
in vec3 at;
out vec4 pixel;
vec3 viridis(float t) {
  vec3 c[5] = vec3[5](vec3(0.267, 0.005, 0.329), vec3(0.229, 0.322, 0.546), vec3(0.128, 0.567, 0.551), vec3(0.369, 0.789, 0.383), vec3(0.993, 0.906, 0.144));
  float s = t * 4.0;
  int i = int(min(floor(s), 3.0));
  return mix(c[i], c[i + 1], s - float(i));
}
void main() {
  vec3 base = level < -0.5 ? color.rgb : mix(color.rgb, viridis(level), by_level);
  if (lit > 0.5) {
    vec3 n = normalize(cross(dFdx(at), dFdy(at)));
    base *= 0.45 + 0.55 * abs(dot(n, normalize(eye - at)));
  }
  pixel = vec4(base, color.a);
}`;

const to_rgba = (css, alpha = 1) => {
  const v = parseInt(css.slice(1), 16);
  return [(v >> 16) / 255, ((v >> 8) & 255) / 255, (v & 255) / 255, alpha];
};

// Place on the canvas of a point in space; null behind the eye.
const project = (view, rect, p) => {
  const [x, y, , w] = [0, 1, 2, 3].map((r) => view[r] * p[0] + view[4 + r] * p[1] + view[8 + r] * p[2] + view[12 + r]);
  return w > 0 ? [(rect.width * (1 + x / w)) / 2, (rect.height * (1 - y / w)) / 2] : null;
};

// While a scene of more faces moves (it turns, or it is played), a pixel in four is drawn, with about this number of faces
// and no longer lists of edges: without a graphics card, and with one.
const kMaxMoving = { software: 5000, hardware: 500000 };
const kSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i;

const kMaxPick = 14;  // pixels between a click and what it names

// A stage on which things are drawn: { points, size, triangles, edges, lines (edges in the colour), color, by_level, line_color }; marks stand before
// all things. With by_level a point's colour is its size over `reach`; with elements and levels (Drawing) each element
// has one colour, -1: `color`; with corner_levels each corner of a triangle. A thing with is_detail hides no node and is
// left out while a large scene moves. Dragging turns, the right button or shift
// moves, the wheel comes nearer, a double click shows all.
export class Viewer {
  /** @param {number | string} height  in pixels, or as CSS has it */
  constructor(height = 420) {
    this.canvas = el("canvas", { class: "scene", tabindex: "0", role: "img", "aria-label": "three-dimensional view" });
    this.canvas.style.height = typeof height === "number" ? height + "px" : height;
    this.tip = el("div", { class: "tip", hidden: true, role: "status" });
    this.thinned = el("div", { class: "thinned", hidden: true });
    this.element = el("div", { class: "viewer" }, this.canvas, this.tip, this.thinned);
    const gl = this.canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("WebGL 2 is not there");
    this.gl = gl;
    this.program = this.make_program();
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    this.is_software = Boolean(info && kSoftware.test(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
    this.max_moving = this.is_software ? kMaxMoving.software : kMaxMoving.hardware;
    this.smooth = null;  // framebuffer of several samples per pixel, and its buffers
    this.coarse = new WeakMap();  // coarse meshes by the faces of the whole ones
    this.is_turning = false;  // the pointer turns or moves it
    this.is_played = false;  // what it shows moves
    this.buffers = { place: gl.createBuffer(), size: gl.createBuffer(), index: gl.createBuffer() };
    this.name = "";
    this.on_pick = null;  // called with the node that was clicked and with the element, null for none
    this.on_menu = null;  // called with the element under a right click that is no drag, or null, and its place
    this.on_key = null;  // returns true for a key that it has handled
    this.on_grab = null;  // what takes a drag that begins here: { move(event), end() }, or null
    this.can_grab = null;  // returns true where on_grab takes one
    this.repaint = () => this.draw();  // after a change of the theme: the owner of the things gives them their new colours
    this.things = [];
    this.marks = [];
    this.reach = 0;
    this.target = [0, 0, 0];
    this.distance = 5;
    this.extent = 2;
    this.yaw = -1.0;
    this.pitch = 0.45;
    this.listen();
    on_theme(() => this.repaint());
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.canvas);
  }

  make_program() {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "place");
    gl.bindAttribLocation(program, 1, "size");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = Object.fromEntries(["view", "reach", "lift", "color", "by_level", "lit", "eye"].map((name) => [name, gl.getUniformLocation(program, name)]));
    this.at = (name) => places[name];
    return program;
  }

  // Shows all of a box; the camera keeps its direction.
  fit(box) {
    this.home = box;
    this.target = box.get_middle();
    this.extent = box.get_diagonal();
    this.distance = Math.max(this.find_distance(box), 0.3 * this.extent);
    this.is_fitted_late = this.canvas.clientWidth < 10;  // not on the page yet: its shape is unknown
    this.draw();
  }

  // From where each point of the hull, or each corner, of a box is seen, with some room for what moves out of it.
  find_distance(box) {
    const { back, right, up } = this.get_axes();
    const half = box.low.map((low, i) => (box.high[i] >= low ? (box.high[i] - low) / 2 : 0.5));
    const [fx, fy] = this.get_lens();
    let distance = 0;
    const take = (p) => (distance = Math.max(distance, fx * Math.abs(dot(right, p)) + dot(back, p), fy * Math.abs(dot(up, p)) + dot(back, p)));
    const { hull } = box, middle = box.get_middle();
    for (let k = 0; k + 2 < hull.length; k += 3) take([hull[k] - middle[0], hull[k + 1] - middle[1], hull[k + 2] - middle[2]]);
    for (let corner = 0; corner < 8 && hull.length === 0; ++corner) take(half.map((h, i) => ((corner >> i) & 1 ? h : -h)));
    return 1.15 * distance;
  }

  // The angle holds for the shorter side.
  get_lens() {
    const aspect = this.canvas.width > 0 && this.canvas.height > 0 ? this.canvas.width / this.canvas.height : 1, f = 1 / Math.tan(0.35);
    return aspect > 1 ? [f / aspect, f] : [f, f * aspect];
  }

  // Looks across what happens in one plane of the axes.
  face(box) {
    const thin = box.low.map((low, i) => box.high[i] - low < 0.05 * box.get_diagonal());
    if (thin.filter(Boolean).length !== 1) return;
    if (thin[0]) [this.yaw, this.pitch] = [-0.3, 0.2];
    if (thin[1]) [this.yaw, this.pitch] = [-Math.PI / 2 - 0.3, 0.2];
    if (thin[2]) [this.yaw, this.pitch] = [-Math.PI / 2, 1.15];
  }

  get_axes() {
    const c = Math.cos(this.pitch);
    const back = [c * Math.cos(this.yaw), c * Math.sin(this.yaw), Math.sin(this.pitch)];
    const right = [-Math.sin(this.yaw), Math.cos(this.yaw), 0];
    return { back, right, up: cross(back, right) };
  }

  make_view() {
    const { back, right, up } = this.get_axes();
    const eye = this.target.map((t, i) => t + this.distance * back[i]);
    this.eye = eye;
    const look = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
    const [fx, fy] = this.get_lens();
    const near = Math.max(this.distance - 3 * this.extent, 0.01 * this.distance), far = this.distance + 3 * this.extent;
    const lens = [fx, 0, 0, 0, 0, fy, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
    return multiply(lens, look);
  }

  count_faces() {
    return this.things.reduce((sum, thing) => sum + (thing.triangles?.length ?? 0) / 3, 0);
  }
  is_large() {
    return this.count_faces() > this.max_moving;
  }

  /** Plays or rests: large scenes are drawn with less while they move. @param {boolean} is_on */
  set_played(is_on) {
    if (this.is_played === is_on) return;
    this.is_played = is_on;
    if (!is_on) requestAnimationFrame(() => this.draw());
  }

  // Things with fewer faces and edges, and a note of it.
  thin() {
    const whole = this.count_faces();
    let count = 0;
    const things = this.things.filter((thing) => !thing.is_detail).map((thing) => {
      const edges = thing.edges?.length > 2 * this.max_moving ? undefined : thing.edges;
      if (!(thing.triangles?.length > 0)) return { ...thing, edges };
      if (!this.coarse.has(thing.triangles)) this.coarse.set(thing.triangles, make_coarse_mesh(thing.points, thing.triangles, Math.max(100, (this.max_moving * thing.triangles.length) / (3 * whole))));
      const { triangles, sources } = this.coarse.get(thing.triangles), { elements } = thing;
      count += sources.length;
      return { ...thing, edges, triangles, corner_levels: undefined, ...(thing.levels ? { edges: new Uint32Array(), elements: { of_triangle: sources.map((t) => elements.of_triangle[t]), of_edge: new Uint32Array() } } : {}) };
    });
    this.thinned.textContent = `while it moves: ${count} of ${whole} faces`;
    return things;
  }

  // After a movement of the pointer: there are more of them than pictures that a large mesh can be drawn in.
  draw_moved() {
    if (!this.is_large()) return this.draw();
    this.moved ??= requestAnimationFrame(() => {
      this.moved = null;
      this.draw();
    });
  }

  draw() {
    const gl = this.gl, is_moving = this.is_turning || this.is_played, is_thinned = is_moving && this.is_large();
    const scale = (devicePixelRatio || 1) * (is_thinned ? 0.5 : 1);
    const width = Math.round(this.canvas.clientWidth * scale), height = Math.round(this.canvas.clientHeight * scale);
    if (width < 10 || height < 10) return;
    if (this.canvas.width !== width || this.canvas.height !== height) [this.canvas.width, this.canvas.height] = [width, height];
    if (this.is_fitted_late) return this.fit(this.home);
    // Samples cost two thirds of a picture where no graphics card draws it.
    const is_smooth = !(is_moving && this.is_software);
    if (is_smooth) this.bind_smooth(width, height);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...to_rgba(get_css("--stage")));
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(this.at("view"), false, this.make_view());
    gl.uniform3fv(this.at("eye"), this.eye);
    gl.uniform1f(this.at("reach"), this.reach);
    for (const thing of is_thinned ? this.thin() : this.things) this.draw_thing(thing);
    this.thinned.hidden = !is_thinned;
    gl.clear(gl.DEPTH_BUFFER_BIT);  // no body hides what comes now
    for (const thing of this.marks) this.draw_thing(thing);
    if (is_smooth) {
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
      gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    }
    this.update_tip();
  }

  // Draws into four samples per pixel from now on.
  bind_smooth(width, height) {
    const gl = this.gl;
    this.smooth ??= { frame: gl.createFramebuffer(), color: gl.createRenderbuffer(), depth: gl.createRenderbuffer(), width: 0, height: 0 };
    const { frame, color, depth } = this.smooth;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    if (this.smooth.width === width && this.smooth.height === height) return;
    const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
    for (const [buffer, format, at] of [[color, gl.RGBA8, gl.COLOR_ATTACHMENT0], [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, at, gl.RENDERBUFFER, buffer);
    }
    [this.smooth.width, this.smooth.height] = [width, height];
  }

  draw_thing(thing) {
    if (thing.levels) return this.draw_elements(thing);
    const gl = this.gl;
    const count = thing.points.length / 3;
    this.fill(thing.points, thing.size);
    const draw = (kind, indices, color, by_level, lit, lift) => {
      gl.uniform4fv(this.at("color"), color);
      gl.uniform1f(this.at("by_level"), by_level ? 1 : 0);
      gl.uniform1f(this.at("lit"), lit ? 1 : 0);
      gl.uniform1f(this.at("lift"), lift);
      if (!indices) return gl.drawArrays(kind, 0, count);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.index);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STREAM_DRAW);
      gl.drawElements(kind, indices.length, gl.UNSIGNED_INT, 0);
    };
    const color = to_rgba(thing.color, thing.alpha ?? 1);
    const has_faces = thing.triangles?.length > 0;
    if (has_faces) draw(gl.TRIANGLES, thing.triangles, color, thing.by_level, true, 0);
    if (thing.edges?.length > 0)
      draw(gl.LINES, thing.edges, has_faces ? to_rgba(get_css("--edge"), (thing.alpha ?? 1) * 0.6) : color, !has_faces && thing.by_level, false, thing.lift ?? 1e-4);
    if (has_faces && thing.lines?.length > 0) draw(gl.LINES, thing.lines, color, thing.by_level, false, 2 * (thing.lift ?? 1e-4));
    if (thing.ghosts?.length > 0) draw(gl.LINES, thing.ghosts, to_rgba(get_css("--ghost"), 0.6), false, false, 0);
    if (thing.dots) draw(gl.POINTS, null, color, thing.by_level, false, 2e-4);
  }

  fill(points, size) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.place);
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.STREAM_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.size);
    if (size) {
      gl.bufferData(gl.ARRAY_BUFFER, size, gl.STREAM_DRAW);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribPointer(1, 1, gl.FLOAT, false, 0, 0);
    } else gl.disableVertexAttribArray(1);
  }

  // Corners of neighbours are drawn apart, each in the colour of its element; outlines as ever.
  draw_elements(thing) {
    const gl = this.gl, { points, triangles, edges, elements, levels, corner_levels } = thing;
    const spread = (indices, of, corners, is_kept, at_corner) => {
      const place = [], size = [];
      for (let i = 0; i < of.length; ++i) {
        if (!is_kept(of[i])) continue;
        for (let c = 0; c < corners; ++c) {
          const p = 3 * indices[corners * i + c];
          place.push(points[p], points[p + 1], points[p + 2]);
          size.push(at_corner ? at_corner[corners * i + c] : levels[of[i]]);
        }
      }
      this.fill(new Float32Array(place), new Float32Array(size));
      return size.length;
    };
    gl.uniform1f(this.at("reach"), 1);
    gl.uniform4fv(this.at("color"), to_rgba(thing.color));
    gl.uniform1f(this.at("by_level"), 1);
    for (const [kind, indices, of, corners, lit, lift] of [[gl.TRIANGLES, triangles, elements.of_triangle, 3, 1, 0], [gl.LINES, edges, elements.of_edge, 2, 0, 2e-4]]) {
      const count = spread(indices, of, corners, (element) => element !== 0xffffffff, corners === 3 ? corner_levels : undefined);
      gl.uniform1f(this.at("lit"), lit);
      gl.uniform1f(this.at("lift"), lift);
      if (count > 0) gl.drawArrays(kind, 0, count);
    }
    gl.uniform1f(this.at("reach"), this.reach);
    const outlines = [];
    elements.of_edge.forEach((element, i) => element === 0xffffffff && outlines.push(edges[2 * i], edges[2 * i + 1]));
    const { levels: _, ...rest } = thing;
    this.draw_thing({ ...rest, triangles: undefined, edges: Uint32Array.from(outlines), color: get_css("--edge"), alpha: 0.6, by_level: false, dots: false });
  }

  listen() {
    let last = null;
    let start = null, wheel = 0;
    const rest = () => {
      last = start = null;
      if (this.is_turning) requestAnimationFrame(() => this.draw());
      this.is_turning = false;
    };
    let grabbed = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      grabbed = event.button === 0 ? this.on_grab?.(event) : null;
      if (!grabbed) last = start = event;
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (grabbed) return grabbed.move(event);
      if (!last) {
        if (this.can_grab) this.canvas.style.cursor = this.can_grab(event) ? "grab" : "";
        return;
      }
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      const is_shift = last.shiftKey || last.buttons === 2;
      last = { clientX: event.clientX, clientY: event.clientY, shiftKey: event.shiftKey, buttons: event.buttons };
      this.is_turning = true;
      if (is_shift) {
        const { right, up } = this.get_axes(), unit = (0.75 * this.distance) / this.canvas.clientHeight;
        this.target = this.target.map((t, i) => t - unit * dx * right[i] + unit * dy * up[i]);
      } else {
        this.yaw -= 0.008 * dx;
        this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + 0.008 * dy));
      }
      this.draw_moved();
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (grabbed) {
        grabbed.end();
        grabbed = null;
        return;
      }
      const is_click = start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 4;
      if (is_click && event.button === 0) this.pick(event);
      if (is_click && event.button === 2) this.open_menu(event);
      rest();
    });
    this.canvas.addEventListener("pointercancel", () => {
      grabbed?.end();
      grabbed = null;
      rest();
    });
    this.canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    this.canvas.addEventListener("dblclick", () => this.home && this.fit(this.home));
    this.canvas.addEventListener("keydown", (event) => this.on_key?.(event) || this.turn_by_key(event));
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.distance *= Math.exp(0.001 * event.deltaY);
      if (!start) {
        this.is_turning = true;
        clearTimeout(wheel);
        wheel = setTimeout(() => !start && rest(), 200);
      }
      this.draw_moved();
    }, { passive: false });
  }

  // Arrow keys turn, with shift they move; + and - come nearer and go away, 0 shows all.
  turn_by_key(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const near = { "+": 0.9, "-": 1 / 0.9 }[event.key];
    if (steps && event.shiftKey) {
      const { right, up } = this.get_axes(), unit = 0.03 * this.distance;
      this.target = this.target.map((t, i) => t + unit * (steps[0] * right[i] - steps[1] * up[i]));
    } else if (steps) {
      this.yaw += 0.1 * steps[0];
      this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + 0.1 * steps[1]));
    } else if (near) this.distance *= near;
    else if (event.key === "0" && this.home) this.fit(this.home);
    else return;
    event.preventDefault();
    this.draw();
  }

  // Place on the canvas of a point in space, null behind the eye; and the way from the eye through a place.
  find_place(point) {
    return project(this.make_view(), this.canvas.getBoundingClientRect(), point);
  }
  make_ray({ clientX, clientY }) {
    const rect = this.canvas.getBoundingClientRect(), { back, right, up } = this.get_axes(), [fx, fy] = this.get_lens();
    const x = ((2 * (clientX - rect.left)) / rect.width - 1) / fx, y = (1 - (2 * (clientY - rect.top)) / rect.height) / fy;
    const way = back.map((b, i) => x * right[i] + y * up[i] - b), length = Math.hypot(...way);
    return { eye: this.target.map((t, i) => t + this.distance * back[i]), direction: way.map((v) => v / length) };
  }

  // A click names the nearest node that no face hides: things with `ids` and `describe(index)`, of which
  // those `marked` are seen through faces; of things with `describe_element(element)` the element too.
  pick(event) {
    const rect = this.canvas.getBoundingClientRect(), view = this.make_view(), ray = this.make_ray(event);
    const click = [event.clientX - rect.left, event.clientY - rect.top], near = [];
    for (const thing of this.things) {
      if (!thing.describe) continue;
      const p = thing.points;
      for (let k = 0; k < thing.ids.length; ++k) {
        const at = project(view, rect, p.subarray(3 * k, 3 * k + 3));
        const distance = at ? Math.hypot(at[0] - click[0], at[1] - click[1]) : Infinity;
        if (distance < kMaxPick) near.push({ thing, k, at, distance });
      }
    }
    near.sort((a, b) => a.distance - b.distance);
    const found = near.slice(0, 40).find(({ thing, k }) => thing.marked?.has(k) || !is_hidden(this.things, ray.eye, thing, k, 1e-4 * this.extent)) ?? null;
    const element = this.find_element(ray, click, view, rect);
    const texts = [...(element ? [() => element.thing.describe_element(element.element)] : []), ...(found ? [() => found.thing.describe(found.k)] : [])];
    const beyond = element && !found ? this.find_place_of_click(ray) : null;
    this.set_tip(texts.length > 0 ? () => texts.map((text) => text()).join("\n") : null, () => (found ? found.thing.points.subarray(3 * found.k, 3 * found.k + 3) : beyond));
    this.on_pick?.(found && { thing: found.thing, index: found.k, id: found.thing.ids[found.k] }, element);
    this.update_tip();
  }

  // Where the ray meets a face, or as far from the eye as the middle of the view.
  find_place_of_click(ray) {
    const distance = find_front(this.things, ray)?.distance ?? Math.hypot(...ray.eye.map((e, i) => this.target[i] - e));
    return ray.eye.map((e, i) => e + distance * ray.direction[i]);
  }

  open_menu(event) {
    const rect = this.canvas.getBoundingClientRect(), click = [event.clientX - rect.left, event.clientY - rect.top];
    this.on_menu?.(this.find_element(this.make_ray(event), click, this.make_view(), rect), click);
  }

  // The element at a place: its face that is met first, else a line near by.
  find_element(ray, click, view, rect) {
    if (!this.things.some((t) => t.describe_element)) return null;
    const front = find_front(this.things, ray);
    if (front) return front.thing.describe_element ? { thing: front.thing, element: front.thing.elements.of_triangle[front.triangle] } : null;
    let best = kMaxPick, found = null;
    for (const thing of this.things) {
      if (!thing.describe_element) continue;
      thing.elements.of_edge.forEach((element, i) => {
        if (element === 0xffffffff) return;
        const [a, b] = [0, 1].map((c) => 3 * thing.edges[2 * i + c]).map((p) => project(view, rect, thing.points.subarray(p, p + 3)));
        const distance = a && b ? find_distance_to_segment(click, a, b) : Infinity;
        if (distance < best) [best, found] = [distance, { thing, element }];
      });
    }
    return found;
  }

  // Labels the node with this id (of this body) as a click on it does, without calling on_pick; no label if there is none.
  name_node(id, body = undefined) {
    const thing = this.things.find((t) => t.describe && (body === undefined || t.body === body) && t.ids.includes(id)), k = thing ? thing.ids.indexOf(id) : -1;
    this.set_tip(thing ? () => thing.describe(k) : null, () => thing.points.subarray(3 * k, 3 * k + 3));
    this.update_tip();
  }

  // What the label reads, and its place in the world; null: no label.
  set_tip(picked, get_place) {
    this.picked = picked;
    this.get_tip_place = get_place;
  }

  // The label of the picked node goes with the node: its value with the time, its place with the camera.
  update_tip() {
    const { clientWidth: width, clientHeight: height } = this.canvas, at = this.picked ? project(this.make_view(), { width, height }, this.get_tip_place()) : null;
    this.tip.hidden = !at || at[0] < 0 || at[0] > width || at[1] < 0 || at[1] > height;
    if (this.tip.hidden) return;
    this.tip.textContent = this.picked();
    this.tip.style.left = Math.min(at[0] + 10, width - 240) + "px";
    this.tip.style.top = at[1] + 10 + "px";
  }

  // Frees the memory of the graphics card; a browser has few such contexts.
  dispose() {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.draw = () => {};
  }

  make_view_buttons() {
    const look = (yaw, pitch) => () => {
      [this.yaw, this.pitch] = [yaw, pitch];
      this.draw();
    };
    return el("span", { class: "views" }, make_button("x", "Look against the x axis", look(0, 0)), make_button("y", "Look against the y axis", look(-Math.PI / 2, 0)),
      make_button("z", "Look against the z axis", look(-Math.PI / 2, 1.55)), make_button("all", "Show all (double click)", () => this.home && this.fit(this.home)),
      make_button("PNG", "Save this picture", () => this.save()));
  }

  save() {
    this.draw();
    this.canvas.toBlob((blob) => save_blob(blob, make_file_name(this.name || "view", "png")));
  }
}

// Three axes of this length at a place, R columns: red, green, blue would not tell the colour-blind; letters do in the
// legend, lengths here: x is the longest.
export function make_triad(place, axes, length) {
  return axes.map((axis, i) => {
    const tip = place.map((p, k) => p + length * [1, 0.8, 0.6][i] * axis[k]);
    return { points: new Float32Array([...place, ...tip]), edges: new Uint32Array([0, 1]), color: ["#d55e00", "#009e73", "#0072b2"][i] };
  });
}
