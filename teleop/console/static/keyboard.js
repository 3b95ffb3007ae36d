// The keyboard of the console: the same keys as `teleop live`, `teleop play` and a shoot have in a terminal.
import { html, signal, useEffect, useLayoutEffect, useRef } from "./vendor/preact/preact.min.js";
import { command, stop } from "./connection.js";
import { commission, pressedKey } from "./commission.js";
import { able, mine, notify, state } from "./store.js";
import { SHEETS } from "./key_sheets.js";
import { recallSeconds } from "./presets.js";
import { toPlay } from "./transport.js";
import { track } from "./tracking.js";

/** Jogs: [axis, units]. @type {Object<string, [string, number]>} */
const JOGS = {
  ArrowUp: ["tilt", 1], ArrowDown: ["tilt", -1], ArrowRight: ["pan", 1], ArrowLeft: ["pan", -1],
  k: ["tilt", 0.1], j: ["tilt", -0.1], l: ["pan", 0.1], h: ["pan", -0.1], K: ["tilt", 10], J: ["tilt", -10], L: ["pan", 10], H: ["pan", -10],
  "<": ["roll", -1], ">": ["roll", 1], "[": ["focus", -0.01], "]": ["focus", 0.01], "{": ["focus", -0.1], "}": ["focus", 0.1],
};
const FOLLOW = /** @type {Object<string, string>} */ ({ l: "lock", y: "yaw", s: "sport" });
const QUESTIONS = /** @type {Object<string, string>} */ ({ s: "store which preset? 0-9", x: "delete which preset? 0-9", f: "follow mode? l lock, y yaw, s sport", a: "follow which tracking source? 1-9, 0 ends" });
/** Keys that are followed by a word, and Enter. @type {Object<string, {name: string, hint: string, send: (text: string) => any}>} */
const WORDS = {
  d: { name: "Drone command", hint: "engage, disengage, arm, disarm, take-off, land, home", send: (text) => command("drone", { command: text }) },
  t: { name: "Mark target", hint: "name,distance or name,x,y,z in m", send: (text) => command("mark_target", { text }) },
};
const LONGEST_WORD = 40;
const SPEED_STEP = 0.1; // of the written speed, as in the terminal
const MOST_SPEED = 2;

const helping = signal(false);
const spelling = signal(""); // the key of the word that is typed
let asked = "";

/** @param {KeyboardEvent} event */
function pressed(event) {
  const target = /** @type {HTMLElement} */ (event.target), typing = target.matches("input:not([type=range]), textarea");
  if (event.key === " " && (!target.matches("input[type=text], textarea") || target.matches(".word"))) {
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
  else if (question === "a" && /^\d$/.test(key)) track(Number(key));
  else if ("sx".includes(question) && /^\d$/.test(key)) command(question === "s" ? "preset_store" : "preset_delete", { number: Number(key) });
  else return false;
  return true;
}

/** @param {KeyboardEvent} event */
function single(event) {
  const { key } = event, s = state.peek();
  const act = key in ALWAYS ? ALWAYS[key] : s?.shoot ? IN_A_SHOOT[key] : (s?.move && IN_A_MOVE[key]) || BY_HAND[key];
  if (act) {
    if (!event.repeat) act();
    return !event.repeat;
  }
  if (s?.shoot) return false;
  if (key in JOGS) return jog(event, ...JOGS[key]);
  if (key in QUESTIONS) return (asked = key), notify(QUESTIONS[key]), true;
  if (key in WORDS) return (spelling.value = key), true;
  if (/^\d$/.test(key)) return recall(Number(key));
  return false;
}

/** @typedef {Object<string, () => any>} Acts */
/** @param {number} by */
const range = (by) => command("range", { number: Math.min(Math.max((state.peek()?.range ?? 1) + by, 1), state.peek()?.ranges.length ?? 1) });
/** @param {number} by */
const speed = (by) => {
  const now = state.peek()?.move, most = now?.max_speed ?? MOST_SPEED;
  command("speed", { share: Number(Math.min(Math.max((now?.speed ?? 1) + by, SPEED_STEP), most).toFixed(2)) });
};
const pause = () => command((state.peek()?.move ?? state.peek()?.shoot)?.phase === "paused" || state.peek()?.shoot?.paused ? "resume" : "pause");
const end = () => (state.peek()?.move || state.peek()?.shoot ? command("abort") : notify("the rig is closed where it was started"));

/** @type {Acts} */
const ALWAYS = { c: () => clear(), p: pause, q: end, "?": () => (helping.value = !helping.value) };
/** @type {Acts} */
const BY_HAND = {
  e: () => command("manual", { on: !state.peek()?.manual }),
  "-": () => range(-1), "+": () => range(1), "=": () => range(1),
  v: () => command("range", { number: ((state.peek()?.range ?? 1) % (state.peek()?.ranges.length ?? 1)) + 1 }),
  z: () => command("recenter"),
  r: () => command(state.peek()?.recording ? "stop_recording" : "record"),
  ".": () => command("shutter"),
  b: () => command("drone", { command: "disengage" }),
  g: () => command("play", { move: toPlay() }),
};
/** While a move plays or waits. @type {Acts} */
const IN_A_MOVE = {
  "-": () => speed(-SPEED_STEP), "+": () => speed(SPEED_STEP), "=": () => speed(SPEED_STEP),
  "<": () => command("previous_key"), ">": () => command("next_key"), ArrowLeft: () => command("previous_key"), ArrowRight: () => command("next_key"),
  g: () => command("resume"),
};
/** @type {Acts} */
const IN_A_SHOOT = {
  ".": () => command("next_key"), ",": () => command("previous_key"), ArrowRight: () => command("next_key"), ArrowLeft: () => command("previous_key"),
  g: () => command("resume"),
};

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
  command("preset_recall", { number, seconds: recallSeconds(), stretch: true });
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

/** A word that is typed after its key; the space bar is STOP in it too. */
export function Word() {
  const field = useRef(/** @type {any} */ (null)), word = WORDS[spelling.value];
  useLayoutEffect(() => word && field.current?.focus(), [spelling.value]); // before the next key is pressed
  if (!word) return null;
  const send = (/** @type {Event} */ event) => {
    event.preventDefault();
    const text = field.current.value.trim().toLowerCase();
    spelling.value = "";
    if (text) word.send(text);
  };
  return html`<form class="banner" onSubmit=${send}><label>${word.name} <input class="word" type="text" maxlength=${LONGEST_WORD} autocomplete="off" autocapitalize="off" spellcheck=${false} ref=${field}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => event.key === "Escape" && (spelling.value = "")} onBlur=${() => (spelling.value = "")} /></label>
    <span>${word.hint}. Enter sends, Escape cancels.</span></form>`;
}

export function Help() {
  const dialog = useRef(/** @type {any} */ (null));
  useEffect(() => {
    if (helping.value && !dialog.current?.open) dialog.current?.showModal();
    else if (!helping.value) dialog.current?.close();
  }, [helping.value]);
  return html`<dialog ref=${dialog} class="card help" aria-label="Keys" onClose=${() => (helping.value = false)}>
    ${SHEETS.map(([title, keys]) => html`<h2>${title}</h2><dl>${keys.map(([key, what]) => html`<div><dt>${key}</dt><dd>${what}</dd></div>`)}</dl>`)}
    <p>STOP is not an emergency stop: the motors stay powered.</p>
    <button class="primary" onClick=${() => (helping.value = false)}>Close</button></dialog>`;
}

export const showHelp = () => (helping.value = true);
