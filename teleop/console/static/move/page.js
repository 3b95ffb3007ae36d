// The Move page: the keyframe editor around the open move.
import { html, useEffect, useSignal } from "../vendor/preact/preact.min.js";
import { command } from "../connection.js";
import { able, notify } from "../store.js";
import { clock, short } from "../format.js";
import { Icon } from "../icons.js";
import { listMoves, moves, preferred } from "../moves.js";
import { NumberField } from "../number_field.js";
import { Transport } from "../transport.js";
import { axis, canRedo, canUndo, doc, insert, open, plan, planning, positionsAt, redo, save, stretch, undo, unsaved } from "./document.js";
import { axesOfMove, Curves } from "./curves.js";
import { PathView } from "./path.js";
import { KeyTable } from "./table.js";

export function Move() {
  const at = useSignal(/** @type {number|null} */ (null));
  useEffect(() => {
    listMoves().then(() => {
      const first = preferred.peek();
      if (!doc.peek() && first && first !== "keys") open(first);
    });
  }, []);
  const now = doc.value;
  return html`<main class="move" aria-label="Move">
    <${Head} />
    <div class="editor card"><${Axes} /><${Curves} at=${at.value} /><${Scrubber} at=${at} /><${Problems} /></div>
    <${PathView} at=${at.value} />
    <section class="card numbers"><h2>Keys <span>${now ? `${now.keyframes.length} keys, ${short(plan.value?.duration ?? 0, 2)} s` : ""}</span></h2>${now?.fixed && html`<p class="waits">${now.fixed}</p>`}<${KeyTable} /></section>
    <${Transport} open=${now?.name || "keys"} blocked=${why(now)} />
  </main>`;
}

function Head() {
  const now = doc.value, name = useSignal("");
  useEffect(() => void (name.value = doc.peek()?.suggested ?? ""), [now?.suggested]);
  const store = () => {
    const called = now?.name || name.value.trim();
    if (called) save(called);
    else notify("give the new move a name first", "error");
  };
  return html`<section class="card head" aria-label="File">
    <label>Move <select value=${now?.name ?? ""} onChange=${(/** @type {any} */ e) => e.target.value && open(e.target.value, true)}>
      ${!now?.name && html`<option value="">${now ? "new, in no file yet" : "none"}</option>`}
      ${moves.value.map((each) => html`<option value=${each.name}>${each.name}${each.shipped ? " (shipped)" : ""}</option>`)}</select></label>
    <b class="title">${now?.title ?? ""}</b><span class="state">${planning.value ? "planning" : unsaved.value ? "not saved" : ""}</span>
    <span class="row end">
      <button class="icon" disabled=${!canUndo.value} aria-label="Undo" onClick=${undo}><${Icon} name="undo" /></button>
      <button class="icon" disabled=${!canRedo.value} aria-label="Redo" onClick=${redo}><${Icon} name="redo" /></button>
      ${now && !now.name && html`<input type="text" placeholder="name" aria-label="Name of the new move" value=${name.value} onInput=${(/** @type {any} */ e) => (name.value = e.target.value)} />`}
      <button class="primary" data-testid="save" disabled=${!now || !!now.fixed || !unsaved.value} onClick=${store}>Save</button>
    </span></section>`;
}

const Axes = () => html`<div class="axis-tabs" role="group" aria-label="Axis in front">${axesOfMove().map(
  (name) => html`<button class="small" aria-pressed=${axis.value === name} onClick=${() => (axis.value = name)}><i class=${`swatch fill-${name}`}></i>${name}</button>`)}</div>`;

/** @param {{at: {value: number|null}}} props */
function Scrubber({ at }) {
  const end = plan.value?.stale ? 0 : (plan.value?.duration ?? 0), time = at.value ?? 0, seconds = useSignal(3);
  const go = () => command("goto", { axes: positionsAt(time), seconds: seconds.value });
  const keys = (/** @type {KeyboardEvent} */ event) => event.key !== "Tab" && event.key !== " " && event.stopPropagation();
  return html`<div class="scrubber"><input type="range" min="0" max=${end || 1} step="0.01" value=${time} disabled=${!end} aria-label="Scrub the move" aria-valuetext=${`${short(time, 2)} s`}
      onKeyDown=${keys} onInput=${(/** @type {any} */ e) => (at.value = Number(e.target.value))} />
    <div class="row"><output class="time">${clock(time)}</output>
      <button disabled=${!able.value || at.value === null || !end} onClick=${go}>Go here</button>
      <label>in <${NumberField} label="Seconds to go here" min=${0} max=${600} step=${0.5} value=${seconds.value} set=${(/** @type {number} */ value) => (seconds.value = value)} /> s</label>
      <button disabled=${at.value === null || !end || !!doc.value?.fixed} onClick=${() => insert(time)}>Key here</button></div></div>`;
}

function Problems() {
  const { problems = [], warnings = [] } = plan.value ?? {};
  if (!problems.length && !warnings.length) return null;
  return html`<ul class="problems" aria-label="What the rig cannot do">
    ${problems.map((problem) => html`<li class="bad"><span>${problem.text}</span>${problem.shortest !== null && problem.first !== null && html`<button class="small" onClick=${() => stretch(problem)}>Stretch to ${short(problem.shortest)} s</button>`}</li>`)}
    ${warnings.map((text) => html`<li class="warn"><span>${text}</span></li>`)}</ul>`;
}

/** Why the open move cannot play. @param {import("./document.js").Doc|null} now */
function why(now) {
  if (now?.content?.timelapse) return "a timelapse is shot on the Shoot page";
  return now && unsaved.value ? "save the move to play it" : "";
}
