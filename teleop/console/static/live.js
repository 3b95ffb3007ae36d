// The Live page: where everything is, and every way to move it by hand.
import { html, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, axes, inControl, mayOperate, part, state } from "./store.js";
import { position, short, sign, signed } from "./format.js";
import { Attitude, DEFAULT_FOV } from "./attitude.js";
import { StripChart } from "./chart.js";
import { FocusCard } from "./focus.js";
import { Keys } from "./keys.js";
import { Presets } from "./presets.js";
import { Stick, StickState } from "./sticks.js";
import { Tracking } from "./tracking.js";
import { Transport } from "./transport.js";

const ranges = part((s) => s.ranges, []), range = part((s) => s.range, 0), follow = part((s) => s.follow, "");
const recording = part((s) => s.recording, false), camera = part((s) => s.camera, false);
const newest = part((s) => s.messages?.[0]?.text ?? "", "");
const commissions = part((s) => s.commissions, /** @type {string[]} */ ([]));
const MODES = ["lock", "yaw", "sport"];
/** s within which a jog of so many units has to be done; the rig may need longer and then stops short */
const JOGS = [[0.1, 0.5], [1, 1], [10, 3]];
const FOCUS_SHARE = 0.01; // what one unit of a jog is for the focus, as on the terminal's keys

export function Live() {
  return html`<main class="live" aria-label="Live">
    <div class="live-row where"><${Readouts} /><${StripChart} /><${AttitudeCard} /></div>
    <div class="live-row places"><${JogCard} /><${Presets} /><${Keys} /><${FocusCard} /></div>
    <div class="live-row hands">
      <div class="dock"><${Stick} x="pan" y="tilt" testid="stick-pan-tilt" side="left" /><${Stick} x="roll" y="focus" testid="stick-roll-focus" side="right" /></div>
      <div class="center"><${StickCard} /><${Transport} compact=${true} /></div>
    </div>
  </main>`;
}

function Readouts() {
  return html`<section class="card readouts"><h2>Position</h2><dl>${axes.value.map((name) => html`<${Readout} name=${name} key=${name} />`)}</dl></section>`;
}

/** @param {{name: string}} props */
function Readout({ name }) {
  const axis = state.value?.axes[name];
  if (!axis) return null;
  const unit = sign(axis.unit), old = (axis.measured_age_ms ?? 0) > 250;
  return html`<div class="readout ${old ? "old" : ""}">
    <dt class=${`ink-${name}`}>${name}</dt>
    <dd><b class="measured"><span data-testid=${`measured-${name}`}>${position(axis.measured, axis.unit)}</span><i>${unit}</i></b>
      <span class="small-line"><span title="commanded">→ <span data-testid=${`commanded-${name}`}>${position(axis.commanded, axis.unit)}</span>${unit}</span>
        <span title="speed">${signed(axis.speed, axis.unit ? 1 : 2)}${unit}/s</span></span></dd>
  </div>`;
}

function AttitudeCard() {
  const s = state.value, at = (/** @type {string} */ name) => s?.axes[name]?.measured ?? 0;
  const fov = s?.fov ?? DEFAULT_FOV;
  return html`<section class="card camera"><h2>Camera <span>${short(fov[0], 0)}° × ${short(fov[1], 0)}°</span>
      ${commissions.value.map((device) => html`<${Start} device=${device} off=${!able.value} />`)}</h2>
    <${Attitude} pan=${at("pan")} tilt=${at("tilt")} roll=${at("roll")} fov=${fov}
      label=${`The camera looks at pan ${Math.round(at("pan"))}, tilt ${Math.round(at("tilt"))}, roll ${Math.round(at("roll"))} degrees`} /></section>`;
}

function JogCard() {
  const size = useSignal(1);
  const jog = (/** @type {string} */ axis, /** @type {number} */ way) => {
    const [by, within] = JOGS[size.value];
    command("jog", { axis, by: way * by * (state.value?.axes[axis]?.unit === "deg" ? 1 : FOCUS_SHARE), within });
  };
  return html`<section class="card jog"><h2>Jog
    <div class="segments small" role="group" aria-label="Size of a jog">${JOGS.map(
      ([by], n) => html`<button aria-pressed=${size.value === n} aria-label=${`Jog by ${by} degrees, or ${by} percent of focus`} onClick=${() => (size.value = n)}>${by}°</button>`)}</div></h2>
    <div class="jogs">${axes.value.map((name) => html`<div class="jog-row"><span class=${`ink-${name}`}>${name}</span>
      <button disabled=${!able.value} aria-label=${`Jog ${name} down`} onClick=${() => jog(name, -1)}>−</button>
      <button disabled=${!able.value} aria-label=${`Jog ${name} up`} onClick=${() => jog(name, 1)}>+</button></div>`)}</div>
  </section>`;
}

/** The way to a commissioning: the run ends for it, so it asks once more. @param {{device: string, off: boolean}} props */
function Start({ device, off }) {
  const asked = useSignal(false), id = device === "gimbal" ? "commission-start" : `commission-start-${device}`;
  if (!asked.value) return html`<button class="small" disabled=${off} data-testid=${id} onClick=${() => (asked.value = true)}>Commission the ${device}</button>`;
  return html`<span class="row"><span>This run ends for it.</span>
    <button class="small primary" disabled=${off} data-testid=${`${id}-yes`} onClick=${() => ((asked.value = false), command("commission", { device }))}>Begin</button>
    <button class="small" onClick=${() => (asked.value = false)}>Cancel</button></span>`;
}

/** What belongs to the sticks: their speed, and the camera's and gimbal's buttons. */
function StickCard() {
  const off = !able.value;
  return html`<section class="card tools" aria-label="Speed and camera">
    <div class="segments" role="group" aria-label="Speed range">${ranges.value.map(
      (share, n) => html`<button disabled=${!inControl.value} aria-pressed=${range.value === n + 1} aria-label=${`Speed ${Math.round(100 * share)} percent`}
        onClick=${() => command("range", { number: n + 1 })}>${Math.round(100 * share)} %</button>`)}</div>
    <div class="segments" role="group" aria-label="Follow mode">${MODES.map(
      (mode) => html`<button disabled=${off} aria-pressed=${follow.value === mode} onClick=${() => command("follow", { mode })}>${mode}</button>`)}</div>
    <button disabled=${off} onClick=${() => command("recenter")}>Recenter</button>
    ${camera.value && html`<button class="record ${recording.value ? "on" : ""}" disabled=${!mayOperate.value || !inControl.value}
      onClick=${() => command(recording.value ? "stop_recording" : "record")}><i aria-hidden="true"></i>${recording.value ? "Stop recording" : "Record"}</button>
    <button disabled=${!inControl.value} onClick=${() => command("shutter")}>Shutter</button>`}
    <${Tracking} />
    <${StickState} />
    ${newest.value && html`<p class="newest" role="log" aria-label="Newest message" title=${newest.value}>${newest.value}</p>`}
  </section>`;
}
