// The signs on buttons as SVG: no font has them all.
import { html } from "./vendor/preact/preact.min.js";

const SHAPES = {
  play: "M7 4l13 8-13 8z",
  pause: "M6 4h4v16H6zM14 4h4v16h-4z",
  resume: "M3 4h4v16H3zM10 4l12 8-12 8z",
  stop: "M5 5h14v14H5z",
  start: "M5 4h3v16H5zM20 4v16L9 12z",
  next: "M4 4l9 8-9 8zM13 4l8 8-8 8z",
  previous: "M20 4l-9 8 9 8zM11 4l-8 8 8 8z",
  undo: "M9 4L3 9.5 9 15v-4h5a4 4 0 0 1 0 8H8v2h6a6 6 0 0 0 0-12H9z",
  redo: "M15 4l6 5.5-6 5.5v-4h-5a4 4 0 0 0 0 8h6v2h-6a6 6 0 0 1 0-12h5z",
  free: "M12 2l3.5 4h-2.4v4.9H18V8.5l4 3.5-4 3.5v-2.4h-4.9V18h2.4L12 22l-3.5-4h2.4v-4.9H6v2.4L2 12l4-3.5v2.4h4.9V6H8.500z",
  across: "M2 12l5-5v3.500h10V7l5 5-5 5v-3.500H7V17z",
  along: "M12 2l5 5h-3.500v10H17l-5 5-5-5h3.500V7H7z",
  locked: "M6 10V8a6 6 0 0 1 12 0v2h2v12H4V10zm2.500 0h7V8a3.500 3.500 0 0 0-7 0z",
};

/** @param {{name: keyof typeof SHAPES}} props */
export const Icon = ({ name }) => html`<svg class="sign" viewBox="0 0 24 24" aria-hidden="true"><path d=${SHAPES[name]} /></svg>`;
