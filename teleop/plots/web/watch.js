// A page that `teleop preview --watch` writes again and again: it loads itself anew, and looks as it did before.
//
// From a file a page may load a script but not read a file: the program writes one that names the version of the page.

const POLL = 400; // ms
const PATIENCE = 5; // times without an answer, after which the program has ended

function remember() {
  if (!move.watch) return;
  const { from, to, limits } = view, whole = from === 0 && to === (move.duration || 1);
  const hidden = move.axes.filter((axis) => !axis.shown).map((axis) => axis.name);
  try {
    sessionStorage.setItem(location.pathname, JSON.stringify({ limits, hidden, ...(whole ? {} : { from, to }), scroll: scrollY }));
  } catch { /* a browser that keeps nothing for a file */ }
}
function recall() {
  if (!move.watch) return;
  try {
    const { limits, hidden, from, to, scroll } = JSON.parse(sessionStorage.getItem(location.pathname)) ?? {};
    view.limits = Boolean(limits);
    for (const axis of move.axes) axis.shown = !hidden?.includes(axis.name);
    if (from < move.duration) Object.assign(view, { from, to: Math.min(to, move.duration) });
    if (scroll) requestAnimationFrame(() => scrollTo(0, scroll));
  } catch { /* as above */ }
}

let unanswered = 0;
function poll() {
  const script = document.createElement("script");
  script.src = `${move.watch.script}?${Date.now()}`;
  const next = () => {
    script.remove();
    if (unanswered < PATIENCE) setTimeout(poll, POLL);
    else element("problems").textContent = "teleop preview --watch has ended.";
  };
  script.onload = () => { unanswered = 0; next(); };
  script.onerror = () => { unanswered += 1; next(); };
  document.head.append(script);
}
globalThis.teleopPreview = (version, problems) => {
  element("problems").textContent = problems.join("\n");
  if (version === move.watch.version) return;
  remember();
  location.reload();
};
if (move.watch) poll();
