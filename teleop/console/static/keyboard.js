// The keyboard of the console: the same keys as `teleop live` and `teleop play` have in a terminal.
import { html, signal, useEffect, useRef } from "./vendor/preact/preact.min.js";
import { command, stop } from "./connection.js";
import { commission, pressedKey } from "./commission.js";
import { able, mine, notify, state } from "./store.js";
import { recallSeconds } from "./presets.js";
import { toPlay } from "./transport.js";

/** Jogs: [axis, units]. @type {Object<string, [string, number]>} */
const JOGS = {
  ArrowUp: ["tilt", 1], ArrowDown: ["tilt", -1], ArrowRight: ["pan", 1], ArrowLeft: ["pan", -1],
  k: ["tilt", 0.1], j: ["tilt", -0.1], l: ["pan", 0.1], h: ["pan", -0.1], K: ["tilt", 10], J: ["tilt", -10], L: ["pan", 10], H: ["pan", -10],
  "<": ["roll", -1], ">": ["roll", 1], "[": ["focus", -0.01], "]": ["focus", 0.01], "{": ["focus", -0.1], "}": ["focus", 0.1],
};
const FOLLOW = /** @type {Object<string, string>} */ ({ l: "lock", y: "yaw", s: "sport" });
const QUESTIONS = /** @type {Object<string, string>} */ ({ s: "store which preset? 0-9", x: "delete which preset? 0-9", f: "follow mode? l lock, y yaw, s sport" });
const HELP = [
  ["space", "STOP all axes (motors stay on)"], ["c", "clear STOP"], ["arrows", "pan, tilt by 1°; shift 10, ctrl 0.1"],
  ["h j k l", "pan, tilt by 0.1°; H J K L by 10"], ["< >", "roll by 1°"], ["[ ]", "focus by 1 %; { } by 10 %"],
  ["- + v", "speed range: slower, faster, next"], ["f l/y/s", "follow mode: lock, yaw, sport"], ["0-9", "recall a preset"],
  ["s 0-9", "store a preset"], ["x 0-9", "delete a preset"], ["z", "recenter"], ["r", "record on or off"], [".", "shutter"],
  ["g", "play"], ["p", "pause, resume"], ["Tab, Enter", "go to a control, press it"], ["?", "these keys"],
];

const helping = signal(false);
let asked = "";

/** @param {KeyboardEvent} event */
function pressed(event) {
  const target = /** @type {HTMLElement} */ (event.target), typing = target.matches("input:not([type=range]), textarea");
  if (event.key === " " && !target.matches("input[type=text], textarea")) {
    event.preventDefault();
    stop(); // also where a button has the focus: Enter presses buttons
    return;
  }
  if (typing || event.metaKey || event.altKey || target.matches("select, input") || (event.ctrlKey && !event.key.startsWith("Arrow"))) return;
  if (commission.peek()) return void (pressedKey(event) && event.preventDefault());
  if (event.key === "Escape") return void ((helping.value = false), (asked = ""));
  const question = asked;
  asked = "";
  if (question ? answer(question, event.key) : single(event)) event.preventDefault();
}

/** @param {string} question @param {string} key */
function answer(question, key) {
  if (question === "f" && FOLLOW[key]) command("follow", { mode: FOLLOW[key] });
  else if (/^\d$/.test(key)) command(question === "s" ? "preset_store" : "preset_delete", { number: Number(key) });
  else return false;
  return true;
}

/** @param {KeyboardEvent} event */
function single(event) {
  const { key } = event, s = state.peek();
  if (key in JOGS) return jog(event, ...JOGS[key]);
  if (key in QUESTIONS) return (asked = key), notify(QUESTIONS[key]), true;
  if (/^\d$/.test(key)) return recall(Number(key));
  const range = s?.range ?? 1, ranges = s?.ranges.length ?? 1;
  /** @type {Object<string, () => any>} */
  const acts = {
    c: clear,
    "-": () => command("range", { number: Math.max(range - 1, 1) }),
    "+": () => command("range", { number: Math.min(range + 1, ranges) }),
    "=": () => command("range", { number: Math.min(range + 1, ranges) }),
    v: () => command("range", { number: (range % ranges) + 1 }),
    z: () => command("recenter"),
    r: () => command(s?.recording ? "stop_recording" : "record"),
    ".": () => command("shutter"),
    g: () => command("play", { move: toPlay() }),
    p: () => command(s?.move?.phase === "paused" ? "resume" : "pause"),
    "?": () => (helping.value = !helping.value),
  };
  if (!(key in acts) || event.repeat) return false;
  acts[key]();
  return true;
}

/** @param {KeyboardEvent} event @param {string} axis @param {number} units */
function jog(event, axis, units) {
  if (!state.peek()?.axes[axis]) return false;
  if (!able.peek()) return notify(mine.peek() ? "stopped: clear STOP first" : "take control first"), true;
  const by = event.key.startsWith("Arrow") ? units * (event.shiftKey ? 10 : event.ctrlKey ? 0.1 : 1) : units;
  command("jog", { axis, by, within: Math.abs(by) >= 10 ? 3 : 1 }, { quiet: event.repeat });
  return true;
}

/** @param {number} number */
function recall(number) {
  command("preset_recall", { number, seconds: recallSeconds() });
  return true;
}

/** Clears STOP; who watches takes control first, if it is free. */
export async function clear() {
  if (!mine.peek() && (await command("take_control")).error) return;
  command("clear");
}

export function watchKeyboard() {
  window.addEventListener("keydown", pressed);
  // A space that was STOP must not press the focused button when it comes up.
  window.addEventListener("keyup", (event) => event.key === " " && /** @type {HTMLElement} */ (event.target).matches("button, [role=button]") && event.preventDefault());
}

export function Help() {
  const dialog = useRef(/** @type {any} */ (null));
  useEffect(() => {
    if (helping.value && !dialog.current?.open) dialog.current?.showModal();
    else if (!helping.value) dialog.current?.close();
  }, [helping.value]);
  return html`<dialog ref=${dialog} class="card help" aria-label="Keys" onClose=${() => (helping.value = false)}>
    <h2>Keys</h2><dl>${HELP.map(([key, what]) => html`<div><dt>${key}</dt><dd>${what}</dd></div>`)}</dl>
    <p>STOP is not an emergency stop: the motors stay powered.</p>
    <button class="primary" onClick=${() => (helping.value = false)}>Close</button></dialog>`;
}

export const showHelp = () => (helping.value = true);
