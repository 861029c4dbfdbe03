// The drape in space: what the page's data hold, drawn at the time of the slider. See view.hpp for the data.

const kFieldOfView = 32 * Math.PI / 180;
const kStart = { azimuth: -60 * Math.PI / 180, elevation: 38 * Math.PI / 180 };  // as the pictures of the shear
const kPlaySeconds = 8;  // a whole run
const kSteps = 1000;     // of the slider
const kLift = 0.004;     // the ply is drawn before the mold that it lies on [m]
const kNearPointer = 14; // a node is meant by the pointer [px]

// Numbers that were packed into 16 bits each, `lower` to `upper`; 65535 stands for what is not finite.
function unpack({ lower, upper, data }) {
  const text = atob(data), count = text.length / 2, width = lower.length, numbers = new Float32Array(count);
  for (let k = 0; k < count; ++k) {
    const share = text.charCodeAt(2 * k) + 256 * text.charCodeAt(2 * k + 1), c = k % width;
    numbers[k] = share === 65535 ? NaN : lower[c] + (upper[c] - lower[c]) * share / 65534;
  }
  return numbers;
}

const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
const along = (a, way, by) => [a[0] + by * way[0], a[1] + by * way[1], a[2] + by * way[2]];
const at = (list, k) => [list[3 * k], list[3 * k + 1], list[3 * k + 2]];

// Unit normals of the nodes of quadrilaterals: sums of the crossed diagonals around each.
function normals(place, quads) {
  const sums = new Float32Array(place.length);
  for (let q = 0; q < quads.length; q += 4) {
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => at(place, quads[q + k]));
    const normal = cross(subtract(c, a), subtract(d, b));
    if (!normal.every(Number.isFinite)) continue;
    for (let k = 0; k < 4; ++k) for (let x = 0; x < 3; ++x) sums[3 * quads[q + k] + x] += normal[x];
  }
  return sums;
}

function triangles(quads) {
  const corners = new Uint32Array(quads.length / 4 * 6);
  for (let q = 0, k = 0; q < quads.length; q += 4)
    for (const c of [0, 1, 2, 0, 2, 3]) corners[k++] = quads[q + c];
  return corners;
}

// A drape made ready: all frames as numbers.
function readDrape(packed) {
  const quads = Uint32Array.from(packed.quads);
  const drape = {
    ...packed, quads, triangles: triangles(quads), rest: unpack(packed.rest), position: unpack(packed.position),
    fields: packed.fields.map((field) => field && unpack(field)),
    pads: packed.pads && unpack(packed.pads), joints: packed.joints && unpack(packed.joints),
  };
  drape.nodes = drape.rest.length / 2;
  return drape;
}

// The mold as a grid of quadrilaterals; cells that touch a place without a mold are left out.
function readMold({ columns, rows, place }) {
  const places = unpack(place), quads = [];
  for (let j = 0; j + 1 < rows; ++j) {
    for (let i = 0; i + 1 < columns; ++i) {
      const k = i + j * columns, cell = [k, k + 1, k + 1 + columns, k + columns];
      if (cell.every((node) => Number.isFinite(places[3 * node + 2]))) quads.push(...cell);
    }
  }
  return { place: places, quads, triangles: triangles(quads), normal: normals(places, quads) };
}

// Numbers of an instant between two frames. `count` numbers per frame.
function between(list, count, [frame, share]) {
  const now = list.slice(frame * count, (frame + 1) * count);
  if (share > 0) for (let k = 0; k < count; ++k) now[k] += share * (list[(frame + 1) * count + k] - now[k]);
  return now;
}

// The frame before a time, and the share of the way to the next one.
function instant(times, time) {
  let frame = 0;
  while (frame + 2 < times.length && times[frame + 1] <= time) ++frame;
  if (times.length < 2) return [0, 0];
  const share = (time - times[frame]) / (times[frame + 1] - times[frame]);
  return share >= 1 ? [frame + 1, 0] : [frame, Math.max(0, share)];
}

// Where one looks from.
class Camera {
  constructor(box) {
    this.box = box;
    this.reset();
  }
  reset() {
    const { lower, upper } = this.box;
    this.radius = 0.5 * Math.hypot(...subtract(upper, lower)) || 1;
    Object.assign(this, kStart, { target: lower.map((x, k) => 0.5 * (x + upper[k])), zoom: 1 });
  }
  // So far away that all is seen, also in a narrow picture.
  distance(aspect) {
    return 0.92 * this.radius / Math.sin(0.5 * kFieldOfView) / Math.min(1, 0.85 * aspect) / this.zoom;
  }
  axes() {
    const { azimuth, elevation } = this;
    const back = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
    const right = [-Math.sin(azimuth), Math.cos(azimuth), 0];
    return { back, right, up: cross(back, right) };
  }
  turn(dx, dy) {
    this.azimuth -= dx;
    this.elevation = Math.min(0.5 * Math.PI, Math.max(-0.2 * Math.PI, this.elevation + dy));
  }
  // By shares of the height of the picture.
  move(dx, dy, aspect) {
    const size = 2 * this.distance(aspect) * Math.tan(0.5 * kFieldOfView), { right, up } = this.axes();
    this.target = along(along(this.target, right, -dx * size), up, dy * size);
  }
  magnify(factor) {
    this.zoom = Math.min(30, Math.max(0.3, this.zoom * factor));
  }
  // The matrix of the picture, and the eye.
  look(aspect) {
    const { back, right, up } = this.axes(), distance = this.distance(aspect), eye = along(this.target, back, distance);
    const near = 0.02 * distance, far = distance + 6 * this.radius, f = 1 / Math.tan(0.5 * kFieldOfView);
    const depth = (far + near) / (near - far), offset = 2 * far * near / (near - far);
    const rows = [[...right.map((x) => f / aspect * x), -f / aspect * dot(right, eye)],
                  [...up.map((x) => f * x), -f * dot(up, eye)],
                  [...back.map((x) => depth * x), -depth * dot(back, eye) + offset],
                  [...back.map((x) => -x), dot(back, eye)]];
    const matrix = new Float32Array(16);
    rows.forEach((row, r) => row.forEach((x, c) => { matrix[4 * c + r] = x; }));
    return { matrix, eye, back, right, up };
  }
}

// Pieces of the line through points; of a closed one back to the first.
function pieces(points, closed) {
  const ends = [];
  for (let k = 0; k + 1 < points.length + (closed ? 1 : 0); ++k)
    ends.push(...points[k], ...points[(k + 1) % points.length]);
  return ends;
}

// A ring of points around the centre of a pad, across its normal.
function ring(centre, normal, radius) {
  const first = unit(cross(normal, Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), second = cross(normal, first);
  return Array.from({ length: 28 }, (_, k) => {
    const turn = 2 * Math.PI * k / 28;
    return along(along(centre, first, radius * Math.cos(turn)), second, radius * Math.sin(turn));
  });
}
