// The camera's attitude as SVG: a body with a lens, seen from behind and above, and the frame that the lens sees.
import { html } from "./vendor/preact/preact.min.js";

/** @typedef {[number, number, number]} Point right, forward, up */
const BODY = { wide: 1, deep: 0.7, high: 0.72 }, LENS = { radius: 0.3, length: 0.45 };
const ELEVATION = 24, TURN = -28; // deg from which the viewer looks
const FOV = [54, 38]; // deg across and up: 35 mm on a full frame, where the rig names no lens
const REACH = 1.55; // how far ahead of the camera its frame is drawn
const rad = (/** @type {number} */ deg) => (deg * Math.PI) / 180;

/** @param {Point} p @param {number} deg @param {number} a @param {number} b @returns {Point} */
function turned(p, deg, a, b) {
  const c = Math.cos(rad(deg)), s = Math.sin(rad(deg)), q = /** @type {Point} */ ([...p]);
  q[a] = p[a] * c - p[b] * s;
  q[b] = p[a] * s + p[b] * c;
  return q;
}

/** From the camera's own coordinates to the world's. @param {number} pan @param {number} tilt @param {number} roll @returns {(p: Point) => Point} */
const camera = (pan, tilt, roll) => (p) => turned(turned(turned(p, -roll, 0, 2), tilt, 1, 2), -pan, 0, 1);
/** From the world to the picture, with the depth. @param {Point} p @returns {Point} */
function seen(p) {
  const [x, y, z] = turned(turned(p, TURN, 0, 1), -ELEVATION, 1, 2), k = 6 / (6 + y);
  return [x * k, -z * k, y];
}

/** @param {(p: Point) => Point} place @param {Point[]} points */
function face(place, points) {
  const spots = points.map((point) => seen(place(point)));
  const area = spots.reduce((sum, [x, y], n) => sum + x * spots[(n + 1) % spots.length][1] - spots[(n + 1) % spots.length][0] * y, 0);
  return { d: `M${spots.map(([x, y]) => `${x.toFixed(3)} ${y.toFixed(3)}`).join("L")}Z`, depth: spots.reduce((sum, spot) => sum + spot[2], 0) / spots.length, front: area > 0 };
}

/** @returns {{name: string, points: Point[]}[]} the faces of a box, each seen from outside in one sense */
function box(/** @type {number} */ w, /** @type {number} */ d, /** @type {number} */ h) {
  /** @type {(sx: number, sy: number, sz: number) => Point} */
  const at = (sx, sy, sz) => [sx * w / 2, sy * d / 2, sz * h / 2];
  return [
    { name: "back", points: [at(-1, -1, 1), at(1, -1, 1), at(1, -1, -1), at(-1, -1, -1)] },
    { name: "front", points: [at(1, 1, 1), at(-1, 1, 1), at(-1, 1, -1), at(1, 1, -1)] },
    { name: "side", points: [at(1, -1, 1), at(1, 1, 1), at(1, 1, -1), at(1, -1, -1)] },
    { name: "side", points: [at(-1, 1, 1), at(-1, -1, 1), at(-1, -1, -1), at(-1, 1, -1)] },
    { name: "top", points: [at(-1, 1, 1), at(1, 1, 1), at(1, -1, 1), at(-1, -1, 1)] },
    { name: "bottom", points: [at(-1, -1, -1), at(1, -1, -1), at(1, 1, -1), at(-1, 1, -1)] },
  ];
}

const BOX = box(BODY.wide, BODY.deep, BODY.high);
const RING = Array.from({ length: 20 }, (_, n) => [Math.cos((n * Math.PI) / 10), Math.sin((n * Math.PI) / 10)]);

/** @param {(p: Point) => Point} place */
function shapes(place) {
  const faces = BOX.map(({ name, points }) => ({ name, ...face(place, points) }));
  const near = BODY.deep / 2, far = near + LENS.length;
  const tube = RING.map(([c, s], n) => {
    const [c2, s2] = RING[(n + 1) % RING.length];
    /** @type {Point[]} */
    const points = [[c * LENS.radius, near, s * LENS.radius], [c * LENS.radius, far, s * LENS.radius], [c2 * LENS.radius, far, s2 * LENS.radius], [c2 * LENS.radius, near, s2 * LENS.radius]];
    return { name: "tube", ...face(place, points) };
  });
  const glass = { name: "glass", ...face(place, RING.map(([c, s]) => /** @type {Point} */ ([-c * LENS.radius, far, s * LENS.radius]))) };
  return [...faces, ...tube, glass].filter((shape) => shape.front).sort((a, b) => b.depth - a.depth);
}

/** @param {(p: Point) => Point} place @param {number[]} fov */
function frustum(place, [across, up]) {
  const w = Math.tan(rad(across / 2)) * REACH, h = Math.tan(rad(up / 2)) * REACH, eye = seen(place([0, BODY.deep / 2 + LENS.length, 0]));
  const corners = [[-w, h], [w, h], [w, -h], [-w, -h]].map(([x, z]) => seen(place([x, REACH, z])));
  const text = (/** @type {Point} */ p) => `${p[0].toFixed(3)} ${p[1].toFixed(3)}`;
  return { frame: `M${corners.map(text).join("L")}Z`, rays: corners.map((corner) => `M${text(eye)}L${text(corner)}`).join("") };
}

/**
 * A camera that looks at these angles. With `fov` the frame of the lens is drawn too.
 * @param {{pan?: number, tilt?: number, roll?: number, fov?: number[]|null, label: string}} props
 */
export function Attitude({ pan = 0, tilt = 0, roll = 0, fov = null, label }) {
  const place = camera(pan, tilt, roll), view = fov ? frustum(place, fov) : null;
  return html`<svg class="attitude" viewBox=${fov ? "-1.72 -1.3 3.44 2.5" : "-0.95 -0.85 1.9 1.6"} ...${label ? { role: "img", "aria-label": label } : { "aria-hidden": "true" }}>
    ${fov && html`<g class="ground"><${Ground} /></g>`}
    ${view && html`<path class="rays" d=${view.rays} /><path class="frame" d=${view.frame} />`}
    ${shapes(place).map((shape) => html`<path class=${shape.name} d=${shape.d} />`)}
  </svg>`;
}

/** A circle below the camera with a mark at each 30 degrees: which way is forward. */
function Ground() {
  const spot = (/** @type {number} */ deg, /** @type {number} */ r) => seen([r * Math.sin(rad(deg)), r * Math.cos(rad(deg)), -0.75]);
  const marks = Array.from({ length: 12 }, (_, n) => [spot(30 * n, n ? 1.3 : 1.05), spot(30 * n, 1.45)]);
  const ring = Array.from({ length: 49 }, (_, n) => spot(7.5 * n, 1.45));
  const text = (/** @type {Point} */ p) => `${p[0].toFixed(3)} ${p[1].toFixed(3)}`;
  return html`<path d=${`M${ring.map(text).join("L")}`} /><path d=${marks.map(([a, b]) => `M${text(a)}L${text(b)}`).join("")} />`;
}

export const DEFAULT_FOV = FOV;
