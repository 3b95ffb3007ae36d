// The stream of stick messages: 50 a second while a hand is on a stick, three zeros at release, then silence.
// Every way in which a hand can be lost without a pointerup ends here too: all released, zeros sent.
import { onLost, sendStick } from "./connection.js";
import { mine } from "./store.js";

const PERIOD = 20; // ms
const ZEROS = 3;
const HUNG = 1000; // ms without a turn after which nobody knows what the hand does: the rig has disarmed it too
const ENDS = ["blur", "pagehide", "freeze", "orientationchange"];

/** The deflections of each hand, by its name: a touch stick or a gamepad. @type {Map<string, Object<string, number>>} */
const hands = new Map();
/** @type {Set<() => void>} */
const whenReleased = new Set();
let seq = 0, zerosLeft = 0, timer = 0, lastTurn = 0;
/** @type {Object<string, number>} */
let last = {};

/** Called when all hands are released from outside: the page was hidden, the connection lost. @param {() => void} fn */
export const onReleased = (fn) => (whenReleased.add(fn), () => whenReleased.delete(fn));

/** A hand holds its axes at these deflections, -1 to 1, until it releases them. @param {string} name @param {Object<string, number>} deflections */
export function hold(name, deflections) {
  hands.set(name, deflections);
  if (!timer) {
    lastTurn = performance.now();
    timer = window.setInterval(turn, PERIOD);
    turn();
  }
}

/** @param {string} name */
export function release(name) {
  if (!hands.delete(name) || hands.size) return;
  zerosLeft = ZEROS;
  turn();
}

function releaseAll() {
  const held = hands.size > 0;
  hands.clear();
  if (held) {
    zerosLeft = ZEROS;
    for (let left = ZEROS; left > 0; left--) turn(); // at once: a hidden page has slow timers
  }
  whenReleased.forEach((fn) => fn());
}

function turn() {
  const now = performance.now(), hung = timer && now - lastTurn > HUNG;
  lastTurn = now;
  if (hung && hands.size) return releaseAll();
  if (hands.size) {
    zerosLeft = 0;
    /** @type {Object<string, number>} */
    const axes = Object.fromEntries(Object.keys(last).map((axis) => [axis, 0]));
    for (const deflections of hands.values()) Object.assign(axes, deflections);
    last = axes;
    emit(axes, true);
  } else if (zerosLeft > 0) {
    zerosLeft -= 1;
    emit(Object.fromEntries(Object.keys(last).map((axis) => [axis, 0])), false);
  }
  if (!hands.size && !zerosLeft) {
    clearInterval(timer);
    timer = 0;
    last = {};
  }
}

/** @param {Object<string, number>} axes @param {boolean} hold */
function emit(axes, hold) {
  if (mine.peek()) sendStick({ seq: ++seq, time: Math.round(performance.now() * 10) / 10, hold, axes });
}

export function watchReleases() {
  for (const name of ENDS) {
    window.addEventListener(name, releaseAll);
    document.addEventListener(name, releaseAll);
  }
  document.addEventListener("visibilitychange", () => document.hidden && releaseAll());
  screen.orientation?.addEventListener?.("change", releaseAll);
  onLost(releaseAll);
}
