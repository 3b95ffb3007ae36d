// A gamepad at the browser is a stick like any other: the same stream, the same dead man. It counts once it was centered.
import { signal } from "./vendor/preact/preact.min.js";
import { able } from "./store.js";
import { hold, onReleased, release } from "./stick_stream.js";

const PERIOD = 20; // ms
const DEAD = 0.1; // of the range, around the center
const AXES = [["pan", 1], ["tilt", -1], ["roll", 1], ["focus", -1]]; // of the standard mapping, and their signs
const HAND = "gamepad";

/** What a gamepad at this browser does, or waits for; "" without one. */
export const gamepad = signal("");
const CENTER = "center its sticks";

let centered = false, holding = false, timer = 0;

/** @param {number} value */
const shaped = (value) => (Math.abs(value) < DEAD ? 0 : (Math.sign(value) * (Math.abs(value) - DEAD)) / (1 - DEAD));

function turn() {
  const pads = [...(navigator.getGamepads?.() ?? [])].filter((each) => each?.connected), pad = pads.find((each) => each?.mapping === "standard");
  const values = AXES.map(([, sign], n) => Number(sign) * shaped(pad?.axes[n] ?? 0)), still = values.every((value) => value === 0);
  if (still) centered = !!pad;
  const shown = !pads.length ? "" : !pad ? "of a kind that no browser maps" : centered ? "ready" : CENTER;
  if (!pad || still || !centered || !able.peek() || document.hidden || !document.hasFocus()) {
    if (!still) centered = false; // deflected while it may not move anything: center it again
    if (holding) release(HAND);
    holding = false;
    gamepad.value = shown === "ready" && !centered ? CENTER : shown;
    return;
  }
  holding = true;
  gamepad.value = "moves";
  hold(HAND, Object.fromEntries(AXES.map(([axis], n) => [axis, Math.round(values[n] * 1000) / 1000])));
}

export function watchGamepads() {
  const begin = () => (timer ||= window.setInterval(turn, PERIOD));
  const finish = () => {
    if ([...navigator.getGamepads()].some(Boolean)) return;
    turn();
    clearInterval(timer);
    timer = 0;
  };
  window.addEventListener("gamepadconnected", begin);
  window.addEventListener("gamepaddisconnected", finish);
  onReleased(() => (centered = holding = false));
}
