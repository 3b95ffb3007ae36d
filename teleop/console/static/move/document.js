// The open move: its keyframes as they are edited, undo and redo, and the plan that the server makes of them.
import { batch, computed, signal } from "../vendor/preact/preact.min.js";
import { chosen, listMoves, request, urlOf } from "../moves.js";
import { contentWith, keyframesOf, planOf, whyFixed } from "./content.js";
import { notify } from "../store.js";

/**
 * @typedef {Object<string, any> & {at: number, hold?: number}} Keyframe positions by axis beside `at` and `hold`, in s
 * @typedef {{name: string, title: string, content: any, keyframes: Keyframe[], fixed: string, suggested?: string}} Doc
 *   `content` is all of the file, `fixed` why its keys cannot be edited, "" when they can
 * @typedef {{times: number[], position: number[], limits: (number|null)[], peak: number, fastest: number, unit: string}} Curve
 * @typedef {{axis: string, first: number|null, last: number|null, shortest: number|null, text: string}} Problem keys are counted from 1
 * @typedef {{duration: number, axes: Object<string, Curve>, problems: Problem[], warnings: string[], cues: {at: number, name: string}[],
 *   keys: {number: number, at: number, hold: number, axes: Object<string, number>}[], stale: boolean}} Plan `stale`: its curves are older than the keys
 */
const MOST_UNDO = 200;
const LEAST_GAP = 0.05; // s between two keys

/** @type {import("../vendor/preact/preact.min.js").Signal<Doc|null>} */
export const doc = signal(null);
/** @type {import("../vendor/preact/preact.min.js").Signal<Plan|null>} */
export const plan = signal(null);
export const planning = signal(false);
const past = signal(/** @type {Doc[]} */ ([])), future = signal(/** @type {Doc[]} */ ([]));
const saved = signal(/** @type {Doc|null} */ (null));
export const canUndo = computed(() => past.value.length > 0), canRedo = computed(() => future.value.length > 0);
export const unsaved = computed(() => doc.value !== null && doc.value !== saved.value);
/** The number of the key that the table and the curves show as selected, from 1; 0 for none. */
export const selected = signal(0);
export const axis = signal("pan");

/** @param {Doc} next @param {boolean} asSaved */
function show(next, asSaved) {
  batch(() => {
    doc.value = next;
    if (asSaved) saved.value = next;
    past.value = [];
    future.value = [];
    plan.value = null;
    selected.value = 0;
  });
  makePlan();
}

/** Opens a move of the folder. One that was picked is also what Play starts on the Live page. @param {string} name @param {boolean} [picked] */
export async function open(name, picked = false) {
  const found = await request(urlOf(name));
  if (!found) return;
  if (picked) chosen.value = name;
  version = found.version;
  show(docOf(name, found.content), true);
}

/** A new move, in no file until it is saved. @param {any} content @param {string} [name] */
export function openNew(content, name = "") {
  version = undefined;
  show({ ...docOf("", content), suggested: name }, false);
}

/** A move of the keys from the hand. @param {Keyframe[]} keyframes */
export const openKeys = (keyframes) => openNew({ title: "Keys from the hand", keyframes });

/** @param {string} name @param {any} content @returns {Doc} */
const docOf = (name, content) => ({ name, title: content?.title || name, content, keyframes: keyframesOf(content), fixed: whyFixed(content) });

/** Changes the keyframes: `change` gets a copy of them. @param {(keyframes: Keyframe[]) => Keyframe[]|void} change */
export function edit(change) {
  const old = doc.peek();
  if (!old || old.fixed) return;
  const keyframes = old.keyframes.map((key) => ({ ...key }));
  const next = { ...old, keyframes: change(keyframes) ?? keyframes };
  batch(() => {
    past.value = [...past.value.slice(1 - MOST_UNDO), old];
    future.value = [];
    doc.value = next;
  });
  makePlan();
}

/** @param {typeof past} from @param {typeof past} to */
function step(from, to) {
  const old = doc.peek(), next = from.peek().at(-1);
  if (!old || !next) return;
  batch(() => {
    from.value = from.value.slice(0, -1);
    to.value = [...to.value, old];
    doc.value = next;
  });
  makePlan();
}
export const undo = () => step(past, future);
export const redo = () => step(future, past);

let asked = 0;
/** Of the file as it was read, so that nobody's later changes are overwritten. @type {string|undefined} */
let version;

/** The values of the file as they are now. @param {Doc} now */
const contentOf = (now) => (now.fixed ? now.content : contentWith(now.content, now.keyframes));

/** Asks the planner; the answer to an older question is dropped. */
async function makePlan() {
  const number = ++asked, now = doc.peek();
  if (!now) return;
  planning.value = true;
  const found = await request("/api/plan", { method: "POST", body: now.content ? { content: contentOf(now) } : { move: now.name } });
  if (number !== asked) return;
  batch(() => {
    planning.value = false;
    if (found) plan.value = planOf(found, plan.peek());
  });
}

/** @param {string} name */
export async function save(name) {
  const now = doc.peek();
  if (!now) return false;
  const answer = await request(urlOf(name), { method: "PUT", body: { content: contentOf(now), ...(version ? { version } : {}) } });
  if (!answer) return false;
  version = answer.version;
  batch(() => {
    const named = { ...now, name };
    doc.value = saved.value = named;
    chosen.value = name;
  });
  notify(`${name} saved`);
  listMoves();
  return true;
}

/** Where a key may be in time: between its neighbors. @param {number} index @returns {[number, number]} */
export function room(index) {
  const keys = /** @type {Doc} */ (doc.peek()).keyframes, before = keys[index - 1], after = keys[index + 1];
  return [before ? before.at + (before.hold ?? 0) + LEAST_GAP : 0, after ? after.at - (keys[index].hold ?? 0) - LEAST_GAP : 86_400];
}

/** Later keys and cues move on, so that a problem's segment has the time that it needs. @param {Problem} problem */
export function stretch({ first, last, shortest }) {
  edit((keys) => {
    const from = keys[(first ?? 0) - 1], to = keys[(last ?? 0) - 1];
    if (!from || !to || last === null || shortest === null) return;
    const more = from.at + (from.hold ?? 0) + shortest - to.at;
    for (const key of keys.slice(last - 1)) key.at = Math.ceil((key.at + more) * 1000 - 1e-6) / 1000;
  });
}

/** A key at a time, where the plan is then. @param {number} at */
export function insert(at) {
  const positions = positionsAt(at);
  edit((keys) => [...keys, { at: Math.round(at * 100) / 100, ...positions }].sort((a, b) => a.at - b.at));
}

/** @param {number} at @returns {Object<string, number>} */
export function positionsAt(at) {
  const curves = plan.peek()?.axes ?? {};
  return Object.fromEntries(Object.entries(curves).map(([name, curve]) => [name, Math.round(valueAt(curve, at) * 1000) / 1000]));
}

/** @param {Curve} curve @param {number} at */
export function valueAt({ times, position }, at) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= at) low = middle;
    else high = middle;
  }
  const span = times[high] - times[low], share = span > 0 ? Math.min(Math.max((at - times[low]) / span, 0), 1) : 1;
  return position[low] + share * (position[high] - position[low]);
}
