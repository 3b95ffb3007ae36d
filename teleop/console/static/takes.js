import { html } from "./vendor/preact/preact.min.js";
export const Takes = () => html`<main></main>`;
