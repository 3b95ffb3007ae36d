// The page of a commissioning: one step a screen, as the terminal has it. What is pressed names the page that it answers.
import { html, useEffect, useLayoutEffect, useRef, useSignal, signal } from "./vendor/preact/preact.min.js";
import { command, ping, stop } from "./connection.js";
import { fresh, holder, mayOperate, mine, notify, part } from "./store.js";

/** @typedef {import("./types.js").CommissionState} CommissionState */
export const commission = part((s) => s.commission ?? null, /** @type {CommissionState|null} */ (null));
/** The last page was closed here: the connection that ends then is not lost. */
export const closed = signal(false);

const ALIVE = 200; // ms between two words that this page lives, while a step that it let go moves
const NAMES = /** @type {Object<string, string>} */ ({ Enter: "enter", ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" });
const SHOWN = /** @type {Object<string, string>} */ ({ enter: "Enter", left: "←", right: "→", up: "↑", down: "↓" });
const RESULTS = /** @type {Object<string, string>} */ ({ "": "to come", now: "now", done: "done", different: "different", "not seen": "not seen", skipped: "skipped" });
const OWN = ["enter", "space", "s", "r", "q"];
const agreed = signal(false), sending = signal(0);

/** Presses a key of the page that is shown now; takes control first where it is free. @param {string} key @param {object} [fields] */
async function press(key, fields = {}) {
  const page = commission.peek();
  if (!page || sending.peek() === page.page || !fresh.peek()) return;
  if (key === "enter" && page.stage === "prompt" && page.consent && !agreed.peek()) return notify("tick the box that agrees to it first");
  sending.value = page.page; // each page takes one key
  const agrees = key === "enter" && agreed.peek() ? { agrees: true } : {};
  const denied = mine.peek() ? false : (await command("take_control")).error;
  const answer = denied ? { error: denied } : await command("commission_key", { page: page.page, key, ...agrees, ...fields });
  sending.value = 0;
  if (!answer.error && page.stage === "over") closed.value = true;
}

/** A key of the keyboard; whether it was one of the page. @param {KeyboardEvent} event */
export function pressedKey(event) {
  const page = commission.peek(), key = NAMES[event.key] ?? event.key;
  if (!page) return false;
  if (event.repeat) return key === "enter" || key in SHOWN; // a key that is held down counts once
  if (key === "enter" && /** @type {HTMLElement} */ (event.target).matches("button, a, summary")) return false;
  if (page.typed != null || !page.keys.some(([each]) => each === key)) return false;
  press(key);
  return true;
}

/** Whether a step moves that this page has let go. */
const holds = () => mine.peek() && commission.peek()?.moves;

/** A page that nobody sees holds nothing. */
function left() {
  if (holds()) stop();
}

export function watchCommission() {
  document.addEventListener("visibilitychange", () => document.hidden && left());
  window.addEventListener("pagehide", left);
  setInterval(() => {
    if (document.hidden) left(); // it may have begun to move after the page was hidden
    else if (holds()) ping();
  }, ALIVE);
}

export function Commission() {
  const page = /** @type {CommissionState} */ (commission.value), title = useRef(/** @type {any} */ (null));
  useEffect(() => {
    agreed.value = false;
    if (page.typed == null) title.current?.focus({ preventScroll: true }); // a screen reader reads it; Enter goes
    document.querySelector("main")?.scrollTo(0, 0);
  }, [page.page]);
  const over = page.stage === "over";
  return html`<main class="commission" aria-label="Commissioning">
    <section class="card step stage-${page.stage}">
      <p class="place">${over ? "Over" : `Step ${page.step} of ${page.steps}`}<progress aria-label="Steps" max=${page.steps} value=${over ? page.steps : page.step - 1}></progress></p>
      <h2 class="title" data-testid="commission-title" tabindex="-1" ref=${title}>${over ? "The commissioning is over" : page.title}</h2>
      ${page.trouble && html`<p class="trouble" role="alert" data-testid="commission-trouble">${page.trouble}</p>`}
      ${over && page.reason && page.reason !== page.trouble && html`<p class="trouble">${page.reason}</p>`}
      ${page.question && html`<p class="question" data-testid="commission-question">${page.question}</p>`}
      <${Text} page=${page} />
      ${page.stage === "shown" && page.facts.length > 0 && html`<${Facts} facts=${page.facts} />`}
      ${page.stage === "shown" && page.displaced && html`<p class="consent">It goes back to where it began: ${page.displaced}</p>`}
      ${over && html`<${Results} files=${page.files} />`}
    </section>
    <${Keys} page=${page} key=${page.page} />
    <${Outline} page=${page} />
  </main>`;
}

/** @param {{page: CommissionState}} props */
function Text({ page }) {
  const quiet = page.stage !== "prompt" && page.stage !== "over";
  if (page.stage === "shown" && !page.trouble) return null;
  return html`${page.lines.length > 0 && html`<div class="lines ${quiet ? "quiet" : ""}" data-testid="commission-lines">${page.lines.map((line) => html`<p>${line}</p>`)}</div>`}
    ${page.consent && page.stage === "prompt" && html`<p class="consent" data-testid="commission-consent">${page.consent}</p>
      <label class="agree"><input type="checkbox" data-testid="commission-agree" checked=${agreed.value} onChange=${(/** @type {any} */ e) => (agreed.value = e.target.checked)} />I agree to that</label>`}
    <p class="progress" role="status" data-testid="commission-progress">${page.stage === "releasing" ? "coming to rest" : page.progress}</p>`;
}

/** @param {{facts: CommissionState["facts"]}} props */
const Facts = ({ facts }) => html`<div class="facts" tabindex="0" role="region" aria-label="What was found"><table data-testid="commission-facts">
  <thead><tr><th scope="col">Found</th><th scope="col">Value</th><th scope="col">Verdict</th></tr></thead>
  <tbody>${facts.map((fact) => html`<tr><th scope="row">${fact.title}<small>${fact.how}</small></th>
    <td>${fact.found}${fact.verdict === "different" && html`<small>document: ${fact.documented}</small>`}</td>
    <td class="verdict ${fact.verdict.replaceAll(" ", "-")}">${fact.verdict}</td></tr>`)}</tbody></table></div>`;

/** @param {{files: string[]|null|undefined}} props */
const Results = ({ files }) => html`<div class="row results" data-testid="commission-results">
  ${!files ? html`<p>The results are being written.</p>` : files.length ? files.map((file) => html`<a class="button" href=${`/commission/${file}`} download>${file}</a>`) : html`<p>Nothing was found: there is no report.</p>`}</div>`;

/** @param {{page: CommissionState}} props */
function Keys({ page }) {
  const word = useSignal(""), has = new Map(page.keys), typing = page.typed != null, field = useRef(/** @type {any} */ (null));
  useLayoutEffect(() => typing && field.current?.focus(), [typing]);
  const off = !mayOperate.value || !fresh.value || (!mine.value && !!holder.value) || sending.value === page.page;
  const send = (/** @type {Event} */ event) => (event.preventDefault(), press("enter", { text: word.peek().trim() || " " }));
  const choices = page.keys.filter(([key]) => page.stage === "asking" && !OWN.includes(key));
  const go = typing ? "Confirm" : page.stage === "shown" ? "Next" : page.stage === "prompt" ? "Go" : has.get("enter");
  const unagreed = page.stage === "prompt" && page.consent && !agreed.value;
  return html`<section class="card commission-keys" aria-label="Keys">
    ${typing && html`<form onSubmit=${send}><label for="typed">Type it here${page.typed && ` (typed on the terminal: ${page.typed})`}</label>
      <input id="typed" type="text" maxlength="40" autocomplete="off" autocapitalize="none" spellcheck=${false} data-testid="commission-typed" ref=${field} disabled=${off}
        value=${word.value} onInput=${(/** @type {any} */ e) => (word.value = e.target.value)} />
      <button class="primary" data-testid="commission-go" disabled=${off || !word.value.trim()}>Confirm</button></form>`}
    ${!typing && has.has("enter") && html`<${Key} key_="enter" name=${capital(go ?? "")} testid="commission-go" primary=${true} off=${off || unagreed} />`}
    ${choices.map(([key, does]) => html`<${Key} key_=${key} name=${capital(does)} testid=${`commission-choice-${key}`} primary=${!has.has("enter")} off=${off} />`)}
    ${page.stage === "shown" && has.has("r") && html`<${Key} key_="r" name="Repeat" testid="commission-repeat" primary=${!has.has("enter")} off=${off} />`}
    ${page.stage !== "asking" && has.has("s") && html`<${Key} key_="s" name="Skip" testid="commission-skip" off=${off} />`}
    ${has.has("q") && !typing && !choices.some(([key]) => key === "q") && html`<${Key} key_="q" name="End here" testid="commission-abort" off=${off} />`}
    ${page.stage === "over" && html`<${Key} key_="q" name="Close" testid="commission-close" primary=${true} off=${off} />`}
    ${page.moves && html`<p class="hint">STOP, or space, stops it.</p>`}
    ${off && fresh.value && !sending.value && html`<p class="hint">${mayOperate.value ? `${holder.value} has control.` : "This login only watches; STOP works."}</p>`}
  </section>`;
}

/** @param {{key_: string, name: string, testid: string, primary?: boolean, off: any}} props */
const Key = ({ key_, name, testid, primary = false, off }) => html`<button class=${primary ? "primary" : ""} data-testid=${testid} disabled=${!!off} onClick=${() => press(key_)}>
  ${name}<kbd aria-hidden="true">${SHOWN[key_] ?? key_}</kbd></button>`;

const capital = (/** @type {string} */ text) => text.charAt(0).toUpperCase() + text.slice(1);

/** Every step with what came of it. @param {{page: CommissionState}} props */
function Outline({ page }) {
  const wide = window.matchMedia("(min-width: 900px)").matches;
  return html`<details class="card outline" open=${wide}><summary>All steps</summary><ol data-testid="commission-outline">${page.outline.map(
    (step) => html`<li class="result-${step.result.replaceAll(" ", "-") || "coming"}" aria-current=${step.result === "now" ? "step" : undefined}>
      <span>${step.title}</span> <b>${RESULTS[step.result]}</b></li>`,
  )}</ol></details>`;
}

/** After the last page was closed. */
export const Closed = () => html`<main class="commission"><section class="card step"><h2 class="title" data-testid="commission-title">Closed</h2><p class="lines">The commissioning is over: this page can be closed.</p></section></main>`;
