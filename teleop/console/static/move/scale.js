// From seconds and degrees to pixels and back, and where the lines of a grid are.

const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 120, 180, 300, 360, 600, 900, 1800, 3600];
const REM = parseFloat(getComputedStyle(document.documentElement).fontSize);
export const ROOM = { left: 2.9 * REM, right: 2.5 * REM, top: 0.9 * REM, bottom: 1.65 * REM }; // px around the curves
export const LINE = 2.8 * REM; // px from one line of the grid to the next, at least

/** Whether an axis has no angle but a share: 0 to 1. @param {string} axis */
export const isShare = (axis) => !["pan", "tilt", "roll"].includes(axis);

/** @typedef {{x: (t: number) => number, y: (axis: string, v: number) => number, time: (x: number) => number, value: (axis: string, y: number) => number,
 *   low: number, high: number, span: number, width: number, height: number, valueRange: (axis: string) => [number, number]}} Scale */

/**
 * Degrees share one scale; focus and other shares have 0 to 1 over the whole height.
 * @param {number} width @param {number} height @param {number} span @param {[number, number]} degrees @returns {Scale}
 */
export function scaleOf(width, height, span, degrees) {
  const w = Math.max(width - ROOM.left - ROOM.right, 10), h = Math.max(height - ROOM.top - ROOM.bottom, 10);
  const valueRange = (/** @type {string} */ axis) => /** @type {[number, number]} */ (isShare(axis) ? [0, 1] : degrees);
  return {
    low: degrees[0], high: degrees[1], span, width, height, valueRange,
    x: (t) => ROOM.left + (t / span) * w,
    time: (x) => ((x - ROOM.left) / w) * span,
    y: (axis, v) => {
      const [low, high] = valueRange(axis);
      return ROOM.top + h - ((v - low) / (high - low)) * h;
    },
    value: (axis, y) => {
      const [low, high] = valueRange(axis);
      return low + ((ROOM.top + h - y) / h) * (high - low);
    },
  };
}

/** Multiples of a round step between two values, about `most` of them. @param {number} low @param {number} high @param {number} most */
export function ticks(low, high, most) {
  const step = STEPS.find((each) => (high - low) / each <= most) ?? (high - low) / most, first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, n) => Number(((first + n) * step).toFixed(6)));
}

/** Room around values, at least ten degrees. @param {number[]} values @returns {[number, number]} */
export function padded(values) {
  const low = Math.min(...values), high = Math.max(...values);
  if (!values.length) return [-10, 10];
  const more = Math.max(0.12 * (high - low), (10 - (high - low)) / 2);
  return [low - more, high + more];
}
