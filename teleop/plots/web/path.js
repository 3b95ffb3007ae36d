// The path of the picture: pan against tilt, one degree as long across as up, with the frame of a lens on it.

const PATH = "#f1f3f5", FRAME = "#4cc9f0";
const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 180, 360, 720, 3600]; // deg between two lines
const ROOM = { left: 44, right: 12, top: 8, bottom: 22 }; // px around the path
const pathAxes = ["pan", "tilt"].map((name) => move.axes.find((axis) => axis.name === name));
let paper = null;

function aimAt(time) {
  return pathAxes.map((axis) => (axis ? valueAt(axis, "position", time) ?? 0 : 0));
}
function makePath() {
  const section = document.createElement("figure");
  section.dataset.quantity = "path";
  section.innerHTML = '<div class="heading"><h2></h2></div><canvas></canvas>';
  const [wide, high] = move.fov, lens = `${digits(wide, 0)}° × ${digits(high, 0)}°`;
  section.querySelector("h2").textContent = `Path  ·  pan and tilt, frame of ${lens}${move.tiles ? `, ${move.tiles.length} pictures` : ""}`;
  element("plots").append(section);
  const times = [...new Set(pathAxes.flatMap((axis) => axis?.times ?? []))].sort((a, b) => a - b);
  paper = { section, canvas: section.querySelector("canvas"), points: times.map(aimAt) };
}
// Where on the canvas an angle is: the whole path and its frames in view.
function projection(width, height) {
  const [wide, high] = move.fov, spots = [...paper.points, ...(move.tiles ?? [])];
  const ends = [0, 1].map((k) => [Math.min(...spots.map((spot) => spot[k])), Math.max(...spots.map((spot) => spot[k]))]);
  const left = ends[0][0] - 0.55 * wide, right = ends[0][1] + 0.55 * wide, low = ends[1][0] - 0.55 * high, top = ends[1][1] + 0.55 * high;
  const scale = Math.min((width - ROOM.left - ROOM.right) / (right - left), (height - ROOM.top - ROOM.bottom) / (top - low));
  const middle = [(ROOM.left + width - ROOM.right) / 2, (ROOM.top + height - ROOM.bottom) / 2];
  const at = ([pan, tilt]) => [middle[0] + (pan - (left + right) / 2) * scale, middle[1] - (tilt - (low + top) / 2) * scale];
  return { at, scale };
}
function drawPath() {
  if (!paper) return;
  const { canvas, section } = paper, pixel = devicePixelRatio || 1, width = section.clientWidth;
  const height = Math.round(Math.min(Math.max(0.45 * width, 220), 420));
  if (!width) return;
  Object.assign(canvas, { width: width * pixel, height: height * pixel });
  canvas.style.height = `${height}px`;
  const ctx = canvas.getContext("2d"), map = projection(width, height);
  ctx.scale(pixel, pixel);
  ctx.font = "11px system-ui, sans-serif";
  const words = new Words("path", ctx, { left: 0, top: 0, width, height }, 1);
  drawGrid(ctx, map, width, height, words);
  const tiles = move.tiles ?? [...new Map(keysAimed().map((key) => [key.aim.join(), key.aim])).values()];
  tiles.forEach((aim) => drawFrame(ctx, map, aim, "#4b525d"));
  ctx.beginPath();
  paper.points.forEach((point) => ctx.lineTo(...map.at(point)));
  Object.assign(ctx, { strokeStyle: PATH, lineWidth: 1.5 });
  ctx.stroke();
  drawFrame(ctx, map, aimAt(view.at ?? 0), FRAME, 2);
  drawStops(ctx, map, words);
}
// Where keys are, with their names: in a panorama the numbers of the pictures.
function keysAimed() {
  if (move.tiles) return move.tiles.map((aim, index) => ({ aim, mark: String(index + 1) }));
  const keys = pathAxes.flatMap((axis) => axis?.keys ?? []);
  return [...new Map(keys.map((key) => [key.mark, { aim: aimAt(key.at), mark: key.mark }])).values()];
}
function drawStops(ctx, map, words) {
  const stops = keysAimed().map((key) => ({ ...key, spot: map.at(key.aim) }));
  for (const { spot: [x, y] } of stops) {
    words.keepOut(x, y, 4);
    ctx.fillStyle = PATH;
    ctx.beginPath();
    ctx.arc(x, y, 3, 0, 7);
    ctx.fill();
  }
  for (const { spot: [x, y], mark } of stops)
    words.put(mark, PATH, [[x + 7, y, "left"], [x - 7, y, "right"], [x, y - 13, "center"], [x, y + 13, "center"]]);
}
function drawFrame(ctx, map, [pan, tilt], color, width = 1) {
  const [wide, high] = move.fov, [x, y] = map.at([pan - wide / 2, tilt + high / 2]);
  Object.assign(ctx, { strokeStyle: color, lineWidth: width });
  ctx.strokeRect(x, y, wide * map.scale, high * map.scale);
}
function drawGrid(ctx, { at, scale }, width, height, words) {
  const step = STEPS.find((each) => each * scale >= 56) ?? STEPS.at(-1), [x0, y0] = at([0, 0]);
  Object.assign(ctx, { strokeStyle: "#22262c", lineWidth: 1 });
  for (let n = Math.ceil((ROOM.left - x0) / (step * scale)); x0 + n * step * scale < width - ROOM.right; n++) {
    const x = x0 + n * step * scale;
    line(ctx, x, 0, x, height - ROOM.bottom);
    words.put(`${minus(Number((n * step).toFixed(1)))}°`, MUTED, [[x, height - 9, "center"]]);
  }
  for (let n = Math.ceil((ROOM.top - y0) / (step * scale)); y0 + n * step * scale < height - ROOM.bottom; n++) {
    const y = y0 + n * step * scale;
    line(ctx, ROOM.left, y, width, y);
    words.put(`${minus(Number((-n * step).toFixed(1)))}°`, MUTED, [[ROOM.left - 6, y, "right"]]);
  }
}
