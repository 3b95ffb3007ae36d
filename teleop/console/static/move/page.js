import { html } from "../vendor/preact/preact.min.js";
export const Move = () => html`<main></main>`;
