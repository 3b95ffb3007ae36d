// The Shoot page: a timelapse frame by frame, when it ends, and what it missed.
import { html, useEffect, useSignal } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, inControl, notify, part } from "./store.js";
import { clock, short, timeOfDay } from "./format.js";
import { moves, request, urlOf } from "./moves.js";
import { seconds } from "./move/content.js";

const shoot = part((s) => s.shoot, null);
const battery = part((s) => s.battery, null);
/** What the journal of a shoot that was ended before needs to be told. */
const UNFINISHED = /"resume": true/;

export function Shoot() {
  return html`<main class="shoot" aria-label="Shoot">${shoot.value ? html`<${Running} now=${shoot.value} />` : html`<${Start} />`}</main>`;
}

function Start() {
  const name = useSignal(""), list = moves.value.filter((each) => each.kind === "timelapse" && !each.problem), what = name.value || list[0]?.name;
  const left = useSignal(""), busy = useSignal(false);
  const start = async (/** @type {Object<string, boolean>} */ how = {}) => {
    busy.value = true;
    const answer = await command("shoot", { move: what, ...how }, { quiet: true });
    busy.value = false;
    left.value = UNFINISHED.test(answer?.error ?? "") ? String(answer?.error).split(": continue with")[0] : "";
    if (answer?.error && !left.value) notify(answer.error, "error");
  };
  const off = !able.value || busy.value || !what;
  return html`<section class="card start"><h2>Shoot a timelapse</h2>
    <p>Each frame is due at its time: the rig goes there, settles, and the camera shoots. A shoot goes on when this page is closed.</p>
    ${list.length === 0 ? html`<p class="waits">There is no timelapse in the folder. Copy the shipped one: <code>teleop copy day-to-night mine.yaml</code></p>`
      : html`<div class="row"><label>Timelapse <select value=${what} onChange=${(/** @type {any} */ e) => { name.value = e.target.value; left.value = ""; }}>${list.map((each) => html`<option value=${each.name}>${each.name}${each.shipped ? " (shipped)" : ""}</option>`)}</select></label>
        <button class="primary" data-testid="shoot-start" disabled=${off} onClick=${() => start()}>Start the shoot</button></div>`}
    ${left.value && html`<p class="waits">${left.value}</p><div class="row"><button class="primary" data-testid="shoot-resume" disabled=${off} onClick=${() => start({ resume: true })}>Go on with it</button>
      <button data-testid="shoot-restart" disabled=${off} onClick=${() => start({ restart: true })}>Start over</button></div>`}
    ${battery.value !== null && html`<dl class="facts"><${Battery} /></dl>`}
  </section>`;
}

/** The battery, where a device reports it. */
const Battery = () => battery.value !== null && html`<${Fact} name="Battery" value=${`${Math.round(battery.value)} %`} bad=${battery.value < 20} />`;

/** The interval over a shoot as its file has it: one number, or from one to another. @param {any} content */
function intervalsOf(content) {
  const interval = content?.timelapse?.interval;
  if (interval && typeof interval === "object") return [interval.from, interval.to].map((each) => seconds(each, content.fps) ?? 0);
  const each = seconds(interval, content?.fps);
  return each ? [each, each] : [];
}

/** @param {{now: import("./types.js").ShootState}} props */
function Running({ now }) {
  const intervals = useSignal(/** @type {number[]} */ ([])), file = moves.value.find((each) => each.kind === "timelapse" && each.title === now.title)?.name;
  useEffect(() => {
    if (file) request(urlOf(file), { quiet: true }).then((found) => (intervals.value = intervalsOf(found?.content)));
  }, [file]);
  const left = Math.max(now.frames - now.frames_done, 0), off = !inControl.value;
  return html`<section class="card frames"><h2>Frames</h2>
      <p class="huge"><b>${now.frames_done}</b> of ${now.frames}</p>
      <progress max=${now.frames || 1} value=${now.frames_done} aria-label="Frames done"></progress>
      <div class="row"><button data-testid="shoot-pause" disabled=${off} onClick=${() => command(now.paused ? "resume" : "pause")}>${now.paused ? "Resume" : "Pause between frames"}</button>
        <button disabled=${off} onClick=${() => command("abort")}>End the shoot</button>${now.paused && html`<span class="waits">paused: no frame is shot</span>`}</div>
      ${now.why && html`<p class="waits">${now.why}</p>`}</section>
    <section class="card facts"><h2>Shoot</h2><dl>
      <${Fact} name="Ends at" value=${timeOfDay(now.eta)} />
      <${Fact} name="Frames left" value=${left} />
      ${now.phase && html`<${Fact} name="Now" value=${now.phase} />`}
      ${typeof now.clip_s === "number" && html`<${Fact} name="Clip" value=${clock(now.clip_s)} />`}
      <${Fact} name="Missed slots" value=${now.missed} bad=${now.missed > 0} />
      ${typeof now.interval === "number" && html`<${Fact} name="Interval" value=${`${short(now.interval, 1)} s`} />`}
      <${Battery} /></dl></section>
    ${intervals.value.length > 1 && html`<${Intervals} values=${intervals.value} done=${now.frames_done / (now.frames || 1)} />`}`;
}

/** @param {{name: string, value: any, bad?: boolean}} props */
const Fact = ({ name, value, bad = false }) => html`<div class=${bad ? "bad" : ""}><dt>${name}</dt><dd>${value}</dd></div>`;

/** The interval over the shoot, and how far it is. @param {{values: number[], done: number}} props */
function Intervals({ values, done }) {
  const high = Math.max(...values) * 1.1, x = (/** @type {number} */ n) => (100 * n) / (values.length - 1), y = (/** @type {number} */ v) => 40 - (40 * v) / high;
  return html`<section class="card intervals"><h2>Interval <span>${short(values[0], 1)} s to ${short(values[values.length - 1], 1)} s</span></h2>
    <svg viewBox="0 0 100 40" preserveAspectRatio="none" role="img" aria-label="Interval over the shoot">
      <path class="curve" d=${`M${values.map((v, n) => `${x(n).toFixed(2)} ${y(v).toFixed(2)}`).join("L")}`} /><path class="done" d=${`M${(100 * done).toFixed(2)} 0V40`} /></svg></section>`;
}
