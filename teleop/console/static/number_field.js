// A number to type. What is being typed stays while the page renders again; it counts on Enter or when the field is left.
import { html, useSignal } from "./vendor/preact/preact.min.js";
import { short } from "./format.js";

/**
 * @param {{label?: string, value: number|null|undefined, set: (value: any) => void, step?: number, min?: number, max?: number, off?: boolean, empty?: boolean}} props
 *   with `empty`, an empty field is null; else it goes back to what it was
 */
export function NumberField({ label, value, set, step = 1, min, max, off = false, empty = false }) {
  const typed = useSignal(/** @type {string|null} */ (null));
  const take = (/** @type {any} */ event) => {
    const text = event.target.value.trim(), number = Number(text);
    typed.value = null;
    if (text === "" && empty) set(null);
    else if (text !== "" && Number.isFinite(number)) set(Math.min(Math.max(number, min ?? -Infinity), max ?? Infinity));
    else event.target.value = shown(value);
  };
  return html`<input type="number" step=${step} min=${min} max=${max} aria-label=${label} value=${typed.value ?? shown(value)} disabled=${off}
    onInput=${(/** @type {any} */ event) => (typed.value = event.target.value)} onChange=${take} onBlur=${() => (typed.value = null)} />`;
}

/** @param {number|null|undefined} value */
const shown = (value) => (typeof value === "number" ? short(value, 4) : "");
