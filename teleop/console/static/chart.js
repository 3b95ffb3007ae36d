// The strip chart: the last 20 s of each axis, measured as a line, commanded as a faint one. Its buffers never grow.
import { html, useEffect, useRef } from "./vendor/preact/preact.min.js";
import { onLost, onState } from "./connection.js";
import { axes, state } from "./store.js";

const SPAN = 20; // s
const MOST = 640; // points: 20 s at 30 Hz, and some
const REDRAW = 66; // ms
const INK = { pan: "#4cc9f0", tilt: "#ffa23e", roll: "#94d82d", focus: "#c77dff" };
const MUTED = "#9aa1ab", GRID = "#23272d";

/** @type {number[]} */
let times = [];
/** @type {Object<string, {measured: (number|null)[], commanded: (number|null)[]}>} */
let rows = {};

function clear() {
  times = [];
  rows = {};
}

/** @param {import("./types.js").State} s */
function add(s) {
  if (times.length && s.time < times[times.length - 1]) clear(); // another run
  times.push(s.time);
  for (const axis of axes.peek()) {
    const row = (rows[axis] ??= { measured: Array(times.length - 1).fill(null), commanded: Array(times.length - 1).fill(null) });
    row.measured.push(s.axes[axis]?.measured ?? null);
    row.commanded.push(s.axes[axis]?.commanded ?? null);
  }
  const first = times.findIndex((time) => time >= s.time - SPAN - 0.5), drop = Math.max(first, times.length - MOST);
  if (drop > 0) for (const list of [times, ...Object.values(rows).flatMap((row) => [row.measured, row.commanded])]) list.splice(0, drop);
}
onState(add);
onLost(clear);

/** @param {string[]} names @param {number} width @param {number} height */
function options(names, width, height) {
  const rem = parseFloat(getComputedStyle(document.documentElement).fontSize), letter = Math.round(0.75 * rem);
  const axis = { stroke: MUTED, grid: { stroke: GRID, width: 1 }, ticks: { show: false }, font: `${letter}px system-ui, sans-serif` };
  const ink = (/** @type {string} */ name) => INK[/** @type {"pan"} */ (name)] ?? "#e9ecef";
  const scale = (/** @type {string} */ name) => (state.peek()?.axes[name]?.unit === "deg" ? "y" : "share");
  return {
    width, height, padding: [0.7 * letter, 1.4 * letter, 0, 0], legend: { show: false }, cursor: { show: false }, select: { show: false },
    scales: { x: { time: false, range: () => [-SPAN, 0] }, y: { range: around }, share: { range: [-0.05, 1.05] } },
    axes: [
      { ...axis, size: 2.2 * letter, space: 5 * letter, values: (/** @type {any} */ _, /** @type {number[]} */ ticks) => ticks.map((t) => (t ? `${t} s` : "now")) },
      { ...axis, size: 3.8 * letter, space: 3 * letter, scale: "y", values: (/** @type {any} */ _, /** @type {number[]} */ ticks) => ticks.map((t) => `${t}°`) },
    ],
    series: [{}, ...names.flatMap((name) => [
      { scale: scale(name), stroke: ink(name), width: 1, alpha: 0.45, dash: [4, 4], points: { show: false } },
      { scale: scale(name), stroke: ink(name), width: 2, points: { show: false } },
    ])],
  };
}

/** At least ten degrees in view, so that noise looks like noise. @param {any} _ @param {number|null} low @param {number|null} high @returns {[number, number]} */
function around(_, low, high) {
  const a = low ?? 0, b = high ?? 0, room = Math.max(0.1 * (b - a), (10 - (b - a)) / 2);
  return [a - room, b + room];
}

/** Of the axes that the plot was made for: the rig's may be others already. @param {string[]} names */
function data(names) {
  const now = times[times.length - 1] ?? 0;
  return [times.map((time) => time - now), ...names.flatMap((axis) => [rows[axis]?.commanded ?? [], rows[axis]?.measured ?? []])];
}

export function StripChart() {
  const place = useRef(/** @type {HTMLElement|null} */ (null)), names = axes.value.join();
  useEffect(() => {
    const shown = axes.peek(), box = /** @type {HTMLElement} */ (place.current);
    const size = () => ({ width: Math.max(box.clientWidth, 120), height: Math.max(box.clientHeight, 90) });
    const first = size(), plot = new uPlot(options(shown, first.width, first.height), data(shown), box);
    const watch = new ResizeObserver(() => plot.setSize(size()));
    watch.observe(box);
    const timer = setInterval(() => !document.hidden && plot.setData(data(shown)), REDRAW);
    return () => (clearInterval(timer), watch.disconnect(), plot.destroy());
  }, [names]);
  return html`<section class="card chart"><h2>Last ${SPAN} s</h2><div class="plot" ref=${place} role="img" aria-label="Positions of the last 20 s"></div></section>`;
}
