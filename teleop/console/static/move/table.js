// The keys as numbers to type: time, positions, dwell, pass and ease of each.
import { html } from "../vendor/preact/preact.min.js";
import { NumberField } from "../number_field.js";
import { doc, edit, plan, positionsAt, room, selected } from "./document.js";
import { axesOfMove } from "./curves.js";
import { isShare } from "./scale.js";

const EASES = ["", "soft", "25%", "50%", "1s", "2s"];

export function KeyTable() {
  const now = doc.value, names = axesOfMove();
  if (!now) return null;
  const off = !!now.fixed;
  return html`<div class="key-table edit" tabindex="0" role="region" aria-label="Keys as numbers"><table>
    <thead><tr><th scope="col">Key</th><th scope="col">Time (s)</th>${names.map((name) => html`<th scope="col" class=${`ink-${name}`}>${name}</th>`)}
      <th scope="col">Dwell (s)</th><th scope="col">Pass</th><th scope="col">Ease</th><th><span class="unseen">Change</span></th></tr></thead>
    <tbody>${now.keyframes.map((key, index) => html`<${Row} key=${index} keyframe=${key} index=${index} names=${names} off=${off} />`)}</tbody></table></div>`;
}

/** @param {{keyframe: import("./document.js").Keyframe, index: number, names: string[], off: boolean}} props */
function Row({ keyframe, index, names, off }) {
  const number = index + 1, bad = new Set((plan.value?.problems ?? []).filter(({ first, last }) => first !== null && last !== null && number >= first && number <= last).map((problem) => problem.axis));
  const set = (/** @type {string} */ name, /** @type {any} */ value) => edit((keys) => {
    if (value === null) delete keys[index][name];
    else keys[index][name] = value;
  });
  const time = (/** @type {number} */ at) => set("at", Math.min(Math.max(at, room(index)[0]), room(index)[1]));
  const eases = [...new Set([...EASES, ...(typeof keyframe.ease === "string" ? [keyframe.ease] : [])])];
  return html`<tr class=${selected.value === number ? "selected" : ""} onFocusIn=${() => (selected.value = number)}>
    <th scope="row">${number}</th>
    <td><${NumberField} label=${`Time of key ${number}`} value=${keyframe.at} step=${0.1} off=${off} set=${time} /></td>
    ${names.map((name) => html`<td class=${bad.has(name) ? "bad" : ""}>${keyframe[name] !== null && typeof keyframe[name] === "object" ? "…" : html`<${NumberField} label=${`${name} of key ${number}`}
      value=${keyframe[name]} step=${isShare(name) ? 0.01 : 1} off=${off} empty=${true} set=${(/** @type {number|null} */ value) => set(name, value)} />`}</td>`)}
    <td><${NumberField} label=${`Dwell of key ${number}`} value=${keyframe.hold ?? 0} min=${0} step=${0.5} off=${off} set=${(/** @type {number} */ hold) => set("hold", hold > 0 ? hold : null)} /></td>
    <td><select aria-label=${`Pass of key ${number}`} value=${keyframe.pass ?? "through"} disabled=${off} onChange=${(/** @type {any} */ e) => set("pass", e.target.value === "stop" ? "stop" : null)}>
      <option value="through">through</option><option value="stop">stop</option></select></td>
    <td>${typeof keyframe.ease === "object" && keyframe.ease !== null ? "own" : html`<select aria-label=${`Ease of key ${number}`} value=${keyframe.ease ?? ""} disabled=${off} onChange=${(/** @type {any} */ e) => set("ease", e.target.value || null)}>
      ${eases.map((ease) => html`<option value=${ease}>${ease || "none"}</option>`)}</select>`}</td>
    <td class="buttons"><button class="small" disabled=${off} aria-label=${`Add a key after key ${number}`} onClick=${() => add(index)}>+</button>
      <button class="small" disabled=${off || (doc.value?.keyframes.length ?? 0) < 2} aria-label=${`Delete key ${number}`} onClick=${() => edit((keys) => keys.filter((_, n) => n !== index))}>×</button></td>
  </tr>`;
}

/** A key half way to the next one, or 2 s after the last. @param {number} index */
function add(index) {
  edit((keys) => {
    const here = keys[index], next = keys[index + 1], at = next ? (here.at + (here.hold ?? 0) + next.at) / 2 : here.at + (here.hold ?? 0) + 2;
    const { hold: _, ease: __, pass: ___, ...same } = here;
    keys.splice(index + 1, 0, { ...same, ...(next ? positionsAt(at) : {}), at: Math.round(at * 100) / 100 });
  });
}
