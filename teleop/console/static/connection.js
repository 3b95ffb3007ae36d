// The WebSocket: states in, commands out. A gap of a second in the states means "lost": everything is gray, every stick is
// released, and the page comes back as a watcher.
import { batch, signal } from "./vendor/preact/preact.min.js";
import { hello, link, merged, notify, roundTrip, show } from "./store.js";

const GAP = 1000; // ms without a state until the connection counts as lost
const PING = 500, WINDOW = 10_000; // ms between two pings, and of those that the shown round trip is of
const RETRY = [300, 600, 1200, 2500]; // ms until the next attempt
const MOST_WAITING = 100; // commands whose end is still to come
const STOP_REPEAT = 100, STOP_LONGEST = 10_000; // ms

/** @type {WebSocket|null} */
let socket = null;
let attempts = 0, lastState = 0, lastWatch = 0, nextId = 1;
/** @type {any} */
let whole = null;
/** @type {Map<number, {answer: (a: any) => void, done: (d: any) => void}>} */
const waiting = new Map();
/** @type {{at: number, ms: number}[]} */
let trips = [];
/** @type {Map<number, number>} */
const pings = new Map();
/** @type {Set<() => void>} */
const whenLost = new Set();
/** @type {Set<(s: import("./types.js").State) => void>} */
const whenState = new Set();
/** Bytes of all messages so far, which tests measure. */
export const received = { bytes: 0, messages: 0 };
export const stopping = signal(false);

/** @param {() => void} fn */
export const onLost = (fn) => (whenLost.add(fn), () => whenLost.delete(fn));
/** @param {(s: import("./types.js").State) => void} fn */
export const onState = (fn) => (whenState.add(fn), () => whenState.delete(fn));

function connect() {
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  const name = new URLSearchParams(location.search).get("name"); // what others see of this page, else its kind and address
  const mine = (socket = new WebSocket(`${scheme}//${location.host}/ws${name ? `?name=${encodeURIComponent(name)}` : ""}`));
  lastState = performance.now();
  mine.onmessage = (event) => socket === mine && receive(event.data);
  mine.onclose = () => socket === mine && lose();
}

/** @param {string} text */
function receive(text) {
  received.bytes += text.length;
  received.messages += 1;
  const message = JSON.parse(text);
  if (message.type === "state") take(message.state);
  else if (message.type === "delta" && whole) take(merged(whole, message.changes));
  else if (message.type === "hello") hello.value = message;
  else if (message.type === "pong") pong(message.id);
  else if (message.type === "answer") answered(message);
  else if (message.type === "done") (waiting.get(message.id)?.done(message), waiting.delete(message.id));
}

/** @param {any} next */
function take(next) {
  whole = next;
  attempts = 0;
  lastState = performance.now();
  if (next.stopped) stopping.value = false;
  batch(() => {
    show(next, measuredAge(next));
    link.value = next.age_ms > GAP ? "late" : "live";
  });
  whenState.forEach((fn) => fn(next));
}

/** The age of the oldest of the axes' newest readings, or of the state where an axis has none. @param {import("./types.js").State} s */
function measuredAge(s) {
  const ages = Object.values(s.axes ?? {}).filter((axis) => axis.measured !== null && axis.measured !== undefined).map((axis) => axis.measured_age_ms ?? 0);
  return ages.length ? Math.max(...ages) + (s.age_ms ?? 0) : null;
}

/** @param {any} message */
function answered(message) {
  const entry = waiting.get(message.id);
  entry?.answer(message);
  if (message.error) waiting.delete(message.id);
}

function lose() {
  const old = socket;
  socket = null;
  whole = null;
  batch(() => {
    link.value = "lost";
    hello.value = { ...hello.value, session: "" };
    roundTrip.value = { median: null, worst: null };
  });
  trips = [];
  pings.clear();
  for (const entry of waiting.values()) entry.answer({ error: "connection lost", kind: "lost" });
  waiting.clear();
  whenLost.forEach((fn) => fn());
  if (old && old.readyState < WebSocket.CLOSING) old.close();
  setTimeout(connect, RETRY[Math.min(attempts++, RETRY.length - 1)]);
  if (attempts > 1) login();
}

/** A server that was started again may have forgotten the login: it has a page for that. */
async function login() {
  const answer = await fetch("/api/state", { cache: "no-store" }).catch(() => null);
  if (answer?.status === 401) location.reload();
}

/** @param {any} message */
function send(message) {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(message));
  return true;
}

/** Sends a stick message, unless earlier ones still wait to be sent: an old deflection is worse than none. @param {any} message */
export const sendStick = (message) => (socket?.bufferedAmount ?? 0) < 4096 && send({ do: "stick", ...message });

/**
 * Sends a command. Resolves to its answer, which is shown when it is an error; never rejects.
 * @param {string} name @param {object} [fields] @param {{quiet?: boolean}} [options] @returns {Promise<import("./types.js").Answer>}
 */
export async function command(name, fields = {}, { quiet = false } = {}) {
  const id = nextId++;
  const answer = new Promise((resolve) => waiting.set(id, { answer: resolve, done: ended }));
  if (!send({ id, do: name, ...fields })) {
    waiting.delete(id);
    if (!quiet) notify("not sent: no connection", "error");
    return { error: "no connection", kind: "lost" };
  }
  if (waiting.size > MOST_WAITING) waiting.delete(/** @type {number} */ (waiting.keys().next().value));
  const message = await answer;
  if (message.error && !quiet) notify(message.kind === "busy" && message.holder ? `${message.holder} has control` : message.error, "error");
  return message;
}

/** @param {any} message */
function ended(message) {
  if (message.error) notify(message.error, "error");
}

/** STOP, by both ways, again and again until the state shows it. */
export function stop() {
  if (stopping.peek()) return;
  stopping.value = true;
  const began = performance.now();
  const again = () => {
    if (!stopping.peek()) return;
    if (performance.now() - began > STOP_LONGEST) {
      stopping.value = false;
      notify("STOP is not confirmed: use the rig's own stop", "error");
      return;
    }
    command("stop", {}, { quiet: true });
    if (link.peek() !== "live") fetch("/api/stop", { method: "POST", keepalive: true }).catch(() => {});
    setTimeout(again, STOP_REPEAT);
  };
  again();
}

/** @param {number} id */
function pong(id) {
  const sent = pings.get(id);
  pings.delete(id);
  if (sent === undefined) return;
  const now = performance.now();
  trips = [...trips.filter((trip) => trip.at > now - WINDOW), { at: now, ms: now - sent }];
  const sorted = trips.map((trip) => trip.ms).sort((a, b) => a - b);
  roundTrip.value = { median: sorted[sorted.length >> 1], worst: sorted[sorted.length - 1] };
}

/** A word that this page lives; its answer is the round trip. */
export function ping() {
  const id = nextId++;
  if (send({ do: "ping", id })) pings.set(id, performance.now());
  if (pings.size > 40) pings.delete(/** @type {number} */ (pings.keys().next().value));
}

/** A page that hung or slept is lost too: what it shows is old, and what it held is held no longer. */
function watch() {
  const now = performance.now(), slept = now - lastWatch > GAP && !document.hidden;
  lastWatch = now;
  if (socket && (slept || now - lastState > GAP)) lose();
}

export function start() {
  connect();
  lastWatch = performance.now();
  setInterval(watch, 100);
  setInterval(ping, PING);
}
