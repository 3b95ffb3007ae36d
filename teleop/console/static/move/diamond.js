// A key of one axis: a native slider of its value, drawn as a diamond, which a pointer drags in time as well.
import { html, useRef } from "../vendor/preact/preact.min.js";
import { short } from "../format.js";
import { axis as chosenAxis, doc, edit, room, selected } from "./document.js";
import { isShare } from "./scale.js";

const NEAR = 4; // px that a press may move and still be a click
const STEP = { deg: 0.1, share: 0.001 }, TIME_STEP = 0.01; // what a drag snaps to

/** @param {string} name */
const stepOf = (name) => (isShare(name) ? STEP.share : STEP.deg);
/** @param {number} value @param {number} step */
const snapped = (value, step) => Number((Math.round(value / step) * step).toFixed(4));

/**
 * @param {{name: string, index: number, keyframe: import("./document.js").Keyframe, scale: import("./scale.js").Scale, drag: {value: any},
 *   drop: () => void, box: {current: HTMLElement|null}}} props
 */
export function Diamond({ name, index, keyframe, scale, drag, drop, box }) {
  const begun = useRef(/** @type {{x: number, y: number}|null} */ (null));
  const mine = drag.value?.axis === name && drag.value?.index === index ? drag.value : null;
  const held = drag.value?.index === index, value = mine ? mine.value : keyframe[name], at = held ? drag.value.at : keyframe.at;
  const [low, high] = name === "focus" ? [0, 1] : [-100_000, 100_000];
  const fixed = !!doc.value?.fixed;
  const down = (/** @type {PointerEvent} */ event) => {
    if (event.button > 0 || fixed) return;
    event.preventDefault();
    const target = /** @type {HTMLElement} */ (event.currentTarget);
    target.focus();
    target.setPointerCapture(event.pointerId);
    begun.current = { x: event.clientX, y: event.clientY };
    chosenAxis.value = name;
    selected.value = index + 1;
  };
  const move = (/** @type {PointerEvent} */ event) => {
    if (!begun.current || (!drag.value && Math.hypot(event.clientX - begun.current.x, event.clientY - begun.current.y) < NEAR)) return;
    const frame = /** @type {HTMLElement} */ (box.current).getBoundingClientRect(), [earliest, latest] = room(index);
    const time = scale.time(event.clientX - frame.left), height = scale.value(name, event.clientY - frame.top);
    drag.value = {
      axis: name, index,
      at: snapped(Math.min(Math.max(time, earliest), latest), TIME_STEP),
      value: snapped(name === "focus" ? Math.min(Math.max(height, 0), 1) : height, stepOf(name)),
    };
  };
  const up = () => {
    if (begun.current && drag.value) drop();
    begun.current = null;
  };
  const cancel = () => {
    begun.current = null;
    drag.value = null;
  };
  const typed = (/** @type {any} */ event) => edit((keys) => void (keys[index][name] = Number(event.target.value)));
  const keys = (/** @type {KeyboardEvent} */ event) => {
    const big = event.shiftKey ? 10 : 1, time = { ArrowLeft: -0.1, ArrowRight: 0.1 }[event.key], rise = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (time === undefined && rise === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const [earliest, latest] = room(index), step = name === "focus" ? 0.01 : 1;
    edit((list) => {
      if (time !== undefined) list[index].at = snapped(Math.min(Math.max(list[index].at + time * big, earliest), latest), TIME_STEP);
      if (rise !== undefined) list[index][name] = snapped(list[index][name] + rise * step * big, stepOf(name));
    });
  };
  return html`<input type="range" class=${`diamond ink-${name} ${chosenAxis.value === name ? "chosen" : ""} ${selected.value === index + 1 ? "selected" : ""}`}
    data-testid=${`key-${name}-${index + 1}`} min=${low} max=${high} step="any" value=${value} disabled=${fixed}
    aria-label=${`Key ${index + 1} of ${name}`} aria-valuetext=${`${short(value, 3)} at ${short(at, 2)} s`}
    style=${{ left: `${scale.x(at)}px`, top: `${scale.y(name, value)}px` }}
    onPointerDown=${down} onPointerMove=${move} onPointerUp=${up} onPointerCancel=${cancel} onLostPointerCapture=${up}
    onFocus=${() => ((chosenAxis.value = name), (selected.value = index + 1))} onChange=${typed} onKeyDown=${keys} />`;
}
