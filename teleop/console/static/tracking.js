// The tracking sources of the rig: a button for each that has the camera follow it, and how that goes.
import { html } from "./vendor/preact/preact.min.js";
import { command } from "./connection.js";
import { able, inControl, notify, part } from "./store.js";

const tracking = part((s) => s.tracking, null);

/** Follows that source; what is followed already, or 0, ends it. @param {number} source */
export function track(source) {
  const now = tracking.peek()?.follows ?? 0;
  if (source && source !== now) command("track", { source });
  else if (now) command("abort");
  else notify("track: no source is followed");
}

export function Tracking() {
  const now = tracking.value;
  if (!now) return null;
  return html`${Object.entries(now.sources).map(([number, source]) => {
    const followed = now.follows === Number(number), arrives = typeof source.age_ms === "number";
    const word = followed ? now.why || "followed" : arrives ? "ready" : "no messages";
    return html`<span class="tracker"><button data-testid=${`track-${number}`} aria-pressed=${followed} title=${source.name}
        disabled=${followed ? !inControl.value : !able.value || !arrives} onClick=${() => track(Number(number))}>Follow tracker ${number}</button>
      <span class=${followed && now.why ? "waits" : "word"} data-testid=${`tracking-${number}`}>${word}</span></span>`;
  })}`;
}
