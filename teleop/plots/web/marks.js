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
  drawCues(plot, quantity, pixel);
  const keys = move.axes.filter((axis) => axis.shown).flatMap((axis) => drawKeys(plot, axis, quantity, pixel));
  if (quantity === "position") drawNames(plot, keys, pixel);
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
  for (const axis of move.axes.filter((each) => each.shown))
    for (const limit of axis.limits[quantity]) {
      if (limit === null) continue;
      const y = plot.valToPos(limit, scaleOf(axis.unit), true);
      ctx.strokeStyle = axis.color;
      line(ctx, bbox.left, y, bbox.left + bbox.width, y);
    }
  ctx.setLineDash([]);
}
function drawCues(plot, quantity, pixel) {
  const { ctx, bbox } = plot;
  ctx.strokeStyle = ctx.fillStyle = CUE;
  for (const cue of move.cues) {
    const x = plot.valToPos(cue.at, "x", true);
    if (x < bbox.left - 1 || x > bbox.left + bbox.width + 1) continue;
    line(ctx, x, bbox.top, x, bbox.top + bbox.height);
    if (quantity !== "position") continue;
    const flip = x + 80 * pixel > bbox.left + bbox.width;
    ctx.textAlign = flip ? "right" : "left";
    ctx.fillText(cue.name, x + (flip ? -5 : 5) * pixel, bbox.top + bbox.height - 6 * pixel);
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
// Each key's name above it or below it, where it hides no other name and no diamond.
function drawNames(plot, keys, pixel) {
  const { ctx, bbox } = plot, high = 12 * pixel;
  const taken = keys.map(({ x, y }) => [x, y, 6 * pixel]);
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  for (const { x, y, color, text } of keys) {
    const half = ctx.measureText(text).width / 2 + pixel;
    const center = Math.min(Math.max(x, bbox.left + half), bbox.left + bbox.width - half);
    const free = (middle) => middle > bbox.top + high / 2 && middle < bbox.top + bbox.height - high / 2 &&
      !taken.some(([cx, cy, wide]) => Math.abs(cx - center) < half + wide && Math.abs(cy - middle) < high);
    const middle = [y - 13 * pixel, y + 14 * pixel].find(free);
    if (middle === undefined) continue;
    taken.push([center, middle, half]);
    ctx.fillStyle = color;
    ctx.fillText(text, center, middle);
  }
}
