// The curves of the axes as the planner has made them, with the keys as diamonds to drag in time and value.
import { html, useEffect, useRef, useSignal } from "../vendor/preact/preact.min.js";
import { axes as rigAxes, part, state } from "../store.js";
import { axis as chosenAxis, doc, edit, plan, planning } from "./document.js";
import { isShare, LINE, padded, ROOM, scaleOf, ticks } from "./scale.js";
import { Diamond } from "./diamond.js";

const playing = part((s) => s.move, null);

/** The axes of the open move, in the rig's order. */
export function axesOfMove() {
  const named = new Set(doc.value?.keyframes.flatMap((key) => Object.keys(key)) ?? []);
  const known = [...rigAxes.value, ...Object.keys(plan.value?.axes ?? {}).filter((name) => !rigAxes.value.includes(name))];
  return known.filter((name) => named.has(name) || plan.value?.axes[name]);
}

/** @param {{at: number|null}} props the scrubber's time */
export function Curves({ at }) {
  const box = useRef(/** @type {HTMLElement|null} */ (null)), size = useSignal({ width: 600, height: 300 });
  const drag = useSignal(/** @type {{axis: string, index: number, at: number, value: number}|null} */ (null));
  useEffect(() => {
    const place = /** @type {HTMLElement} */ (box.current);
    const watch = new ResizeObserver(() => (size.value = { width: place.clientWidth, height: place.clientHeight }));
    watch.observe(place);
    return () => watch.disconnect();
  }, []);
  const now = doc.value;
  const names = axesOfMove(), scale = fitted(size.value, names);
  const drop = () => {
    const moved = drag.value;
    drag.value = null;
    if (moved) edit((keys) => void Object.assign(keys[moved.index], { at: moved.at, [moved.axis]: moved.value }));
  };
  return html`<div class="curves ${planning.value ? "planning" : ""} ${plan.value?.stale ? "stale" : ""}" ref=${box}>
    ${now && html`<svg width=${size.value.width} height=${size.value.height} role="img" aria-label=${`Curves of ${names.join(", ")}; the keys follow as sliders`}>
      <${Grid} scale=${scale} names=${names} />
      <${Limits} scale=${scale} />
      <${Cues} scale=${scale} />
      ${names.map((name) => html`<${Line} name=${name} scale=${scale} />`)}
      <${Ghost} scale=${scale} drag=${drag.value} />
      ${at !== null && html`<path class="scrub" d=${`M${scale.x(at)} ${ROOM.top}V${scale.height - ROOM.bottom}`} />`}
      ${typeof playing.value?.at === "number" && html`<path class="playhead" d=${`M${scale.x(playing.value.at)} ${ROOM.top - 6}V${scale.height - ROOM.bottom}`} />`}
    </svg>
    <div class="diamonds">${names.map((name) => now.keyframes.map((key, index) => typeof key[name] === "number" && html`<${Diamond}
      key=${`${name}${index}`} name=${name} index=${index} keyframe=${key} scale=${scale} drag=${drag} drop=${drop} box=${box} />`))}</div>`}
  </div>`;
}

/** A scale with the whole move in view. @param {{width: number, height: number}} size @param {string[]} names */
function fitted({ width, height }, names) {
  const keys = doc.value?.keyframes ?? [], curves = plan.value?.axes ?? {};
  const degrees = names.filter((name) => !isShare(name));
  const values = degrees.flatMap((name) => [...keys.map((key) => key[name]).filter((value) => typeof value === "number"), ...(curves[name]?.position ?? [])]);
  const last = keys.at(-1), end = Math.max(plan.value?.duration ?? 0, last ? last.at + (last.hold ?? 0) : 1, 1);
  return scaleOf(width, height, end, padded(values));
}

/** @param {{scale: import("./scale.js").Scale, names: string[]}} props */
function Grid({ scale, names }) {
  const bottom = scale.height - ROOM.bottom, right = scale.width - ROOM.right;
  const times = ticks(0, scale.span, Math.max(scale.width / (1.8 * LINE), 2)), degrees = ticks(scale.low, scale.high, Math.max(scale.height / LINE, 2));
  return html`<g class="grid">
    ${times.map((t) => html`<path d=${`M${scale.x(t)} ${ROOM.top}V${bottom}`} /><text x=${scale.x(t)} y=${bottom + 0.7 * ROOM.bottom} text-anchor="middle">${t} s</text>`)}
    ${names.some((name) => !isShare(name)) && degrees.map((v) => html`<path d=${`M${ROOM.left} ${scale.y("pan", v)}H${right}`} /><text x=${ROOM.left - 6} y=${scale.y("pan", v) + 4} text-anchor="end">${v}°</text>`)}
    ${names.includes("focus") && [0, 0.5, 1].map((v) => html`<text class="focus-tick" x=${right + 6} y=${scale.y("focus", v) + 4}>${v}</text>`)}
  </g>`;
}

/** The soft limits of the chosen axis, where they are in view. @param {{scale: import("./scale.js").Scale}} props */
function Limits({ scale }) {
  const name = chosenAxis.value, axis = state.peek()?.axes[name], ends = plan.value?.axes[name]?.limits ?? [axis?.minimum, axis?.maximum];
  return html`<g class=${`limits stroke-${name}`}>${ends.filter((end) => typeof end === "number" && end >= scale.valueRange(name)[0] && end <= scale.valueRange(name)[1])
    .map((end) => html`<path d=${`M${ROOM.left} ${scale.y(name, Number(end))}H${scale.width - ROOM.right}`} /><text x=${scale.width - ROOM.right - 4} y=${scale.y(name, Number(end)) - 4} text-anchor="end">limit of ${name}</text>`)}</g>`;
}

/** @param {{scale: import("./scale.js").Scale}} props */
const Cues = ({ scale }) => html`<g class="cues">${(plan.value?.cues ?? []).map((cue) => html`<path d=${`M${scale.x(cue.at)} ${ROOM.top}V${scale.height - ROOM.bottom}`} />
  <text x=${scale.x(cue.at) + (scale.x(cue.at) > scale.width / 2 ? -4 : 4)} y=${ROOM.top + 0.7 * ROOM.top} text-anchor=${scale.x(cue.at) > scale.width / 2 ? "end" : "start"}>${cue.name}</text>`)}</g>`;

/** The planned curve, and in red where the rig cannot do it: there, from key to key. @param {{name: string, scale: import("./scale.js").Scale}} props */
function Line({ name, scale }) {
  const curve = plan.value?.axes[name], keys = doc.value?.keyframes ?? [];
  const bad = (plan.value?.problems ?? []).filter((problem) => problem.axis === name);
  const d = curve ? `M${curve.times.map((t, n) => `${scale.x(t).toFixed(1)} ${scale.y(name, curve.position[n]).toFixed(1)}`).join("L")}` : "";
  return html`<g class=${`line stroke-${name} ${chosenAxis.value === name ? "chosen" : ""}`}>
    ${curve && html`<path d=${d} />`}
    ${bad.map(({ first, last }) => first !== null && last !== null && html`<path class="infeasible" d=${straight(keys.slice(first - 1, last), name, scale)} />`)}</g>`;
}

/** @param {import("./document.js").Keyframe[]} keys @param {string} name @param {import("./scale.js").Scale} scale */
function straight(keys, name, scale) {
  const spots = keys.filter((key) => typeof key[name] === "number").map((key) => `${scale.x(key.at)} ${scale.y(name, key[name])}`);
  return spots.length ? `M${spots.join("L")}` : "";
}

/** While a key is dragged: straight lines to its neighbors, over the curve that is still the old one. @param {{scale: import("./scale.js").Scale, drag: any}} props */
function Ghost({ scale, drag }) {
  const keys = doc.value?.keyframes ?? [];
  if (!drag) return null;
  /** @type {import("./document.js").Keyframe[]} */
  const moved = keys.map((key, index) => (index === drag.index ? { ...key, at: drag.at, [drag.axis]: drag.value } : key));
  const having = moved.filter((key) => typeof key[drag.axis] === "number"), at = having.findIndex((key) => key === moved[drag.index]);
  const x = scale.x(drag.at), y = scale.y(drag.axis, drag.value), left = x > scale.width / 2;
  return html`<g class=${`ghost stroke-${drag.axis}`}><path d=${straight(having.slice(Math.max(at - 1, 0), at + 2), drag.axis, scale)} />
    <text x=${x + (left ? -14 : 14)} y=${Math.max(y - 12, ROOM.top + 10)} text-anchor=${left ? "end" : "start"}>${drag.at.toFixed(2)} s, ${drag.value.toFixed(isShare(drag.axis) ? 3 : 1)}${isShare(drag.axis) ? "" : "°"}</text></g>`;
}

