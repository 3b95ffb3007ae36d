// The moves, takes and plans that the server has: requests and answers, and which move is chosen.
import { computed, signal } from "./vendor/preact/preact.min.js";
import { notify } from "./store.js";

/** @typedef {{name: string, title?: string, shipped?: boolean, kind?: string, problem?: string}} MoveName */
/** @type {import("./vendor/preact/preact.min.js").Signal<MoveName[]>} */
export const moves = signal([]);
/** The move that Play starts, "" for none. */
export const chosen = signal("");

/**
 * The JSON of a request; null after an error, which is shown.
 * @param {string} path @param {{method?: string, body?: any, quiet?: boolean}} [options] @returns {Promise<any>}
 */
export async function request(path, { method = "GET", body, quiet = false } = {}) {
  try {
    const answer = await fetch(path, {
      method, credentials: "same-origin", cache: "no-store",
      ...(body === undefined ? {} : { body: JSON.stringify(body), headers: { "content-type": "application/json" } }),
    });
    const json = await answer.json().catch(() => ({}));
    if (answer.ok) return json;
    if (!quiet) notify(json.error ?? `${path}: ${answer.status} ${answer.statusText}`, "error");
  } catch {
    if (!quiet) notify("no connection", "error");
  }
  return null;
}

/** Moves that play; timelapses are shot. */
export const playable = computed(() => moves.value.filter((each) => each.kind !== "timelapse" && !each.problem));
/** What is open or plays where nothing was chosen: a file of the folder before a shipped move. */
export const preferred = computed(() => chosen.value || (playable.value.find((each) => !each.shipped) ?? playable.value.find((each) => each.name === "reveal") ?? playable.value[0])?.name || "");

/** @param {string} name */
export const urlOf = (name) => `/api/moves/${encodeURIComponent(name)}`;

export async function listMoves() {
  const answer = await request("/api/moves", { quiet: true });
  if (answer) moves.value = answer.moves ?? answer;
}
