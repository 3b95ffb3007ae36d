// The Takes page: what was recorded, with its result, and what can be done with it.
import { html, useEffect, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, notify, tab } from "./store.js";
import { clock, short } from "./format.js";
import { chosen, listMoves, moves, request } from "./moves.js";
import { openNew } from "./move/document.js";

/** @typedef {{name: string, title?: string, started?: string, seconds?: number, result?: string, ok: boolean, damaged: boolean, problem: string,
 *   peaks?: Object<string, number|null>|null, report: string, download: string}} Take */
const AGAIN = 1500; // ms until peaks that are still computed are asked for again

const url = (/** @type {string} */ name) => `/api/takes/${encodeURIComponent(name)}`;

export function Takes() {
  const takes = useSignal(/** @type {Take[]|null} */ (null));
  const list = async () => {
    const found = await request("/api/takes");
    if (found || !takes.peek()) takes.value = found?.takes ?? [];
  };
  useEffect(() => void list(), []);
  useEffect(() => {
    if (!takes.value?.some((take) => take.peaks === null)) return;
    const timer = setTimeout(list, AGAIN);
    return () => clearTimeout(timer);
  }, [takes.value]);
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
  const edit = async () => {
    const made = await request(`${url(take.name)}/keys`, { method: "POST", body: {} });
    if (!made) return;
    openNew(made.content, `${take.name}-keys`);
    notify(`${made.keyframes ?? ""} keys of ${take.name}: save them to keep them`);
    tab.value = "move";
  };
  const replay = async () => {
    const name = `${take.name}-replay`;
    if (!moves.peek().some((move) => move.name === name) && !(await request(`${url(take.name)}/keys`, { method: "POST", body: { save: name } }))) return;
    await listMoves();
    chosen.value = name;
    command("play", { move: name });
  };
  return html`<tr><th scope="row">${take.name}${take.title && html`<span class="title">${take.title}</span>`}</th>
    <td>${take.started ? new Date(take.started).toLocaleString("sv-SE") : ""}</td><td>${take.seconds === undefined ? "" : clock(take.seconds)}</td>
    <td class=${take.ok ? "good" : "warn"} title=${take.problem || undefined}>${take.damaged ? take.problem : take.result}</td>
    <td>${take.peaks === null ? "computing" : largest(take.peaks ?? {})}</td>
    <td class="buttons"><a class="button small" href=${take.report} target="_blank" rel="noopener">Report</a>
      <button class="small" disabled=${!able.value} onClick=${replay}>Replay</button>
      <button class="small" onClick=${edit}>Make keys</button>
      <a class="button small" href=${take.download} download>Download</a></td></tr>`;
}

/** The largest error of the angles, else of what there is. @param {Object<string, number|null>} peaks */
function largest(peaks) {
  const known = Object.entries(peaks).filter(([, peak]) => peak !== null), angles = known.filter(([axis]) => axis !== "focus");
  const [axis, peak] = (angles.length ? angles : known).sort((a, b) => Number(b[1]) - Number(a[1]))[0] ?? ["", null];
  return peak === null ? "" : `${short(peak, 2)}${axis === "focus" ? "" : "°"} ${axis}`;
}
