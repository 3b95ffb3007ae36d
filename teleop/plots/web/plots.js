// Four plots over one time: one zoom for all, one cursor, and the values at it.
//
// The vertical scales are set here and not left to uPlot, because it looks only at the samples in view: zoomed into a
// rest, which is two points far away, it would find none and draw nothing.

const MUTED = "#8b929c";
const LEAST_VIEW = 1e-3; // s
const TIMES = [1, 2, 5].flatMap((n) => [n / 1000, n / 100, n / 10])
  .concat([1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400, 172800, 604800])
  .sort((a, b) => a - b); // s between ticks

const FRAMES = [1, 2, 5, 10, 20, 24, 25, 30, 48, 50, 60, 100, 120, 200, 240, 250, 500, 1000, 2000, 5000, 10000];

const WIDTHS = { left: 56, right: 50 }; // px of the vertical axes, the same in each plot so that times line up

// A card: heading, values, plot.
function card({ name, per }) {
  const section = document.createElement("section"), heading = document.createElement("div");
  section.dataset.quantity = name;
  heading.className = "heading";
  heading.innerHTML = "<h2></h2>";
  const units = unitsOf(name), words = units.map((unit) => {
    const names = axesOf(name).filter((axis) => axis.unit === unit).map((axis) => axis.name).join(", ");
    return unit || per ? `${unit || "1"}${per}` + (units.length > 1 ? ` (${names})` : "") : "";
  });
  heading.firstChild.textContent = [name[0].toUpperCase() + name.slice(1), ...words.filter(Boolean)].join("  ·  ");
  const values = axesOf(name).map((axis) => {
    const value = document.createElement("div");
    value.className = "value";
    value.style.setProperty("--color", axis.color);
    value.innerHTML = "<i></i> <b></b> <span></span>";
    value.children[0].textContent = axis.name;
    heading.append(value);
    return value;
  });
  section.append(heading);
  element("plots").append(section);
  return { section, values };
}

function axisX() {
  return {
    stroke: MUTED, grid: { stroke: "#22262c", width: 1 }, ticks: { show: false }, font: "11px system-ui", size: move.shoot ? 40 : 26, gap: 4,
    incrs: move.shoot ? FRAMES : TIMES, space: 80, values: (_, ticks, __, ___, step) => ticks.map((time) => atTick(time, step)),
  };
}
function axisY(name, unit, side) {
  const suffix = name === "position" ? unit : "";
  const some = () => shownOf(name).some((axis) => axis.unit === unit);
  return {
    scale: scaleOf(unit), side: side ? 1 : 3, stroke: MUTED, ticks: { show: false }, font: "11px system-ui", gap: 4, space: 22,
    grid: { show: side === 0, stroke: "#22262c", width: 1 }, size: side ? WIDTHS.right : WIDTHS.left,
    values: (_, ticks) => ticks.map((value) => (some() ? tick(value) + suffix : "")),
  };
}

function series(axis, dotted) {
  const look = dotted ? { stroke: "#f1f3f5", width: 1, dash: [2, 3] } : { stroke: axis.color, width: 2 };
  return { ...look, scale: scaleOf(axis.unit), pxAlign: 0, spanGaps: true, points: { show: false } };
}

const { times, picks } = merged();
let dragged = null; // the plot in which the mouse is: the others follow it, and must not zoom a second time
const plots = [];
for (const quantity of move.quantities) {
  const { name } = quantity, { section, values } = card(quantity), axes = axesOf(name), units = unitsOf(name);
  const column = (row) => axes.map((axis) =>
    picks[move.axes.indexOf(axis)].map((i) => (i < 0 ? null : axis.samples[row]?.[i] ?? null)));
  const measured = name === "position" && axes.some((axis) => axis.samples.measured); // drawn dotted, over the plan
  const samples = [...column(name), ...(measured ? column("measured") : [])];
  const plot = new uPlot({
    ...size(name, section),
    legend: { show: false },
    padding: [8, units.length > 1 ? 0 : 20, 0, 0],
    scales: {
      x: { time: false, range: () => [view.from, view.to] },
      ...Object.fromEntries(scales(name).map(([scale, range]) => [scale, { auto: false, ...range }])),
    },
    series: [{}, ...samples.map((_, k) => series(axes[k % axes.length], k >= axes.length))],
    axes: [axisX(), ...units.map((unit, side) => axisY(name, unit, side))],
    cursor: {
      sync: { key: "move", scales: ["x", null] }, y: false, points: { show: false },
      drag: { x: true, y: false, setScale: false, dist: 4 }, bind: { dblclick: () => () => zoom(0, Infinity) },
    },
    hooks: {
      draw: [(u) => drawOver(u, name)],
      setCursor: [(u) => read(u, name)],
      setSelect: [selected],
    },
  }, [times, ...samples], section);
  const dots = axes.map((axis) => {
    const dot = document.createElement("div");
    dot.className = "dot";
    dot.style.background = axis.color;
    dot.hidden = true;
    plot.over.append(dot);
    return dot;
  });
  plot.over.addEventListener("mousedown", () => { dragged = plot; });
  touch(plot.over);
  plots.push({ name, plot, section, values, dots, axes });
}

// Sizes: four plots fill the window where it is high enough.
function size(name, section) {
  const room = Math.max(560, window.innerHeight - element("plots").offsetTop - 200);
  return { width: section.clientWidth, height: Math.round(room * (name === "position" ? 0.37 : 0.21)) };
}

// Zoom, axes, limits.
function selected(u) {
  const { left, width } = u.select;
  if (width === 0) return;
  u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  if (u === dragged) zoom(u.posToVal(left, "x"), u.posToVal(left + width, "x"));
}
function zoom(from, to) {
  const whole = move.duration || 1;
  if (to - from < LEAST_VIEW) return;
  view.from = Math.max(0, from);
  view.to = Math.min(whole, to);
  element("whole").disabled = view.from === 0 && view.to === whole;
  fit();
}
function fit() {
  remember();
  for (const { name, plot, axes } of plots)
    plot.batch(() => {
      plot.series.slice(1).forEach((each, k) => {
        const { shown } = axes[k % axes.length];
        if (each.show !== shown) plot.setSeries(k + 1, { show: shown });
      });
      plot.setScale("x", { min: view.from, max: view.to });
      for (const [scale, range] of scales(name)) plot.setScale(scale, range);
    });
  for (const { name, plot } of plots) read(plot, name);
}

// Values: at the cursor, or while there is none the peaks.
function read(u, name) {
  const { plot, values, dots, axes } = plots.find((each) => each.plot === u) ?? {};
  if (!plot) return; // uPlot's own first call, before there is a card to fill
  const at = plot.cursor.left >= 0 ? plot.posToVal(plot.cursor.left, "x") : null;
  axes.forEach((axis, k) => {
    const value = at === null ? null : valueAt(axis, name, at);
    values[k].hidden = !axis.shown;
    values[k].children[1].textContent = value === null
      ? (at === null ? axis.peaks[name].map((peak) => number(peak, axis.unit)).join(" … ") : "") : number(value, axis.unit);
    const limit = axis.limits[name].map((each) => (each === null ? "∞" : minus(each)));
    values[k].children[2].textContent = limit.length ? `/ ${name === "position" ? limit.join(" … ") : limit[1]}` : "";
    dots[k].hidden = value === null || !axis.shown;
    if (value !== null) dots[k].style.transform = `translate(${plot.cursor.left}px, ${plot.valToPos(value, scaleOf(axis.unit))}px)`;
  });
  element("now").textContent = at === null ? `peaks of ${span()}` : [stamp(at, 0.001), keyAt(plot, at)].filter(Boolean).join(" · ");
  if (view.at !== at) {
    view.at = at;
    drawPath();
  }
}
function span() {
  if (move.shoot) return `${move.duration + 1} frames`;
  return clock(move.duration, move.duration % 1 ? 0.01 : 1);
}
function keyAt(plot, at) {
  const reach = 6 * (view.to - view.from) / plot.over.clientWidth;
  const keys = move.axes.filter((axis) => axis.shown).flatMap((axis) => axis.keys);
  return keys.find((key) => at > key.at - reach && at < key.at + key.hold + reach)?.name;
}

// A finger across a plot is a mouse to uPlot; up and down still scrolls the page.
function touch(over) {
  const kinds = { pointerdown: "mousedown", pointermove: "mousemove", pointerup: "mouseup", pointercancel: "mouseup" };
  for (const [from, to] of Object.entries(kinds))
    over.addEventListener(from, (event) => {
      if (event.pointerType !== "touch") return;
      const { clientX, clientY } = event;
      if (to === "mousedown") over.dispatchEvent(new MouseEvent("mouseenter", { clientX, clientY }));
      over.dispatchEvent(new MouseEvent(to, { clientX, clientY, bubbles: true, movementX: 1 }));
    });
}

recall();
for (const axis of move.axes) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = axis.name;
  button.style.setProperty("--color", axis.color);
  button.ariaPressed = String(axis.shown);
  button.addEventListener("click", () => {
    axis.shown = !axis.shown;
    button.ariaPressed = String(axis.shown);
    fit();
  });
  element("axes").append(button);
}
element("limits").ariaPressed = String(view.limits);
element("limits").addEventListener("click", (event) => {
  view.limits = !view.limits;
  event.currentTarget.ariaPressed = String(view.limits);
  fit();
});
element("whole").addEventListener("click", () => zoom(0, Infinity));
addEventListener("keydown", (event) => event.key === "Escape" && zoom(0, Infinity));
addEventListener("resize", () => {
  for (const { name, plot, section } of plots) plot.setSize(size(name, section));
  drawPath();
});

element("whole").disabled = view.from === 0 && view.to === (move.duration || 1);
element("title").textContent = move.title;
const keyframes = new Set(move.axes.flatMap((axis) => axis.keys.map((key) => key.name))).size;
element("facts").textContent = move.facts ?? `${span()} on ${move.rig}, ${keyframes} keyframe${keyframes === 1 ? "" : "s"}`;
const list = (id, texts) => texts.forEach((text) => {
  const item = document.createElement("li");
  item.textContent = text;
  element(id).append(item);
});
list("warnings", move.warnings);
list("notes", move.notes ?? []);
if (move.fov) makePath();
fit();
drawPath();
