// The console: what is always there, and the page that is chosen.
import { html, render, useEffect } from "./vendor/preact/preact.min.js";
import { start } from "./connection.js";
import { fresh, link, tab } from "./store.js";
import { Banners, Bar, TABS } from "./bar.js";
import { Closed, Commission, closed, commission, watchCommission } from "./commission.js";
import { FleetTiles } from "./fleet.js";
import { watchGamepads } from "./gamepad.js";
import { Help, watchKeyboard } from "./keyboard.js";
import { Live } from "./live.js";
import { listMoves } from "./moves.js";
import { Move } from "./move/page.js";
import { Shoot } from "./shoot.js";
import { watchReleases } from "./stick_stream.js";
import { Takes } from "./takes.js";
import { watchWake } from "./wake.js";

/** @type {Object<string, () => any>} */
const PAGES = { live: Live, move: Move, shoot: Shoot, takes: Takes };

function App() {
  const commissions = !!commission.value, over = closed.value && !fresh.value;
  const Page = over ? Closed : commissions ? Commission : PAGES[tab.value];
  useEffect(() => {
    history.replaceState(null, "", `${location.search}#${tab.value}`);
    document.title = `${commissions ? "Commissioning" : TABS.find(([id]) => id === tab.value)?.[1]} - teleop console`;
  }, [tab.value, commissions]);
  return html`<div class="app link-${link.value} ${commissions || over ? "commissions" : ""}"><${Bar} />${!over && html`<${Banners} /><${FleetTiles} />`}<${Page} /><${Help} /></div>`;
}

const first = location.hash.slice(1);
if (first in PAGES) tab.value = first;
const place = /** @type {HTMLElement} */ (document.getElementById("app"));
place.replaceChildren();
render(html`<${App} />`, place);
watchReleases();
watchKeyboard();
watchCommission();
watchGamepads();
watchWake();
start();
listMoves();
