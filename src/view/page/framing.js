// Framing: the extent of the scene at a time and over time, and the viewpoint that shows it.

/** A row longer than so many times its width is looked at along itself: from the side it is a thread. */
const THREAD = 9;
/** Times at which everything has to be in the picture: so many, fewer where there is much to look at. */
const LOOKS_MAX = 12;
const LOOKED_MAX = 20000;
/** Part of the picture that is filled, beside the words at its upper and lower rim. */
const FILLED = 0.93;
/** Corners of what is looked at at one time; of more, one in so many. */
const CORNERS_MAX = 4000;

function framingOf(plan, motion, X) {
  const boxes = boxesOf(plan, motion);

  /** Middle, half the size and the corners of a box around everything that was placed in X; `see` is told each corner of
      the box around each body. */
  function now(see) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const { body, corners } of boxes) {
      const { m } = frameOf(X, body);
      for (const [x, y, z] of corners) {
        const p = [0, 1, 2].map(k => m[k] * x + m[3 + k] * y + m[6 + k] * z + m[9 + k]);
        for (let k = 0; k < 3; k++) (low[k] = Math.min(low[k], p[k])), (high[k] = Math.max(high[k], p[k]));
        if (see) see(p);
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
    const seen = [];
    const look = now(p => seen.push(p));
    const stride = Math.ceil(seen.length / CORNERS_MAX);
    looks.push({ ...look, corners: seen.filter((_, i) => i % stride === 0).map(p => sub(p, look.middle)) });
    threads.push(thread(looks[i]));
  }

  /** Whether it is still the same row. */
  const stays = thread => thread && threads[0] && Math.abs(thread.angle - threads[0].angle) < 0.1;

  return {
    now,
    /** The greatest size that there is over time, and the lowest place. */
    radius: Math.max(...looks.map(look => look.radius)),
    lowest: Math.min(...looks.map(look => look.low[2])),
    thread: threads.every(stays) ? threads[0] : null,
    /** Where a camera that follows looks, of what was found now: the row's end, or the middle. */
    followed: (end, found) => (end && (thread(found) || {}).end) || found.middle,
    /** How far away a camera of this direction has to be for a box to be in the picture. */
    distance(yaw, pitch, aspect, { low, high, middle }) {
      const { away, right, up } = axesOf(yaw, pitch);
      const tall = 0.84 * Math.tan(FOVY / 2);
      let most = 0;
      for (let i = 0; i < 8; i++) {
        const d = [0, 1, 2].map(k => (i >> k & 1 ? high : low)[k] - middle[k]);
        most = Math.max(most, dot(d, away) + Math.max(Math.abs(dot(d, right)) / (tall * aspect), Math.abs(dot(d, up)) / tall));
      }
      return Math.max(most, 1e-3);
    },
    /** The distance of a camera of this direction and the place beside the middle that it looks at, with which all that it
        follows fills the picture between its rims (parts of its height); `still`: what it does not follow, as corners
        beside the middle. */
    filling(yaw, pitch, aspect, [over, under], still = []) {
      const { away, right, up } = axesOf(yaw, pitch);
      const half = Math.tan(FOVY / 2);
      const points = [...looks.flatMap(look => look.corners), ...still].map(d => [dot(d, right), dot(d, up), dot(d, away)]);
      const deepest = Math.max(...points.map(p => p[2]));
      let [x, y, distance] = [0, 0, deepest + 4 * Math.max(...looks.map(look => look.radius))];
      const [tall, wide] = [FILLED * half * (1 - over - under), FILLED * half * aspect];
      for (let i = 0; i < 24; i++) {
        // The outermost points on both sides as the camera sees them, each with its distance along the view.
        const [across, upwards] = [[0, x], [1, y]].map(([k, centre]) => {
          let [low, high] = [[Infinity], [-Infinity]];
          for (const p of points) {
            const gap = distance - p[2];
            const at = (p[k] - centre) / gap;
            if (at < low[0]) low = [at, p[k], gap];
            if (at > high[0]) high = [at, p[k], gap];
          }
          // In between, where both are as far from the middle of the picture.
          return { centre: (low[1] * high[2] + high[1] * low[2]) / (low[2] + high[2]), half: (high[0] - low[0]) / 2 };
        });
        [x, y] = [across.centre, upwards.centre];
        const grown = Math.max(across.half / wide, upwards.half / tall, 1e-6);
        distance = deepest + (distance - deepest) * clamp(grown, 0.4, 2.5);
      }
      // The middle between the rims is not that of the picture.
      y += (over - under) * half * distance;
      return { distance: Math.max(distance, 1e-3), aside: add(scaled(right, x), scaled(up, y)) };
    },
  };
}

/** A box around the solids of each body, in its own frame. */
function boxesOf(plan, motion) {
  const known = new Map();
  for (const solid of motion.solids) {
    if (solid.endless || solid.metal) continue;
    if (!known.has(solid.body)) known.set(solid.body, { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });
    for (const corner of cornersOf(plan, solid)) widen(known.get(solid.body), add(solid.p, turned(solid.q, corner)));
  }
  const corner = ({ low, high }, i) => [0, 1, 2].map(k => (i >> k & 1 ? high : low)[k]);
  return [...known].map(([body, box]) => ({ body, corners: [0, 1, 2, 3, 4, 5, 6, 7].map(i => corner(box, i)) }));
}

/** From a target towards a camera, and the directions right and up in its picture. */
function axesOf(yaw, pitch) {
  const [c, s, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return { away: [cp * c, cp * s, sp], right: [-s, c, 0], up: [-sp * c, -sp * s, cp] };
}
