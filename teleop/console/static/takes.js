// The Takes page: what was recorded, with its result, and what can be done with it.
import { html, useEffect, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, notify, tab } from "./store.js";
import { clock, short } from "./format.js";
import { chosen, listMoves, request } from "./moves.js";
import { open } from "./move/document.js";

/** @typedef {{name: string, title?: string, began?: number|null, length: number|null, result: string, peak_error: number|null, peak_axis?: string}} Take */

const url = (/** @type {string} */ name) => `/api/takes/${encodeURIComponent(name)}`;

export function Takes() {
  const takes = useSignal(/** @type {Take[]|null} */ (null));
  const list = async () => {
    const found = await request("/api/takes");
    takes.value = found ? (found.takes ?? found) : [];
  };
  useEffect(() => void list(), []);
  const all = takes.value ?? [];
  return html`<main class="takes" aria-label="Takes"><section class="card list"><h2>Takes <span>${takes.value === null ? "reading" : `${all.length} in the folder`}</span>
      <button class="small end" onClick=${list}>Read again</button></h2>
    ${takes.value !== null && !all.length && html`<p>There is no take yet. <code>teleop live --take NAME.mcap</code> and <code>teleop play --take NAME.mcap</code> record one.</p>`}
    ${all.length > 0 && html`<div class="scroll" tabindex="0" role="region" aria-label="List of takes"><table><thead><tr><th scope="col">Take</th><th scope="col">Began</th><th scope="col">Length</th><th scope="col">Result</th><th scope="col">Peak error</th><th><span class="unseen">Actions</span></th></tr></thead>
      <tbody>${all.map((take) => html`<${Row} key=${take.name} take=${take} />`)}</tbody></table></div>`}
  </section></main>`;
}

/** @param {{take: Take}} props */
function Row({ take }) {
  const keys = async () => {
    const made = await request(`${url(take.name)}/keys`, { method: "POST", body: {} });
    if (!made) return null;
    await listMoves();
    notify(`${made.name} has the keys of ${take.name}`);
    return made.name;
  };
  const edit = async () => {
    const name = await keys();
    if (!name) return;
    await open(name);
    tab.value = "move";
  };
  const replay = async () => {
    const name = await keys();
    if (!name) return;
    chosen.value = name;
    command("play", { move: name });
  };
  return html`<tr><th scope="row">${take.name}${take.title && html`<span class="title">${take.title}</span>`}</th>
    <td>${take.began ? new Date(take.began * 1000).toLocaleString("sv-SE") : ""}</td><td>${take.length === null ? "" : clock(take.length)}</td>
    <td class=${/complete|finished|ok/i.test(take.result) ? "good" : "warn"}>${take.result}</td>
    <td>${take.peak_error === null || take.peak_error === undefined ? "" : `${short(take.peak_error, 2)}° ${take.peak_axis ?? ""}`}</td>
    <td class="buttons"><a class="button small" href=${`${url(take.name)}/report`} target="_blank" rel="noopener">Report</a>
      <button class="small" disabled=${!able.value} onClick=${replay}>Replay</button>
      <button class="small" onClick=${edit}>Make keys</button>
      <a class="button small" href=${`${url(take.name)}/download`} download>Download</a></td></tr>`;
}
