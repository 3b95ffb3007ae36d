// The focus slider with its marks A, B and C: a tap goes there in the set time, a long press sets the mark here.
import { html, useRef, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, inControl, notify, part, state } from "./store.js";
import { NumberField } from "./number_field.js";
import { position } from "./format.js";

const LONG = 700; // ms
const KEPT = "teleop.focus-marks";
const marksOfRig = part((s) => s.focus_marks, {});

/** Marks of the rig, over those kept in this browser. @param {Object<string, number>} own */
const known = (own) => ({ ...own, ...marksOfRig.value });

export function FocusCard() {
  const dragged = useSignal(/** @type {number|null} */ (null)), seconds = useSignal(1);
  const own = useSignal(/** @type {Object<string, number>} */ (JSON.parse(localStorage.getItem(KEPT) ?? "{}")));
  const axis = state.value?.axes.focus;
  if (!axis) return null;
  const low = axis.minimum ?? 0, high = axis.maximum ?? 1, now = axis.measured ?? axis.commanded ?? low;
  const marks = known(own.value), at = (/** @type {number} */ value) => `${(100 * (value - low)) / (high - low)}%`;
  const set = (/** @type {string} */ name) => {
    own.value = { ...own.value, [name]: Math.round(now * 1000) / 1000 };
    localStorage.setItem(KEPT, JSON.stringify(own.value));
    notify(`focus mark ${name} set at ${position(now, "")}`);
  };
  return html`<section class="card focus"><h2>Focus <span>${position(now, "")}</span>
      <label>in <${NumberField} label="Seconds of a focus pull" min=${0} max=${60} step=${0.1} value=${seconds.value} set=${(/** @type {number} */ value) => (seconds.value = value)} /> s</label></h2>
    <div class="slider">
      <div class="track" aria-hidden="true"><i class="fill" style=${{ width: at(now) }}></i>
        ${Object.entries(marks).map(([name, value]) => html`<i class="notch" style=${{ left: at(value) }}>${name}</i>`)}
        ${dragged.value !== null && html`<i class="wish" style=${{ left: at(dragged.value) }}></i>`}</div>
      <input type="range" min=${low} max=${high} step="0.001" value=${dragged.value ?? now} disabled=${!able.value} aria-label="Focus, 0 near to 1 far"
        onInput=${(/** @type {any} */ e) => (dragged.value = Number(e.target.value))}
        onChange=${(/** @type {any} */ e) => (command("focus", { to: Number(e.target.value), seconds: seconds.value }), (dragged.value = null))} />
    </div>
    <div class="marks">${["A", "B", "C"].map((name) => html`<${Mark} name=${name} value=${marks[name]} set=${() => set(name)}
      go=${() => command("focus", { to: marks[name], seconds: seconds.value })} />`)}</div>
  </section>`;
}

/** @param {{name: string, value?: number, set: () => void, go: () => void}} props */
function Mark({ name, value, set, go }) {
  const timer = useRef(0), done = useRef(false);
  const begin = () => {
    done.current = false;
    timer.current = window.setTimeout(() => ((done.current = true), set()), LONG);
  };
  const end = () => clearTimeout(timer.current);
  const tap = () => {
    if (done.current) return void (done.current = false);
    if (value === undefined) set();
    else go();
  };
  const shown = value === undefined ? "set" : position(value, ""), action = value === undefined ? "set the focus mark here" : "go to the focus mark; hold to set it here";
  return html`<button disabled=${!inControl.value || (value !== undefined && !able.value)} aria-label=${`${name} ${shown}: ${action}`} data-testid=${`focus-mark-${name}`}
    onPointerDown=${begin} onPointerUp=${end} onPointerLeave=${end} onPointerCancel=${end} onClick=${tap} onContextMenu=${(/** @type {Event} */ e) => e.preventDefault()}>
    <b>${name}</b>${" "}<span>${shown}</span></button>`;
}
