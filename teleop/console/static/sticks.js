// Two touch sticks. A stick follows one pointer from pointerdown until any event that ends it, and is centered at once then.
import { html, useEffect, useRef, useSignal } from "./vendor/preact/preact.min.js";
import { Icon } from "./icons.js";
import { able, axes, fresh, mine, notify, part, state } from "./store.js";
import { hold, onReleased, release } from "./stick_stream.js";

const LOCKS = ["free", "across", "along", "locked"];
const LOCK_NAMES = { free: "both axes", across: "only left and right", along: "only up and down", locked: "locked" };
const sticks = part((s) => s.sticks, null);
const STEP = 0.25; // of the range, by an arrow key

/** @param {{x: string, y: string, testid: string, side: string}} props the axes across and along */
export function Stick({ x, y, testid, side }) {
  const at = useSignal({ x: 0, y: 0 }), held = useSignal(false), lock = useSignal("free");
  const disc = useRef(/** @type {HTMLElement|null} */ (null)), pointer = useRef(/** @type {number|null} */ (null));
  const center = () => {
    pointer.current = null;
    held.value = false;
    at.value = { x: 0, y: 0 };
  };
  useEffect(() => onReleased(center), []);
  useEffect(() => () => release(testid), []);
  const has = axes.value.filter((axis) => axis === x || axis === y);
  if (!has.length) return null;

  /** @param {number} dx @param {number} dy */
  const deflect = (dx, dy) => {
    const size = Math.hypot(dx, dy), k = size > 1 ? 1 / size : 1;
    const across = lock.value === "along" || !has.includes(x) ? 0 : dx * k, along = lock.value === "across" || !has.includes(y) ? 0 : dy * k;
    at.value = { x: across, y: along };
    hold(testid, { ...(has.includes(x) && { [x]: round(across) }), ...(has.includes(y) && { [y]: round(along) }) });
  };
  /** @param {PointerEvent} event */
  const follow = (event) => {
    const box = /** @type {HTMLElement} */ (disc.current).getBoundingClientRect(), reach = 0.36 * box.width;
    deflect((event.clientX - box.left - box.width / 2) / reach, -(event.clientY - box.top - box.height / 2) / reach);
  };
  /** @param {PointerEvent} event */
  const down = (event) => {
    if (pointer.current !== null || event.button > 0) return;
    if (lock.value === "locked") return notify("this stick is locked: tap its lock");
    if (!able.value) return notify(whyNot());
    event.preventDefault();
    pointer.current = event.pointerId;
    held.value = true;
    /** @type {HTMLElement} */ (event.currentTarget).setPointerCapture(event.pointerId);
    deflect(0, 0); // the rig sees the stick centered first
    follow(event);
  };
  /** @param {PointerEvent} event */
  const move = (event) => event.pointerId === pointer.current && follow(event);
  /** @param {PointerEvent} event */
  const end = (event) => {
    if (event.pointerId !== pointer.current) return;
    center();
    release(testid);
  };
  const keys = keyHandlers(deflect, () => (center(), release(testid)), lock);
  const size = 50 + 36 * at.value.x, height = 50 - 36 * at.value.y;
  return html`<div class="stick ${side} ${held.value ? "held" : ""} ${able.value ? "" : "off"}">
    <div class="disc" ref=${disc} data-testid=${testid} role="application" tabindex="0" aria-label=${`Stick ${x} and ${y}: hold an arrow key or drag`}
      aria-disabled=${!able.value} onPointerDown=${down} onPointerMove=${move} onPointerUp=${end} onPointerCancel=${end}
      onLostPointerCapture=${end} onContextMenu=${(/** @type {Event} */ e) => e.preventDefault()} ...${keys}>
      <svg viewBox="0 0 100 100" aria-hidden="true">
        <circle class="rim" cx="50" cy="50" r="49" /><circle class="reach" cx="50" cy="50" r="36" />
        <path class="cross" d="M50 14V86M14 50H86" /><line class="arm" x1="50" y1="50" x2=${size} y2=${height} />
        <circle class="knob" cx=${size} cy=${height} r="18" />
      </svg>
      <span class="names"><b class=${`ink-${x}`}>${x}</b> / <b class=${`ink-${y}`}>${y}</b></span>
    </div>
    <button class="lock small" aria-label=${`Lock of stick ${x} and ${y}: ${LOCK_NAMES[/** @type {"free"} */ (lock.value)]}`}
      title=${LOCK_NAMES[/** @type {"free"} */ (lock.value)]}
      onClick=${() => (lock.value = LOCKS[(LOCKS.indexOf(lock.value) + 1) % LOCKS.length])}><${Icon} name=${lock.value} /></button>
  </div>`;
}

/** Arrow keys hold the stick at a quarter, with shift at full, until they are let go. */
function keyHandlers(/** @type {(x: number, y: number) => void} */ deflect, /** @type {() => void} */ let_go, /** @type {{value: string}} */ lock) {
  /** @type {Record<string, [number, number]>} */
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  return {
    onKeyDown: (/** @type {KeyboardEvent} */ event) => {
      const way = ways[event.key];
      if (!way) return;
      event.preventDefault();
      event.stopPropagation();
      if (!able.value || lock.value === "locked") return notify(whyNot());
      if (event.repeat) return;
      const share = event.shiftKey ? 1 : STEP;
      deflect(way[0] * share, way[1] * share);
    },
    onKeyUp: (/** @type {KeyboardEvent} */ event) => ways[event.key] && let_go(),
    onBlur: let_go,
  };
}

/** Why a stick moves nothing now, in a line. */
function whyNot() {
  if (!fresh.value) return "no connection to the rig";
  if (state.value?.stopped) return "stopped: clear STOP first";
  if (!mine.value) return state.value?.holder ? `${state.value.holder} has control: ask for it first` : "take control first";
  return "this stick is locked";
}

/** @param {number} value */
const round = (value) => Math.round(value * 1000) / 1000;

export function StickState() {
  const now = sticks.value;
  if (!mine.value || !now || now.armed || !now.waits_for) return null;
  return html`<p class="waits">${now.waits_for}</p>`;
}
