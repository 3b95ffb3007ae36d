// What is always in view: STOP, who has control, how old everything is, and what the rig reports about itself.
import { html, useEffect, useSignal } from "./vendor/preact/preact.min.js";
import { command, stop, stopping } from "./connection.js";
import { age, fresh, hello, holder, link, mayOperate, mine, notice, part, roundTrip, state, tab } from "./store.js";
import { milliseconds, minutes, timeOfDay } from "./format.js";
import { commission } from "./commission.js";
import { gamepad } from "./gamepad.js";
import { clear, showHelp, Word } from "./keyboard.js";

export const TABS = [["live", "Live"], ["move", "Move"], ["shoot", "Shoot"], ["takes", "Takes"]];
const HANDOVER = 5; // s after which control passes to who asks
const LATE = 150, RAMPS = 250; // ms of age of a stick: shown, and at which the axes come to rest
const links = part((s) => s.links, {}), inputs = part((s) => s.inputs, []);
const missed = part((s) => s.sticks?.missed ?? 0, 0), stickAge = part((s) => s.sticks?.age_ms ?? null, null);
const stopped = part((s) => s.stopped, false), stoppedBy = part((s) => s.stopped_by, ""), stoppedAt = part((s) => s.stopped_at, null);
const recording = part((s) => s.recording, false), recordingTime = part((s) => Math.floor(s.recording_s ?? 0), 0);
const rig = part((s) => s.rig, ""), asking = part((s) => s.asking, null), camera = part((s) => s.camera, false);

/** A dot and a few words. @param {{tone?: string, name: string, children?: any, testid?: string, title?: string}} props */
const Chip = ({ tone = "", name, children, testid, title }) =>
  html`<span class="chip ${tone}" title=${title}><i class="dot" aria-hidden="true"></i>${name && html`<span>${name}</span>`}
    <b data-testid=${testid}>${children}</b></span>`;

export function Bar() {
  return html`<header class="bar"><h1 class="unseen">teleop console</h1>
    <div class="brand"><b>teleop</b><span>${rig.value || hello.value.rig}</span></div>
    ${!commission.value && html`<${Tabs} />`}
    <div class="chips"><${Control} /><div class="health" tabindex="0" role="group" aria-label="Health"><${Health} /></div></div>
    <${Stop} />
  </header>`;
}

function Stop() {
  const now = stopped.value;
  return html`<button class="stop ${stopping.value ? "sending" : ""}" data-testid="stop"
    onPointerDown=${(/** @type {PointerEvent} */ e) => e.button <= 0 && stop()} onClick=${stop}>
    <b>STOP</b><span class="unseen">all axes</span>${stopping.value ? html`<small>sending</small>` : now && html`<small>latched</small>`}
  </button>`;
}

function Control() {
  const who = holder.value, tone = !fresh.value ? "" : mine.value ? "good" : who ? "warn" : "";
  return html`<span class="control">
    <${Chip} tone=${tone} name="Control" testid="holder">${!who ? "free" : mine.value ? `${who} (you)` : who}<//>
    <${ControlButton} />
  </span>`;
}

function ControlButton() {
  const asked = useSignal(false);
  useEffect(() => void (asked.value = false), [holder.value]);
  if (!mayOperate.value) return html`<span class="chip"><b>watch only</b></span>`;
  if (mine.value) return html`<button class="small" data-testid="release-control" onClick=${() => command("release_control")}>Release</button>`;
  const held = !!holder.value;
  const take = async () => {
    const answer = await command("take_control", held ? { ask: true } : {});
    asked.value = held && !answer.error;
  };
  return html`<button class="small primary" data-testid="take-control" disabled=${!fresh.value || asked.value} onClick=${take}>
    ${asked.value ? "Asked" : held ? "Ask for control" : "Take control"}</button>`;
}

function Health() {
  const late = age.value !== null && age.value > 250;
  const trip = roundTrip.value, driven = !commission.value;
  return html`
    ${driven && html`<${Chip} tone=${late ? "bad" : "good"} name="Age" testid="age">${fresh.value ? milliseconds(age.value) : "--"}<//>`}
    <${Chip} tone=${trip.median === null ? "" : trip.median > 150 ? "warn" : "good"} name="Round trip" title="median and worst of the last 10 s">
      ${milliseconds(trip.median)} / ${milliseconds(trip.worst)}<//>
    ${Object.entries(links.value).map(([name, each]) => html`<${Chip} tone=${each.ok ? "good" : "bad"} name=${name}>${each.ok ? milliseconds(each.age_ms) : "no answer"}<//>`)}
    ${inputs.value.filter((each) => each.name !== "console" && each.name !== holder.value).map((each) => html`<${Input} each=${each} />`)}
    ${gamepad.value && html`<${Chip} tone=${["ready", "moves"].includes(gamepad.value) ? "good" : "warn"} name="Gamepad" testid="gamepad">${gamepad.value}<//>`}
    ${driven && html`<${StickChip} />`}
    ${camera.value && html`<${Chip} tone=${recording.value ? "rec" : ""} name="REC">${recording.value ? minutes(recordingTime.value) : "off"}<//>`}`;
}

/** The stick that has control, whoever holds it: how old its newest message is while it is held, and what was missed. */
function StickChip() {
  const old = stickAge.value, tone = old !== null && old > RAMPS ? "bad" : (old !== null && old > LATE) || missed.value ? "warn" : old !== null ? "good" : "";
  return html`<${Chip} tone=${tone} name="Stick" testid="stick-age" title="age of the newest message of the stick in control, and messages missed">
    ${old === null ? "" : `${milliseconds(old)}, `}${missed.value} missed<//>`;
}

/** An input of the rig's own: a joystick, keys. @param {{each: import("./types.js").InputState}} props */
function Input({ each }) {
  const why = (each.trouble || each.waits_for).replace(`${each.name}: `, ""), absent = why === "not plugged in";
  return html`<${Chip} tone=${absent ? "" : each.trouble ? "bad" : each.waits_for ? "warn" : "good"} name=${each.name} title=${why}>
    ${absent ? "none" : why || (each.drives.length ? each.drives.join(", ") : "ready")}<//>`;
}

function Tabs() {
  return html`<nav class="tabs" aria-label="Pages">${TABS.map(
    ([id, name]) => html`<button data-testid=${`tab-${id}`} aria-current=${tab.value === id ? "page" : undefined} onClick=${() => (tab.value = id)}>${name}</button>`,
  )}
    <button class="keys-help" aria-label="Keys of the keyboard" onClick=${showHelp}>?</button></nav>`;
}

/** Lines that need an eye or an answer: STOP, a request for control, a lost connection, what a command met. */
export function Banners() {
  return html`<div class="banners"><${Word} /><div role="status" aria-live="polite">
    ${link.value === "lost" && html`<p class="banner bad"><b>Connection lost</b><span>The rig has stopped what this page moved. Reconnecting as a watcher.</span></p>`}
    ${link.value === "late" && html`<p class="banner bad"><b>The rig does not answer</b><span>The last state is ${milliseconds(state.value?.age_ms ?? null)} old.</span></p>`}
    ${fresh.value && stopped.value && html`<${Stopped} />`}
    ${asking.value && mine.value && html`<${Asked} />`}
    ${notice.value && html`<p class="banner ${notice.value.kind === "error" ? "warn" : ""}"><span>${notice.value.text}</span></p>`}
  </div></div>`;
}

function Stopped() {
  if (commission.value)
    return html`<p class="banner bad"><b>STOPPED</b><span>${stoppedBy.value && `by ${stoppedBy.value} `}${stoppedAt.value ? `at ${timeOfDay(stoppedAt.value)}. ` : ". "}The next key goes on.</span></p>`;
  return html`<p class="banner bad"><b>STOPPED</b><span>${stoppedBy.value && `by ${stoppedBy.value} `}${stoppedAt.value ? `at ${timeOfDay(stoppedAt.value)}. ` : ". "}
    Clear it, then center all sticks.</span>
    <button data-testid="clear" disabled=${!mayOperate.value || (!mine.value && !!holder.value)} onClick=${clear}>Clear STOP</button></p>`;
}

function Asked() {
  const who = typeof asking.value === "string" ? asking.value : (asking.value.name ?? "another console");
  return html`<p class="banner warn"><b>${who} asks for control</b><span>It passes after ${HANDOVER} s without a no.</span>
    <button onClick=${() => command("deny_control")}>Keep control</button>
    <button onClick=${() => command("release_control")}>Hand over</button></p>`;
}
