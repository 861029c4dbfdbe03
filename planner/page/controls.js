// The controls of the drape in space, and the picture that they ask for.

const kInk = { mold: "--view-mold", line: "--view-line", boundary: "--boundary", rig: "--view-rig", sky: "--view-sky" };
const bytes = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));

class DrapeView {
  constructor(section, data) {
    this.section = section;
    this.data = data;
    this.canvas = section.querySelector("canvas");
    const gl = this.canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) return;
    this.painter = new Painter(gl);
    this.mold = data.mold && readMold(data.mold);
    this.boundary = data.boundary ? unpack(data.boundary) : [];
    this.ready = [];  // drapes that were looked at
    this.camera = new Camera(data.box);
    this.part = (name) => section.querySelector(`[data-part="${name}"]`);
    section.hidden = false;
    this.connect();
    this.choose();
  }

  get drape() {
    const k = this.part("drape").selectedIndex;
    return this.ready[k] ??= readDrape(this.data.drapes[k]);
  }
  get aspect() { return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight); }
  get time() {
    const { times } = this.drape, share = this.part("time").value / kSteps;
    return times[0] + share * (times.at(-1) - times[0]);
  }

  connect() {
    const { data, part, canvas } = this;
    for (const drape of data.drapes) part("drape").add(new Option(drape.name));
    part("drape").selectedIndex = data.drapes.length - 1;
    part("drapes").hidden = data.drapes.length < 2;
    data.fields.forEach((field, k) => {
      if (data.drapes.some((drape) => drape.fields[k])) part("field").add(new Option(field.name, k));
    });
    for (const [name, there] of [["mold", this.mold], ["rig", data.drapes[0].pads], ["boundary", data.boundary]])
      part(name).closest("label").hidden = !there;
    const apart = Number((1e3 * data.spacing).toPrecision(3));
    part("lines").textContent = `Thin lines on the ply run along warp and weft, ${apart} mm apart.`;
    for (const name of ["drape", "field"]) part(name).addEventListener("change", () => this.choose());
    for (const name of ["mold", "rig", "boundary"]) part(name).addEventListener("change", () => this.draw());
    part("time").addEventListener("input", () => { this.stop(); this.draw(); });
    part("play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    part("reset").addEventListener("click", () => { this.camera.reset(); this.draw(); });
    canvas.addEventListener("webglcontextlost", () => { this.section.hidden = true; });
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => { part("readout").textContent = ""; });
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  // One pointer rotates; two move and zoom; none shows the value below.
  drag(event) {
    const before = this.pointers.get(event.pointerId), now = [event.clientX, event.clientY];
    if (!before) { this.read(event); return; }
    const { camera, aspect, canvas: { clientHeight: height } } = this;
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    const other = [...this.pointers].find(([id]) => id !== event.pointerId);
    if (other) {
      const apart = ([x, y]) => Math.hypot(x - other[1][0], y - other[1][1]);
      camera.magnify(apart(now) / Math.max(1, apart(before)));
      camera.move(0.5 * dx / height, 0.5 * dy / height, aspect);
    } else if (event.shiftKey || event.buttons > 1) {
      camera.move(dx / height, dy / height, aspect);
    } else {
      camera.turn(3.5 * dx / height, 3.5 * dy / height);
    }
    this.pointers.set(event.pointerId, now);
    this.draw();
  }

  // The wheel scrolls the page unless one has clicked on the picture.
  wheel(event) {
    if (document.activeElement !== this.canvas && !event.ctrlKey) return;
    event.preventDefault();
    this.camera.magnify(Math.exp(-0.0015 * event.deltaY));
    this.draw();
  }

  key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    const zoom = { "+": 1.2, "-": 1 / 1.2 }[event.key];
    if (!turns && !zoom) return;
    event.preventDefault();
    if (zoom) this.camera.magnify(zoom);
    else if (event.shiftKey) this.camera.move(turns[0], turns[1], this.aspect);
    else this.camera.turn(turns[0], turns[1]);
    this.draw();
  }

  play() {
    const { part } = this, slider = part("time");
    const from = Number(slider.value) >= kSteps ? 0 : Number(slider.value), began = performance.now();
    this.playing = true;
    part("play").textContent = "Pause";
    const step = (now) => {
      if (!this.playing) return;
      slider.value = Math.min(kSteps, from + kSteps * (now - began) / 1e3 / kPlaySeconds);
      this.draw();
      if (Number(slider.value) < kSteps) requestAnimationFrame(step);
      else this.stop();
    };
    requestAnimationFrame(step);
  }
  stop() {
    this.playing = false;
    this.part("play").textContent = "Play";
  }

  // Another drape or another colour.
  choose() {
    this.field = Number(this.part("field").value);
    const { colours } = this.data.fields[this.field];
    this.painter.setColours(colours.map(bytes));
    this.legend(this.data.fields[this.field]);
    this.draw();
  }

  legend({ name, unit, step, colours, decimals, classes }) {
    const legend = this.part("legend"), end = step * colours.length, every = Math.ceil(colours.length / 8);
    const make = (parent, style, text = "") => {
      const made = document.createElement("span");
      made.className = style;
      made.textContent = text;
      return parent.appendChild(made);
    };
    legend.replaceChildren();
    make(legend, "view-title", `${name} [${unit}]`);
    const bar = make(legend, "view-scale");
    for (const colour of colours) make(bar, "view-band").style.background = colour;
    for (let k = 0; k <= colours.length; k += every)
      make(bar, "view-tick", (k * step).toFixed(decimals)).style.left = `${100 * k / colours.length}%`;
    for (const { value, name: word } of classes ?? [])
      if (value <= end) make(bar, "view-class", word).style.left = `${100 * value / end}%`;
    make(legend, "view-more soft", "What is beyond the scale has its last colour.");
  }

  now() {
    const { drape } = this, moment = instant(drape.times, this.time);
    const place = between(drape.position, 3 * drape.nodes, moment), field = drape.fields[this.field];
    const grippers = drape.pads ? drape.pads.length / drape.times.length : 0;
    return {
      place, value: field && between(field, drape.nodes, moment), normal: normals(place, drape.quads),
      pads: drape.pads && between(drape.pads, grippers, moment),
      joints: drape.joints && between(drape.joints, grippers, moment),
    };
  }

  draw() {
    const { canvas, painter, camera, drape, part } = this, scale = Math.min(2, devicePixelRatio || 1);
    const size = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.max(1, Math.round(scale * x)));
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const style = getComputedStyle(this.section), ink = {};
    for (const [name, property] of Object.entries(kInk))
      ink[name] = bytes(style.getPropertyValue(property).trim()).map((x) => x / 255);
    const look = camera.look(this.aspect), light = unit(along(along(look.back, look.up, 0.5), look.right, 0.35));
    const seen = this.now(), lift = camera.elevation > 0 ? kLift : 0;
    painter.begin(look.matrix, look.eye, ink.sky);
    if (this.mold && part("mold").checked) painter.surface({ ...this.mold, plain: [...ink.mold, 1], light });
    painter.surface({
      place: seen.place, normal: seen.normal, triangles: drape.triangles, rest: drape.rest, value: seen.value,
      step: this.data.fields[this.field].step, plain: [...ink.mold, 1], spacing: this.data.spacing, lift, light,
    });
    const edge = Array.from(drape.outline, (node) => at(seen.place, node));
    painter.pieces(pieces(edge, true), { width: 1.6 * scale, colour: [...ink.line, 1], lift: 1.5 * lift });
    if (part("boundary").checked && this.boundary.length > 0) {
      const line = Array.from({ length: this.boundary.length / 3 }, (_, k) => at(this.boundary, k));
      painter.pieces(pieces(line, false), { width: 2.2 * scale, colour: [...ink.boundary, 1], lift: 2 * lift });
    }
    if (seen.pads && part("rig").checked) this.drawRig(seen, ink, scale, light, lift);
    part("clock").textContent = `${this.time.toFixed(2)} s`;
    this.seen = { ...seen, matrix: look.matrix };
  }

  // Discs of the pads, a rod from each to its joint and up to its actuator, bars between the joints.
  drawRig({ pads, joints }, ink, scale, light, lift) {
    const { painter, data } = this, rods = [], rings = [], bars = [];
    const discs = { place: [], normal: [], triangles: [] };
    for (let g = 0; 3 * g < pads.length; ++g) {
      const pad = at(pads, g), joint = at(joints, g), normal = unit(subtract(joint, pad));
      const rim = ring(pad, normal, data.pad_radius), first = discs.place.length / 3;
      rods.push(...pad, ...joint, ...joint, ...along(joint, [0, 0, 1], 3 * data.pad_radius));
      rings.push(...pieces(rim, true));
      [pad, ...rim].forEach((point) => { discs.place.push(...point); discs.normal.push(...normal); });
      rim.forEach((_, k) => discs.triangles.push(first, first + 1 + k, first + 1 + (k + 1) % rim.length));
    }
    for (const [a, b] of data.links) bars.push(...at(joints, a), ...at(joints, b));
    painter.pieces(bars, { width: 2.4 * scale, colour: [...ink.rig, 1], lift });
    painter.pieces(rods, { width: 3.2 * scale, colour: [...ink.rig, 1], lift });
    painter.surface({ place: new Float32Array(discs.place), normal: new Float32Array(discs.normal),
                      triangles: new Uint32Array(discs.triangles), plain: [...ink.rig, 0.28], lift: 1.5 * lift, light });
    painter.pieces(rings, { width: 1.4 * scale, colour: [...ink.rig, 1], lift: 1.6 * lift });
  }

  // The value at the node below the pointer.
  read(event) {
    const { canvas, drape, seen, data } = this, { left, top, width, height } = canvas.getBoundingClientRect();
    const m = seen.matrix, field = data.fields[this.field];
    let best = -1, nearest = Infinity;
    for (let k = 0; k < drape.nodes; ++k) {
      const [x, y, z, w] = [0, 1, 2, 3].map((r) => m[r] * seen.place[3 * k] + m[4 + r] * seen.place[3 * k + 1] +
                                                   m[8 + r] * seen.place[3 * k + 2] + m[12 + r]);
      const off = Math.hypot((0.5 + 0.5 * x / w) * width - event.clientX + left,
                             (0.5 - 0.5 * y / w) * height - event.clientY + top);
      if (off < kNearPointer && z / w < nearest) [best, nearest] = [k, z / w];
    }
    const [u, v] = [drape.rest[2 * best], drape.rest[2 * best + 1]].map((x) => (1e3 * x).toFixed(0));
    this.part("readout").textContent = best < 0 || !seen.value ? "" :
      `${field.name} ${seen.value[best].toFixed(field.decimals + 2)} ${field.unit} at u ${u}, v ${v} mm`;
  }
}

const data = document.getElementById("view-data");
if (data) new DrapeView(document.getElementById("view"), JSON.parse(data.textContent));
