// The transport: what plays, its preroll, play and pause, its speed, its keys, its passes and how far each was off.
import { html, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, inControl, part } from "./store.js";
import { clock, short } from "./format.js";
import { NumberField } from "./number_field.js";
import { Icon } from "./icons.js";
import { chosen, playable, preferred } from "./moves.js";
import { keys } from "./keys.js";

const move = part((s) => s.move, null);
const errors = part((s) => s.errors, null);
const SPEEDS = [0.25, 0.5, 0.75, 1, 1.5, 2];
const KEPT = "teleop.preroll";

/** What play starts: a move that was chosen, else the keys from the hand where there are two, else a move of the folder. @param {string} [open] */
export const toPlay = (open) => open ?? (chosen.value || (keys.value.length > 1 ? "keys" : preferred.value || "keys"));

/** @param {{compact?: boolean, open?: string, blocked?: string}} props `open` is the move that the editor has, `blocked` why it cannot play */
export function Transport({ compact = false, open, blocked = "" }) {
  const loop = useSignal(false), passes = useSignal(1), wait = useSignal(Number(localStorage.getItem(KEPT) ?? 3));
  const now = move.value, playing = now !== null, paused = now?.phase === "paused", off = !able.value;
  const what = toPlay(open), none = what === "keys" && keys.value.length < 2;
  const start = () => command("play", { move: what, preroll: wait.value, passes: passes.value, loop: loop.value });
  return html`<section class="card transport"><h2>${now ? now.title : "Transport"} <span>${phase(now)}</span></h2>
    <div class="row">
      <button class="icon" disabled=${off || !paused} title="while paused" aria-label="To the start" onClick=${() => command("to_start")}><${Icon} name="start" /></button>
      <button class="icon" disabled=${off || !paused} title="while paused" aria-label="Previous key" onClick=${() => command("previous_key")}><${Icon} name="previous" /></button>
      <button class="icon play" data-testid="play" disabled=${off || playing || none || !!blocked} aria-label=${`Play ${what}`} title=${blocked || undefined} onClick=${start}><${Icon} name="play" /></button>
      <button class="icon pause ${paused ? "on" : ""}" data-testid="pause" disabled=${off || !playing} aria-label=${paused ? "Resume" : "Pause"}
        onClick=${() => command(paused ? "resume" : "pause")}><${Icon} name=${paused ? "resume" : "pause"} /></button>
      <button class="icon" disabled=${off || !paused} title="while paused" aria-label="Next key" onClick=${() => command("next_key")}><${Icon} name="next" /></button>
      <button class="icon" disabled=${!inControl.value || !playing} aria-label="End the move" onClick=${() => command("abort")}><${Icon} name="stop" /></button>
      <progress max=${now?.duration || 1} value=${now ? Math.max(now.at ?? 0, 0) : 0} aria-label="Progress of the move"></progress>
      <output class="time">${now ? clock(now.at ?? 0) : "00:00.00"}</output>
    </div>
    <div class="row options">
      ${!open && html`<label>Plays <select value=${what} onChange=${(/** @type {any} */ e) => (chosen.value = e.target.value)}>
        <option value="keys">keys from the hand</option>${playable.value.map((each) => html`<option value=${each.name}>${each.name}</option>`)}</select></label>`}
      <label>Speed <select value=${String(now?.speed ?? 1)} disabled=${off || !playing} onChange=${(/** @type {any} */ e) => command("speed", { share: Number(e.target.value) })}>
        ${speeds(now).map((share) => html`<option value=${String(share)}>${Math.round(100 * share)} %</option>`)}</select></label>
      <label>Preroll <${NumberField} min=${0} max=${60} value=${wait.value} set=${(/** @type {number} */ value) => {
        wait.value = value;
        localStorage.setItem(KEPT, String(wait.value));
      }} /> s</label>
      <label>Passes <${NumberField} min=${1} max=${999} value=${passes.value} set=${(/** @type {number} */ value) => (passes.value = Math.round(value))} /></label>
      <button aria-pressed=${loop.value} onClick=${() => (loop.value = !loop.value)}>Loop</button>
    </div>
    ${!compact && !!errors.value?.passes.length && html`<${Errors} of=${errors.value} />`}
    ${blocked && html`<p class="waits">${blocked}</p>`}
  </section>`;
}

/** The speeds on offer: within what the plan allows, and the one it has. @param {import("./types.js").MoveState|null} now */
const speeds = (now) => [...new Set([...SPEEDS.filter((share) => share <= (now?.max_speed ?? 2)), now?.speed ?? 1])].sort((a, b) => a - b);

/** @param {import("./types.js").MoveState|null} now */
function phase(now) {
  if (!now) return "";
  if (now.phase === "preroll" && (now.at ?? 0) < 0) return `starts in ${Math.ceil(-(now.at ?? 0))} s`;
  const pass = now.passes === 1 ? "" : `, pass ${now.pass}${now.passes ? ` of ${now.passes}` : ""}`;
  return `${now.phase}${now.key ? `, key ${now.key} of ${now.keys}` : ""}${pass}${now.why ? `: ${now.why}` : ""}`;
}

/** The error of each pass that is over, by axis. @param {{of: import("./types.js").PassErrors}} props */
function Errors({ of }) {
  const axes = Object.keys(of.passes[0].axes);
  return html`<table class="errors" data-testid="pass-errors"><caption>${of.title}: error, rms and largest</caption>
    <thead><tr><th scope="col">Pass</th>${axes.map((axis) => html`<th scope="col">${axis}</th>`)}</tr></thead>
    <tbody>${of.passes.map((each) => html`<tr><th scope="row">${each.pass}</th>${axes.map((axis) => html`<td>${figures(each.axes[axis])}</td>`)}</tr>`)}</tbody></table>`;
}

/** @param {{rms: number, peak: number}|undefined} error */
const figures = (error) => (error ? `${short(error.rms, 3)}, ${short(error.peak, 3)}` : "");
