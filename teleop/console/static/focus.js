// The focus slider with its marks A, B and C, which the rig keeps: a tap goes there in the set time, a long press sets the
// mark here. The slider snaps to a mark that is near.
import { html, useRef, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, inControl, part, state } from "./store.js";
import { NumberField } from "./number_field.js";
import { position } from "./format.js";

const LONG = 700; // ms
const NEAR = 0.012; // of the way, within which the slider means the mark
const marksOfRig = part((s) => s.focus_marks, {});

export function FocusCard() {
  const pulled = useRef(false), dragged = useSignal(/** @type {number|null} */ (null)), seconds = useSignal(1);
  const axis = state.value?.axes.focus;
  if (!axis) return null;
  const low = axis.minimum ?? 0, high = axis.maximum ?? 1, now = axis.measured ?? axis.commanded ?? low;
  const marks = marksOfRig.value, at = (/** @type {number} */ value) => `${(100 * (value - low)) / (high - low)}%`;
  const meant = (/** @type {number} */ value) => (pulled.current ? near(value) : value); // keys say it to the last digit
  const near = (/** @type {number} */ value) => Object.values(marks).find((mark) => Math.abs(mark - value) < NEAR * (high - low)) ?? value;
  return html`<section class="card focus"><h2>Focus <span>${position(now, "")}</span>
      <label>in <${NumberField} label="Seconds of a focus pull" min=${0} max=${60} step=${0.1} value=${seconds.value} set=${(/** @type {number} */ value) => (seconds.value = value)} /> s</label></h2>
    <div class="slider">
      <div class="track" aria-hidden="true"><i class="fill" style=${{ width: at(now) }}></i>
        ${Object.entries(marks).map(([name, value]) => html`<i class="notch" style=${{ left: at(value) }}>${name}</i>`)}
        ${dragged.value !== null && html`<i class="wish" style=${{ left: at(dragged.value) }}></i>`}</div>
      <input type="range" min=${low} max=${high} step="0.001" value=${dragged.value ?? now} disabled=${!able.value} aria-label="Focus, 0 near to 1 far"
        onPointerDown=${() => (pulled.current = true)} onKeyDown=${() => (pulled.current = false)}
        onInput=${(/** @type {any} */ e) => (dragged.value = meant(Number(e.target.value)))}
        onChange=${(/** @type {any} */ e) => (command("focus", { to: meant(Number(e.target.value)), seconds: seconds.value, stretch: true }), (dragged.value = null))} />
    </div>
    <div class="marks">${["A", "B", "C"].map((name) => html`<${Mark} name=${name} value=${marks[name]} set=${() => command("focus_mark_store", { name })}
      go=${() => command("focus_mark_recall", { name, seconds: seconds.value, stretch: true })} />`)}</div>
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
