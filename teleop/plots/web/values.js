// The move, and what is asked of it: numbers as text, values at a time, the range that a scale has to show.
//
// The three scripts become one module of the page, in the order values, marks, plots.

const move = JSON.parse(document.getElementById("move").textContent);
const element = (id) => document.getElementById(id);
const view = { from: 0, to: move.duration || 1, limits: false };

for (const axis of move.axes) axis.shown = true;
const units = [...new Set(move.axes.map((axis) => axis.unit))];
const scaleOf = (unit) => (unit ? "degrees" : "share");

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
function clock(seconds, step = 1) {
  const places = step < 1 ? Math.min(3, Math.ceil(-Math.log10(step))) : 0;
  if (view.to < 120) return `${digits(seconds, places)} s`;
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

// What a scale has to show between two times: the curves in view, limits near them, or all limits when asked.
function extent(quantity, unit) {
  const axes = move.axes.filter((axis) => axis.shown && axis.unit === unit);
  let low = Infinity, high = -Infinity;
  const include = (value) => {
    if (value === null) return;
    low = Math.min(low, value);
    high = Math.max(high, value);
  };
  for (const axis of axes) {
    for (const name of quantity === "position" && axis.samples.measured ? [quantity, "measured"] : [quantity]) {
      include(valueAt(axis, name, view.from));
      include(valueAt(axis, name, view.to));
      const values = axis.samples[name];
      for (let i = indexAt(axis.times, view.from) + 1; i < values.length && axis.times[i] <= view.to; i++) include(values[i]);
    }
    if (quantity !== "position") include(0);
  }
  const near = high - low, bottom = low - near, top = high + near;
  for (const limit of axes.flatMap((axis) => axis.limits[quantity]))
    if (limit !== null && (view.limits || (limit >= bottom && limit <= top))) include(limit);
  return { unit, low, high };
}
// The scales of a plot: [name, range]. But for positions, 0 is at the same height in all of them.
function scales(quantity) {
  const extents = units.map((unit) => extent(quantity, unit));
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
