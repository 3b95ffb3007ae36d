// Numbers and times as text. Signs are ASCII, so that a program can read them from the page too.

/** Angles with two decimals, shares (focus) with three. @param {number|null|undefined} value @param {string} unit */
export const position = (value, unit) => (value === null || value === undefined ? "--" : signed(value, unit ? 2 : 3));
/** @param {number} value @param {number} digits */
export const signed = (value, digits) => {
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) !== 0 ? "-" : "+") + text;
};
/** The sign of a unit: "deg" is °. @param {string} unit */
export const sign = (unit) => (unit === "deg" ? "°" : "");
/** @param {number|null} ms */
export const milliseconds = (ms) => (ms === null ? "--" : ms < 10 ? `${ms.toFixed(1)} ms` : ms < 10_000 ? `${Math.round(ms)} ms` : `${Math.round(ms / 1000)} s`);
/** Seconds as 00:03.93, or 1:02:03. @param {number} seconds */
export function clock(seconds) {
  const whole = Math.floor(Math.max(seconds, 0)), pad = (/** @type {number} */ n) => String(n).padStart(2, "0");
  if (whole >= 3600) return `${Math.floor(whole / 3600)}:${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}`;
  return `${pad(Math.floor(whole / 60))}:${(Math.max(seconds, 0) % 60).toFixed(2).padStart(5, "0")}`;
}
/** Seconds as 02:13. @param {number} seconds */
export const minutes = (seconds) => clock(seconds).split(".")[0];
/** The time of day of unix seconds. @param {number|null|undefined} unix */
export const timeOfDay = (unix) => (unix ? new Date(unix * 1000).toLocaleTimeString("en-GB") : "--");
/** At most so many decimals, without zeros at the end. @param {number} value @param {number} [digits] */
export const short = (value, digits = 3) => String(Number(value.toFixed(digits)));
