// The way to the server: what the text shows, whenever it changes, and changes that are asked for.

/** So long after the server was lost it is asked again, ms. */
const RETRY_AFTER = 700;

const $ = id => document.getElementById(id);

/** Asks for a change; says what is answered, or why nothing was. */
async function ask(what, body) {
  try {
    const answer = await fetch(what, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
    return await answer.json();
  } catch {
    return { refused: "modl does not answer: is it still running?" };
  }
}

/** Listens for what the text shows; `wish` says which declaration is wanted. */
function wireOf(show, lost) {
  const wire = { version: 0, robot: "" };
  let waiting = null;
  wire.wish = robot => {
    wire.robot = robot;
    wire.version = 0;
    if (waiting) waiting.abort();
  };
  (async () => {
    for (;;) {
      waiting = new AbortController();
      const { robot } = wire;
      try {
        const answer = await fetch(`state?since=${wire.version}&robot=${encodeURIComponent(robot)}`, { signal: waiting.signal });
        if (!answer.ok) throw new Error(answer.status);
        const state = await answer.json();
        lost(false);
        if (!state || robot !== wire.robot) continue;
        wire.version = state.version;
        show(state);
      } catch (error) {
        if (error.name === "AbortError") continue;
        lost(true);
        await new Promise(resolve => setTimeout(resolve, RETRY_AFTER));
      }
    }
  })();
  return wire;
}
