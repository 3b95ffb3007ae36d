// The screen stays on while the console is in view. A browser grants that only on a secure page; on others it says so once.
import { notify } from "./store.js";

/** @type {any} */
let lock = null;

async function keep() {
  if (document.hidden || (lock && !lock.released)) return;
  try {
    lock = await /** @type {any} */ (navigator).wakeLock.request("screen");
  } catch {
    lock = null; // refused, as with an empty battery: the screen may sleep, which ends every stick
  }
}

export function watchWake() {
  if (!("wakeLock" in navigator)) {
    if (!window.isSecureContext) notify("without TLS the screen may go to sleep: start the console with --tls", "error");
    return;
  }
  keep();
  document.addEventListener("visibilitychange", keep);
}
