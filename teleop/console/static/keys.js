// Keys from the hand: jog, set key, jog, set key, play. The keys become a move whose times are even and can be dragged.
import { html } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { axes, inControl, part, tab } from "./store.js";
import { short } from "./format.js";
import { chosen } from "./moves.js";
import { openKeys } from "./move/document.js";

const EVEN = 4; // s between two keys until they are dragged
export const keys = part((s) => s.keys, []);

export function Keys() {
  const list = keys.value, off = !inControl.value;
  const set = () => {
    chosen.value = ""; // Play is about the keys now
    command("set_key");
  };
  const edit = () => {
    openKeys(list.map((key, n) => ({ at: n * EVEN, ...key })));
    tab.value = "move";
  };
  return html`<section class="card keys"><h2>Keys from the hand <span>${list.length ? `${list.length} keys` : "go there, set a key, go on"}</span></h2>
    ${list.length > 0 && html`<div class="key-table" tabindex="0" role="region" aria-label="Keys from the hand"><table>
      <thead><tr><th scope="col">Key</th>${axes.value.map((name) => html`<th scope="col" class=${`ink-${name}`}>${name}</th>`)}<th><span class="unseen">Delete</span></th></tr></thead>
      <tbody>${list.map((key, n) => html`<tr><th scope="row">${n + 1}</th>${axes.value.map((name) => html`<td>${key[name] === undefined ? "" : short(key[name], name === "focus" ? 3 : 2)}</td>`)}
        <td><button class="small" disabled=${off} aria-label=${`Delete key ${n + 1}`} onClick=${() => command("delete_key", { number: n + 1 })}>×</button></td></tr>`)}</tbody></table></div>`}
    <div class="row">
      <button class="primary" data-testid="set-key" disabled=${off} onClick=${set}>Set key</button>
      <button disabled=${list.length < 2} onClick=${edit}>Edit as a move</button>
      <button disabled=${off || !list.length} onClick=${() => command("clear_keys")}>Clear</button>
    </div>
  </section>`;
}
