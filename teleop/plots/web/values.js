// The move, and what is asked of it: numbers as text, values at a time, the range that a scale has to show.
//
// The scripts become one module of the page, in the order values, labels, marks, path, plots, watch.

const move = JSON.parse(document.getElementById("move").textContent);
const element = (id) => document.getElementById(id);
const view = { from: 0, to: move.duration || 1, limits: false, at: null };

for (const axis of move.axes) axis.shown = true;
const scaleOf = (unit) => ({ "°": "degrees", s: "seconds" })[unit] ?? "share";
const axesOf = (quantity) => move.axes.filter((axis) => axis.samples[quantity]);
const unitsOf = (quantity) => [...new Set(axesOf(quantity).map((axis) => axis.unit))];
const shownOf = (quantity) => axesOf(quantity).filter((axis) => axis.shown);

// Numbers and times as people read them.
function digits(value, places) {
  const text = value.toFixed(places);
  return minus(Number(text) === 0 ? text.replace("-", "") : text);
}
function number(value, unit) {
  const places = unit ? 2 : 3, small = Math.abs(value) < 5 * 10 ** -places;
  return small && Math.abs(value) > 1e-9 ? minus(value.toPrecision(2)) : digits(value, places); // a slow drift is not 0
}
function tick(value) {
  return minus(value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(0) : value);
}
function minus(value) {
  return String(value).replaceAll("-", "−");
}
function stamp(x, step) { // at the cursor: a time, or a frame of a timelapse and when it is shot
  return move.shoot ? `frame ${Math.round(x)} · ${wall(x)} into the shoot` : clock(x, step);
}
function atTick(x, step) {
  if (!move.shoot) return clock(x, step);
  return Number.isInteger(x) ? `${x}\n${wall(x)}` : "";
}
function wall(frame) {
  const { first, change } = move.shoot, seconds = frame * first + change * frame * (frame - 1) / 2;
  return spell(Math.max(0, seconds), 1, true);
}
function clock(seconds, step = 1) {
  return spell(seconds, step, view.to >= 120);
}
function spell(seconds, step, long) {
  const places = step < 1 ? Math.min(3, Math.ceil(-Math.log10(step))) : 0;
  if (!long) return `${digits(seconds, places)} s`;
  const whole = Math.floor(seconds + 1e-9);
  const parts = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const text = parts.map((part, i) => (i ? String(part).padStart(2, "0") : part)).join(":");
  return text.replace(/^0:/, "") + (places ? (seconds % 1).toFixed(places).slice(1) : "");
}

// The last sample at or before a time, and what the curve is there.
function indexAt(times, time) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle; else high = middle - 1;
  }
  return low;
}
function valueAt(axis, quantity, time) {
  const i = indexAt(axis.times, time), values = axis.samples[quantity];
  const span = axis.times[i + 1] - axis.times[i];
  if (values[i] === null || (span > 0 && values[i + 1] === null)) return null; // nothing was measured then
  return span > 0 ? values[i] + (values[i + 1] - values[i]) * (time - axis.times[i]) / span : values[i];
}

// What a curve is at most and at least between two times.
function reach(axis, quantity) {
  const values = axis.samples[quantity];
  let low = Infinity, high = -Infinity;
  const include = (value) => {
    if (value === null) return;
    low = Math.min(low, value);
    high = Math.max(high, value);
  };
  for (const name of quantity === "position" && axis.samples.measured ? [quantity, "measured"] : [quantity]) {
    include(valueAt(axis, name, view.from));
    include(valueAt(axis, name, view.to));
    const row = axis.samples[name];
    for (let i = indexAt(axis.times, view.from) + 1; i < values.length && axis.times[i] <= view.to; i++) include(row[i]);
  }
  return { low, high };
}
// The limits of an axis that are drawn: all when asked, else those that its own curve comes near.
const NEAR = 0.5; // of what the curve spans
function limitsShown(axis, quantity) {
  const limits = axis.limits[quantity].filter((limit) => limit !== null);
  if (view.limits) return limits;
  const { low, high } = reach(axis, quantity), zero = quantity === "position" ? [] : [0];
  const span = NEAR * (Math.max(high, ...zero) - Math.min(low, ...zero));
  return limits.filter((limit) => limit - high <= span && low - limit <= span && span > 0);
}

// uPlot wants one column of times. Each axis has its own, twice the same where its jerk steps: merge them.
function merged() {
  const times = [], picks = move.axes.map(() => []), heads = move.axes.map(() => 0);
  for (;;) {
    const time = Math.min(...move.axes.map((axis, k) => axis.times[heads[k]] ?? Infinity));
    if (time === Infinity) return { times, picks };
    times.push(time);
    move.axes.forEach((axis, k) => picks[k].push(axis.times[heads[k]] === time ? heads[k]++ : -1));
  }
}

// What a scale has to show between two times: the curves in view, and the limits that are drawn.
function extent(quantity, unit) {
  let low = Infinity, high = -Infinity;
  for (const axis of shownOf(quantity).filter((each) => each.unit === unit)) {
    const curve = reach(axis, quantity), values = [curve.low, curve.high, ...limitsShown(axis, quantity)];
    if (quantity !== "position") values.push(0);
    low = Math.min(low, ...values);
    high = Math.max(high, ...values);
  }
  return { unit, low, high };
}
// The scales of a plot: [name, range]. But for positions, 0 is at the same height in all of them.
function scales(quantity) {
  const extents = unitsOf(quantity).map((unit) => extent(quantity, unit));
  const mixed = extents.some(({ low }) => low < 0) && extents.some(({ high }) => high > 0);
  return extents.map(({ unit, low, high }) => {
    if (low > high) return [scaleOf(unit), { min: -1, max: 1 }]; // no axis of this unit is shown
    if (mixed && extents.length > 1 && quantity !== "position") {
      high = Math.max(-low, high);
      low = -high;
    }
    const margin = 0.1 * (high - low) || (unit ? 1 : 0.1);
    return [scaleOf(unit), { min: low - margin, max: high + margin }];
  });
}
