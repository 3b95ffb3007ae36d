// What the rig reports, as signals. Nothing here is guessed: a value changes only when a state from the server changes it.
import { batch, computed, signal } from "./vendor/preact/preact.min.js";

/** @typedef {import("./types.js").State} State */

/** @type {import("./vendor/preact/preact.min.js").Signal<State|null>} */
export const state = signal(null);
/** "connecting" before the first state, "live", "late" while the rig is silent but the server is not, "lost". */
export const link = signal("connecting");
export const hello = signal({ role: "watch", session: "", name: "", rig: "" });
export const roundTrip = signal({ median: /** @type {number|null} */ (null), worst: /** @type {number|null} */ (null) });
/** @type {import("./vendor/preact/preact.min.js").Signal<{text: string, kind: string}|null>} */
export const notice = signal(null);
/** How long ago the newest reading of a position was made, in ms, as of now. */
export const age = signal(/** @type {number|null} */ (null));
export const tab = signal("live");

/** A part of the state that renders again only when it changes; a merge patch leaves out what is null. @template T @param {(s: State) => T|undefined} part @param {T} none @returns {import("./vendor/preact/preact.min.js").ReadonlySignal<T>} */
export const part = (part, none) => computed(() => (state.value ? (part(state.value) ?? none) : none));

const names = computed(() => Object.keys(state.value?.axes ?? {}).filter((name) => !name.startsWith("stick_")).join());
/** The names of the axes as one list that stays the same object while they are the same. */
export const axes = computed(() => names.value.split(",").filter(Boolean));
export const holder = part((s) => s.holder, null);
export const mine = computed(() => !!state.value?.holder_session && state.value.holder_session === hello.value.session);
export const mayOperate = computed(() => hello.value.role === "operate");
export const fresh = computed(() => link.value === "live");
/** Whether this page has control of a rig that answers. */
export const inControl = computed(() => fresh.value && mine.value);
/** Whether a button that moves something can be pressed now. */
export const able = computed(() => inControl.value && !state.value?.stopped);

/** The RFC 7396 merge of `changes` into `target`; parts that do not change stay the same objects. @param {any} target @param {any} changes @returns {any} */
export function merged(target, changes) {
  if (changes === null || typeof changes !== "object" || Array.isArray(changes)) return changes;
  const result = target && typeof target === "object" && !Array.isArray(target) ? { ...target } : {};
  for (const [key, value] of Object.entries(changes)) {
    if (value === null) delete result[key];
    else result[key] = merged(result[key], value);
  }
  return result;
}

let noticeTimer = 0;
/** Shows one line for a while. @param {string} text @param {"info"|"error"} kind */
export function notify(text, kind = "info") {
  clearTimeout(noticeTimer);
  notice.value = { text, kind };
  noticeTimer = window.setTimeout(() => (notice.value = null), kind === "error" ? 8000 : 4000);
}

/** @param {State} next @param {number|null} measuredAge */
export function show(next, measuredAge) {
  batch(() => {
    state.value = next;
    age.value = measuredAge;
  });
}
