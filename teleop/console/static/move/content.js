// Between the values of a move's file and the keyframes that the editor changes. What it does not know stays as it is.

/** @typedef {import("./document.js").Keyframe} Keyframe */

const RAW = Symbol("as it is in the file");
const AXES = ["pan", "tilt", "roll", "focus", "stick_roll", "stick_pitch", "stick_throttle", "stick_yaw"];

/**
 * The seconds of `4`, `4s`, `1m30s`, and with `fps` of `96f`; null for another way to write a time.
 * @param {any} value @param {any} fps @returns {number|null}
 */
export function seconds(value, fps) {
  if (typeof value === "number") return value;
  const text = String(value ?? "").replaceAll(" ", ""), parts = /^(?:([\d.]+)h)?(?:([\d.]+)m)?(?:([\d.]+)s?)?$/.exec(text), frames = /^(\d+)f$/.exec(text);
  if (frames && Number(fps) > 0) return Number(frames[1]) / Number(fps);
  if (!text || !parts) return null;
  return 3600 * Number(parts[1] ?? 0) + 60 * Number(parts[2] ?? 0) + Number(parts[3] ?? 0);
}

/** Why the keys of a file cannot be edited here, "" when they can. @param {any} content */
export function whyFixed(content) {
  if (!content) return "This file cannot be read: edit it as text.";
  if (content.timelapse) return "A timelapse: its times are output frames. Edit the file.";
  if (!Array.isArray(content.keyframes) || !content.keyframes.length) return "This move has no keyframes of its own. Edit the file.";
  const known = content.keyframes.every((/** @type {any} */ key) => seconds(key.at, content.fps) !== null && seconds(key.hold ?? 0, content.fps) !== null);
  return known ? "" : "Its times are timecode: edit the file.";
}

/** @param {any} content @returns {Keyframe[]} */
export function keyframesOf(content) {
  if (whyFixed(content)) return [];
  return content.keyframes.map((/** @type {any} */ raw) => {
    const hold = seconds(raw.hold ?? 0, content.fps);
    return { ...raw, at: seconds(raw.at, content.fps), ...(hold ? { hold } : {}), [RAW]: { ...raw, fps: content.fps } };
  });
}

/** The values of the file with these keyframes; a time that has not changed stays as it was written. @param {any} content @param {Keyframe[]} keyframes */
export function contentWith(content, keyframes) {
  return { ...content, keyframes: keyframes.map((key) => written(key)) };
}

/** @param {Keyframe} key */
function written(key) {
  const raw = /** @type {any} */ (key)[RAW] ?? {};
  /** @type {Object<string, any>} */
  const values = { ...key };
  for (const name of ["at", "hold"]) if (name in raw && seconds(raw[name], raw.fps) === key[name]) values[name] = raw[name];
  return values;
}

/** What the page draws of an answer of the planner; where there is no plan, the curves are those of the last one. @param {any} found @param {import("./document.js").Plan|null} last @returns {import("./document.js").Plan} */
export function planOf(found, last) {
  if (!found.ok) {
    const segments = found.segments ?? [];
    const problems = segments.length ? segments.map(problem) : (found.problems ?? [{ text: found.error }]).map((/** @type {any} */ each) => problem({ text: each.text }));
    return { duration: last?.duration ?? 0, axes: last?.axes ?? {}, cues: last?.cues ?? [], keys: last?.keys ?? [], problems, warnings: [], stale: true };
  }
  const axes = Object.fromEntries(AXES.filter((name) => found.axes[name]).map((name) => {
    const { times, positions, minimum, maximum, peak_velocity, max_velocity, unit } = found.axes[name];
    return [name, { times, position: positions, limits: [minimum, maximum], peak: peak_velocity, fastest: max_velocity, unit }];
  }));
  return { duration: found.duration, axes, cues: found.cues, keys: found.keys, problems: [], warnings: found.warnings, stale: false };
}

/** @param {any} found @returns {import("./document.js").Problem} */
const problem = ({ axis = "", first = null, last = null, shortest = null, text }) => ({ axis, first, last, shortest, text });
