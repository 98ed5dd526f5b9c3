// Framing: the extent of the scene at a time and over time, and the viewpoint that shows it.

/** A row longer than so many times its width is looked at along itself: from the side it is a thread. */
const THREAD = 9;
/** Times at which everything has to be in the picture: so many, fewer where there is much to look at. */
const LOOKS_MAX = 12;
const LOOKED_MAX = 20000;
/** Part of the picture that is filled: words stand at its rim. */
const FILLED = 0.84;

function framingOf(plan, motion, X) {
  /** Middle, half the size and the corners of a box around everything that was placed in X. */
  function now() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const solid of motion.solids) {
      if (solid.endless) continue;
      const i = POSE * solid.body;
      const q = [X[i + 4], X[i + 5], X[i + 6], X[i + 7]];
      const c = add([X[i], X[i + 1], X[i + 2]], turned(q, solid.p.map((x, k) => x * X[i + 8 + k])));
      const reach = 0.8 * (solid.shape > 2 ? plan.meshes[solid.shape - 3].radius : norm(solid.s.map((x, k) => x * X[i + 8 + k])) / 2);
      for (let k = 0; k < 3; k++) {
        low[k] = Math.min(low[k], c[k] - reach);
        high[k] = Math.max(high[k], c[k] + reach);
      }
    }
    return { low, high, middle: scaled(add(low, high), 0.5), radius: Math.max(norm(sub(high, low)) / 2, 1e-3) };
  }

  /** The row that everything stands in, if it is one: its near end, direction and width. */
  function thread({ low, high } = now()) {
    let [x, y, xx, xy, yy] = [0, 0, 0, 0, 0];
    for (let b = 0; b < motion.bodies; b++) (x += X[POSE * b] / motion.bodies), (y += X[POSE * b + 1] / motion.bodies);
    for (let b = 0; b < motion.bodies; b++) {
      const [dx, dy] = [X[POSE * b] - x, X[POSE * b + 1] - y];
      (xx += dx * dx), (xy += dx * dy), (yy += dy * dy);
    }
    const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
    const along = [Math.cos(angle), Math.sin(angle)];
    let [first, last, wide] = [Infinity, -Infinity, 0];
    for (let b = 0; b < motion.bodies; b++) {
      const [dx, dy] = [X[POSE * b] - x, X[POSE * b + 1] - y];
      const u = dx * along[0] + dy * along[1];
      (first = Math.min(first, u)), (last = Math.max(last, u));
      wide = Math.max(wide, 2 * Math.abs(dy * along[0] - dx * along[1]));
    }
    wide = Math.max(wide, high[2] - low[2]);
    if (last - first < THREAD * wide) return null;
    return { end: [x + along[0] * last, y + along[1] * last, (low[2] + high[2]) / 2], angle, wide };
  }

  const looks = [];
  const threads = [];
  const times = clamp(Math.floor(LOOKED_MAX / motion.solids.length), 3, LOOKS_MAX);
  for (let i = 0; i <= times; i++) {
    motion.place((plan.end * i) / times, X);
    looks.push(now());
    threads.push(thread(looks[i]));
  }

  /** Whether it is still the same row. */
  const stays = thread => thread && threads[0] && Math.abs(thread.angle - threads[0].angle) < 0.1;

  return {
    now,
    /** The greatest size that there is over time. */
    radius: Math.max(...looks.map(look => look.radius)),
    thread: threads.every(stays) ? threads[0] : null,
    /** Where a camera that follows looks, of what was found now: the row's end, or the middle. */
    followed: (end, found) => (end && (thread(found) || {}).end) || found.middle,
    /** How far away a camera of this direction has to be for all that it follows to be in the picture. */
    distance(yaw, pitch, aspect, only) {
      const { away, right, up } = axesOf(yaw, pitch);
      const tall = FILLED * Math.tan(FOVY / 2);
      const wide = tall * aspect;
      let most = 0;
      for (const { low, high, middle } of only ? [only] : looks)
        for (let i = 0; i < 8; i++) {
          const d = [0, 1, 2].map(k => (i >> k & 1 ? high : low)[k] - middle[k]);
          most = Math.max(most, dot(d, away) + Math.max(Math.abs(dot(d, right)) / wide, Math.abs(dot(d, up)) / tall));
        }
      return Math.max(most, 1e-3);
    },
  };
}

/** From a target towards a camera, and the directions right and up in its picture. */
function axesOf(yaw, pitch) {
  const [c, s, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return { away: [cp * c, cp * s, sp], right: [-s, c, 0], up: [-sp * c, -sp * s, cp] };
}
