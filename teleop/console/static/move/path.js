// The path of the picture: pan against tilt, one degree as long across as up, with the frame of the lens.
import { html } from "../vendor/preact/preact.min.js";
import { part } from "../store.js";
import { DEFAULT_FOV } from "../attitude.js";
import { doc, plan, selected, valueAt } from "./document.js";

const fovOfRig = part((s) => s.fov ?? null, null), measured = part((s) => [s.axes.pan?.measured ?? null, s.axes.tilt?.measured ?? null], [null, null]);
const MOST = 240; // points of the path

/** @param {{at: number|null}} props */
export function PathView({ at }) {
  const curves = plan.value?.axes, fov = fovOfRig.value ?? DEFAULT_FOV;
  if (!curves || !(curves.pan || curves.tilt) || !doc.value) return html`<section class="card path"><h2>Path</h2></section>`;
  const end = plan.value?.duration ?? 1, aim = (/** @type {number} */ t) => [curves.pan ? valueAt(curves.pan, t) : 0, curves.tilt ? valueAt(curves.tilt, t) : 0];
  const points = Array.from({ length: MOST + 1 }, (_, n) => aim((end * n) / MOST));
  const stops = doc.value.keyframes.map((key) => key.at).map(aim), here = aim(at ?? 0);
  const [left, right] = ends(points.map(([pan]) => pan), fov[0]), [low, high] = ends(points.map(([, tilt]) => tilt), fov[1]);
  /** @type {Map<string, {at: number[], numbers: number[]}>} */
  const marks = new Map();
  stops.forEach((stop, n) => {
    const spot = stop.map((value) => value.toFixed(0)).join();
    marks.set(spot, { at: stop, numbers: [...(marks.get(spot)?.numbers ?? []), n + 1] });
  });
  const unit = Math.max(right - left, high - low) / 100, text = (/** @type {number[]} */ [pan, tilt]) => `${pan.toFixed(2)} ${(-tilt).toFixed(2)}`;
  const frame = (/** @type {number[]} */ [pan, tilt], name = "") => html`<rect class=${name} x=${pan - fov[0] / 2} y=${-tilt - fov[1] / 2} width=${fov[0]} height=${fov[1]} />`;
  const now = measured.value;
  return html`<section class="card path"><h2>Path <span>pan and tilt, frame ${fov[0]}° × ${fov[1]}°</span></h2>
    <svg viewBox=${`${left} ${-high} ${right - left} ${high - low}`} role="img" aria-label="Path of the picture, pan against tilt" style=${{ "--unit": unit }}>
      <path class="axis-lines" d=${`M${left} 0H${right}M0 ${-low}V${-high}`} />
      ${stops.map((stop) => frame(stop, "frame"))}${frame(here, "frame now")}
      <path class="way" d=${`M${points.map(text).join("L")}`} />
      ${stops.map(([pan, tilt], n) => html`<circle class=${selected.value === n + 1 ? "stop selected" : "stop"} cx=${pan} cy=${-tilt} r=${1.6 * unit} />`)}
      ${[...marks.values()].map(({ at: [pan, tilt], numbers }) => html`<text x=${pan + 2.4 * unit} y=${-tilt - 1.6 * unit} font-size=${5 * unit}>${numbers.join(", ")}</text>`)}
      ${now[0] !== null && html`<circle class="measured" cx=${now[0]} cy=${-(now[1] ?? 0)} r=${1.8 * unit} />`}
    </svg></section>`;
}

/** @param {number[]} values @param {number} size @returns {[number, number]} */
const ends = (values, size) => [Math.min(...values) - 0.55 * size, Math.max(...values) + 0.55 * size];
