// The other rigs of a fleet: a tile for each with its state, and STOP ALL for everybody who is logged in.
import { html, useEffect, signal } from "./vendor/preact/preact.min.js";

/** @typedef {{name: string, alive: boolean, state: string, holder: string?, error: string?, move: {title: string, at: number?}?, link_age_ms: number?}} Rig */
const EVERY = 200, ALONE = 5000; // ms between two looks: at a fleet, and where there is none
const LOST = 400, SOONEST = 30; // ms of silence that make a rig lost, and between two looks at least
const MANY = 8; // rigs, above which those that something is wrong with come first
const PATIENCE = 1000; // ms for an answer, after which nothing is known
const rigs = signal(/** @type {Rig[]} */ ([])), own = signal(""), told = signal("");

async function look() {
  const answer = await fetch("/api/fleet", { cache: "no-store", signal: AbortSignal.timeout(PATIENCE) }).catch(() => null);
  const found = answer?.ok ? await answer.json().catch(() => null) : null;
  if (found) [rigs.value, own.value] = [found.rigs ?? [], found.name ?? ""];
  else rigs.value = rigs.value.map((rig) => ({ ...rig, alive: false, state: "unknown" }));
}

/** ms to the next look: where a rig is silent, when it would be lost. */
function pause() {
  if (rigs.value.length < 2) return ALONE;
  const silence = Math.max(0, ...rigs.value.map((rig) => (rig.alive ? rig.link_age_ms ?? 0 : 0)));
  return Math.max(SOONEST, Math.min(EVERY, LOST - silence));
}

export async function stopAll() {
  told.value = "STOP is sent to all rigs";
  const answer = await fetch("/api/fleet/stop", { method: "POST", keepalive: true }).catch(() => null);
  const found = answer ? await answer.json().catch(() => null) : null;
  if (!found) told.value = "STOP ALL: no answer. Switch the rigs off.";
  else if (found.ok) told.value = "";
  else told.value = found.not_reached ? `NOT REACHED: ${found.not_reached.join(", ")}. Switch them off.` : found.error;
}

/** @param {Rig} rig */
const well = (rig) => rig.alive && rig.state !== "stopped" && !rig.error;

function ordered() {
  return rigs.value.length > MANY ? [...rigs.value].sort((a, b) => Number(well(a)) - Number(well(b))) : rigs.value;
}

/** Nothing for a rig that is alone. */
export function FleetTiles() {
  useEffect(() => {
    let timer = 0, over = false;
    const again = () => look().then(() => {
      if (!over) timer = setTimeout(again, pause());
    });
    again();
    return () => {
      over = true;
      clearTimeout(timer);
    };
  }, []);
  if (rigs.value.length < 2) return null;
  return html`<section class="fleet" aria-label="Fleet" data-testid="fleet">
    <ul tabindex="0" aria-label="Rigs">${ordered().map((rig) => html`<${FleetTile} key=${rig.name} rig=${rig} />`)}</ul>
    <button class="stop-all" data-testid="stop-all" onClick=${stopAll}>STOP ALL</button>
    ${told.value && html`<p role="alert" data-testid="fleet-told">${told.value}</p>`}
  </section>`;
}

/** @param {{rig: Rig}} props */
function FleetTile({ rig }) {
  const what = [rig.holder && `by ${rig.holder}`, rig.move && rig.move.title, rig.error].filter(Boolean).join(" · ");
  return html`<li class=${`fleet-tile is-${rig.state}`} data-testid=${`fleet-${rig.name}`}>
    <b>${rig.name}${rig.name === own.value ? " (here)" : ""}</b> <span class="fleet-state">${rig.state}</span> <small>${what}</small>
  </li>`;
}
