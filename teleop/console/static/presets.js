// Presets as tiles with a picture of the attitude: a tap recalls in the set time, a long press stores.
import { html, useRef, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, axes, inControl, notify, part } from "./store.js";
import { Attitude } from "./attitude.js";
import { NumberField } from "./number_field.js";
import { short } from "./format.js";

const LONG = 700; // ms of a press that stores
const SHOWN = 10; // numbers 0 to 9 have a key on the keyboard; higher ones are there once all of these are stored
const presets = part((s) => s.presets, {});
const KEPT = "teleop.recall-seconds";
/** The set time of a recall, in s. */
export const recallSeconds = () => Number(localStorage.getItem(KEPT)) || 2;

export function Presets() {
  const seconds = useSignal(recallSeconds());
  const numbers = [...new Set([...Array.from({ length: SHOWN }, (_, n) => n), ...Object.keys(presets.value).map(Number)])].sort((a, b) => a - b);
  if (numbers.every((number) => number in presets.value)) numbers.push(numbers[numbers.length - 1] + 1);
  const order = [...numbers.filter((n) => n > 0), ...numbers.filter((n) => n === 0)];
  const change = (/** @type {number} */ value) => {
    seconds.value = value;
    localStorage.setItem(KEPT, String(value));
  };
  return html`<section class="card presets"><h2>Presets <span>tap recalls, hold stores</span>
      <label>in <${NumberField} label="Seconds of a recall" min=${0.1} max=${600} step=${0.1} value=${seconds.value} set=${change} /> s</label></h2>
    <ul class="tiles" tabindex="0" aria-label="Presets">${order.map((number) => html`<li key=${number}><${Tile} number=${number} preset=${presets.value[number]} seconds=${seconds.value} /></li>`)}</ul>
  </section>`;
}

/** @param {{number: number, preset?: import("./types.js").Positions, seconds: number}} props */
function Tile({ number, preset, seconds }) {
  const timer = useRef(0), pressing = useSignal(false), stored = useRef(false);
  const store = () => {
    stored.current = true;
    pressing.value = false;
    command("preset_store", { number }).then((answer) => answer.ok && notify(`preset ${number} stored`));
  };
  const begin = (/** @type {PointerEvent} */ event) => {
    if (event.button > 0 || !inControl.value) return;
    stored.current = false;
    pressing.value = true;
    timer.current = window.setTimeout(store, LONG);
  };
  const end = () => {
    clearTimeout(timer.current);
    pressing.value = false;
  };
  const tap = () => {
    if (stored.current) return void (stored.current = false);
    if (!preset) return notify(`preset ${number} is empty: hold to store`);
    command("preset_recall", { number, seconds, stretch: true });
  };
  const at = (/** @type {string} */ axis) => Number(preset?.[axis] ?? 0);
  const named = preset ? axes.value.filter((axis) => axis in preset).map((axis) => `${axis} ${short(at(axis), 1)}`).join(", ") : "empty";
  const shown = preset?.name ?? (preset ? `${short(at("pan"), 0)}° ${short(at("tilt"), 0)}°` : "");
  return html`<button class="tile ${preset ? "" : "empty"} ${pressing.value ? "pressing" : ""}" data-testid=${`preset-${number}`}
      disabled=${!inControl.value || (preset && !able.value)} aria-label=${`Preset ${number} ${shown}: ${named}. Hold to store.`}
      onPointerDown=${begin} onPointerUp=${end} onPointerCancel=${end} onPointerLeave=${end} onClick=${tap} onContextMenu=${(/** @type {Event} */ e) => e.preventDefault()}>
    ${preset ? html`<${Attitude} pan=${at("pan")} tilt=${at("tilt")} roll=${at("roll")} label="" />` : html`<span class="none" aria-hidden="true">+</span>`}
    <span class="tile-name"><b>${number}</b>${" "}${shown}</span>
  </button>`;
}
