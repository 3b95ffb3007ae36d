import { html } from "./vendor/preact/preact.min.js";
export const Shoot = () => html`<main></main>`;
