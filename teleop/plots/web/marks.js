// Limits, cues and keys: what is drawn over the curves, in device pixels.

const CUE = "#ff5f56";

function drawOver(plot, quantity) {
  const { ctx, bbox } = plot, pixel = uPlot.pxRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - 7 * pixel, bbox.top, bbox.width + 14 * pixel, bbox.height); // room for half a diamond
  ctx.clip();
  ctx.lineWidth = pixel;
  ctx.font = `${11 * pixel}px system-ui, sans-serif`;
  drawLimits(plot, quantity, pixel);
  const shown = shownOf(quantity);
  if (quantity === "position") shown.forEach((axis) => drawFrames(plot, axis, pixel));
  const keys = shown.flatMap((axis) => drawKeys(plot, axis, quantity, pixel));
  drawCues(plot, pixel);
  if (quantity === "position") {
    const words = new Words(quantity, ctx, bbox, pixel);
    keys.forEach(({ x, y }) => words.keepOut(x, y, 6 * pixel));
    nameCues(plot, words, pixel);
    const spots = (x, y) => [[0, "center"], [3, "left"], [-3, "right"]].flatMap(([dx, side]) =>
      [-14, 15].map((dy) => [x + dx * pixel, y + dy * pixel, side]));
    keys.forEach(({ x, y, color, text }) => words.put(text, color, spots(x, y)));
  }
  ctx.restore();
}
function line(ctx, x0, y0, x1, y1) {
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.stroke();
}
function drawLimits(plot, quantity, pixel) {
  const { ctx, bbox } = plot;
  ctx.setLineDash([6 * pixel, 5 * pixel]);
  for (const axis of shownOf(quantity))
    for (const limit of limitsShown(axis, quantity)) {
      const y = plot.valToPos(limit, scaleOf(axis.unit), true);
      ctx.strokeStyle = axis.color;
      line(ctx, bbox.left, y, bbox.left + bbox.width, y);
    }
  ctx.setLineDash([]);
}
function drawCues(plot, pixel) {
  const { ctx, bbox } = plot;
  ctx.strokeStyle = CUE;
  for (const { at } of move.cues) {
    const x = plot.valToPos(at, "x", true);
    if (x >= bbox.left - 1 && x <= bbox.left + bbox.width + 1) line(ctx, x, bbox.top, x, bbox.top + bbox.height);
  }
}
// Names of cues at the foot of their lines, those of one time together, in as many rows as it takes.
const ROWS = 4;
function nameCues(plot, words, pixel) {
  const { bbox } = plot, names = new Map();
  for (const { at, name } of move.cues) names.set(at, [...(names.get(at) ?? []), name]);
  for (const [at, of] of names) {
    const x = plot.valToPos(at, "x", true);
    if (x < bbox.left - 1 || x > bbox.left + bbox.width + 1) continue;
    const rows = Array.from({ length: ROWS }, (_, row) => bbox.top + bbox.height - (8 + 13 * row) * pixel);
    words.put(of.join(", "), CUE, [5, 12].flatMap((gap) => rows.flatMap((y) => [[x + gap * pixel, y, "left"], [x - gap * pixel, y, "right"]])));
  }
}
// The frames of a table, which the plan is to meet, as dots.
function drawFrames(plot, axis, pixel) {
  const { ctx, bbox } = plot, [times, positions] = axis.frames ?? [[], []];
  const from = times.findIndex((time) => time >= view.from), inView = times.filter((time) => time >= view.from && time <= view.to).length;
  const step = Math.max(1, Math.ceil(3 * inView * pixel / bbox.width)); // no more than one each three pixels
  ctx.fillStyle = "#f1f3f5";
  for (let i = Math.max(0, from); i < Math.max(0, from) + inView; i += step) {
    ctx.beginPath();
    ctx.arc(plot.valToPos(times[i], "x", true), plot.valToPos(positions[i], scaleOf(axis.unit), true), 1.2 * pixel, 0, 7);
    ctx.fill();
  }
}
// Diamonds on the curve, and a bar while a key holds; returns what was drawn, for the names.
function drawKeys(plot, axis, quantity, pixel) {
  const { ctx, bbox } = plot, main = quantity === "position", size = (main ? 6 : 3.5) * pixel, drawn = [];
  ctx.fillStyle = axis.color;
  for (const key of axis.keys) {
    const x = plot.valToPos(key.at, "x", true), until = plot.valToPos(key.at + key.hold, "x", true);
    if (until < bbox.left || x > bbox.left + bbox.width || x - drawn.at(-1)?.x < size) continue;
    const value = main ? key.position : valueAt(axis, quantity, key.at);
    const y = plot.valToPos(value, scaleOf(axis.unit), true);
    if (main && until > x) ctx.fillRect(x, y - 2.5 * pixel, until - x, 5 * pixel);
    ctx.beginPath();
    [[0, -size], [size, 0], [0, size], [-size, 0]].forEach(([dx, dy]) => ctx.lineTo(x + dx, y + dy));
    ctx.fill();
    drawn.push({ x, y, color: axis.color, text: key.mark });
  }
  return drawn;
}
