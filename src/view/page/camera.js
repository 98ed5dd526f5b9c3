// The eye: goes round a point, nearer and farther, by mouse, touch and keys.

const FOVY = (32 * Math.PI) / 180;
/** The sides to look from: yaw and pitch. +x of the world is the front. */
const SIDES = {
  corner: [-0.9, 0.42], front: [0, 0.05], back: [Math.PI, 0.05], left: [Math.PI / 2, 0.05], right: [-Math.PI / 2, 0.05],
  top: [-Math.PI / 2, 1.5], below: [-Math.PI / 2, -1.5],
};

function cameraOf(canvas, calm, changed) {
  const goal = { yaw: -0.9, pitch: 0.42, distance: 1, target: [0, 0, 0] };
  const now = { ...goal };
  const camera = { matrix: null, eye: [0, 0, 0], target: [0, 0, 0], distance: 1, reach: 0, goal, follow: true, atEnd: false, lowest: -0.2, framed: "first" };
  const pointers = new Map();
  let moved = 0;

  /** Follows the wish; says whether there is still a way to go. */
  camera.update = seconds => {
    const u = calm() ? 1 : 1 - Math.exp(-seconds * 14);
    let far = 0;
    for (const key of ["yaw", "pitch", "distance"]) {
      far = Math.max(far, Math.abs(goal[key] - now[key]));
      now[key] = mix(now[key], goal[key], u);
    }
    far = Math.max(far, norm(sub(goal.target, now.target)) / now.distance);
    now.target = now.target.map((x, i) => mix(x, goal.target[i], u));
    const { distance } = now;
    camera.eye = add(now.target, scaled(axesOf(now.yaw, now.pitch).away, distance));
    camera.target = now.target;
    camera.distance = distance;
    [camera.yaw, camera.pitch] = [now.yaw, now.pitch];
    const view = lookAt(camera.eye, now.target, [0, 0, 1]);
    camera.matrix = times(perspective(FOVY, camera.aspect(), distance * 0.05, distance * 40 + camera.reach), view);
    return far > 1e-4;
  };

  camera.jump = () => Object.assign(now, goal, { target: [...goal.target] });

  camera.aspect = () => canvas.width / Math.max(canvas.height, 1);

  /** Everything in the picture, now and later, from the side it is looked at. */
  camera.fit = (framing, still) => {
    const tall = Math.max(canvas.clientHeight, 1);
    const rims = [Math.min(58 / tall, 0.16), Math.min(34 / tall, 0.1)];
    const { distance, aside } = framing.filling(goal.yaw, goal.pitch, camera.aspect(), rims, still);
    goal.target = add(framing.now().middle, aside);
    goal.distance = distance;
    camera.framed = "whole";
    camera.atEnd = false;
  };

  /** Turns to a side, the shorter way. */
  camera.side = name => {
    const [yaw, pitch] = SIDES[name];
    goal.yaw += ((yaw - goal.yaw + 3 * Math.PI) % (2 * Math.PI) + 2 * Math.PI) % (2 * Math.PI) - Math.PI;
    goal.pitch = pitch;
    changed();
  };

  /** The first look: from a corner, or along a row from its end, so that the near modules are seen. */
  camera.begin = (framing, still) => {
    const { thread } = framing;
    if (!thread) camera.fit(framing, still);
    camera.framed = "first";
    if (!thread) return;
    camera.atEnd = true;
    const half = Math.atan(camera.aspect() * Math.tan(FOVY / 2));
    const { end, angle, wide } = thread;
    // Parallel lines away from the camera vanish within the picture, above its middle.
    goal.yaw = angle - 0.55 * half;
    goal.pitch = 0.3 * FOVY;
    goal.target = add(end, [-2 * wide * Math.cos(angle), -2 * wide * Math.sin(angle), 0]);
    goal.distance = framing.distance(goal.yaw, goal.pitch, camera.aspect(), { low: [-3 * wide, -3 * wide, -wide], high: [3 * wide, 3 * wide, wide], middle: [0, 0, 0] });
  };

  camera.orbit = (dx, dy) => {
    camera.framed = null;
    goal.yaw -= dx;
    goal.pitch = clamp(goal.pitch + dy, camera.lowest, 1.55);
    changed();
  };
  camera.pan = (dx, dy) => {
    const { right, up } = axesOf(goal.yaw, goal.pitch);
    goal.target = add(goal.target, add(scaled(right, -dx * goal.distance), scaled(up, dy * goal.distance)));
    camera.follow = camera.framed = null;
    changed();
  };
  camera.zoom = factor => {
    camera.framed = null;
    goal.distance = clamp(goal.distance * factor, 1e-3, 1e4);
    changed();
  };
  camera.dragged = () => moved > 4;

  const place = e => [e.clientX, e.clientY];
  canvas.addEventListener("pointerdown", e => {
    pointers.set(e.pointerId, place(e));
    canvas.setPointerCapture(e.pointerId);
    if (pointers.size === 1) moved = 0;
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => pointers.delete(e.pointerId));
  canvas.addEventListener("pointermove", e => {
    const before = pointers.get(e.pointerId);
    if (!before) return;
    const after = place(e);
    const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
    moved += Math.abs(dx) + Math.abs(dy);
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== e.pointerId)[1];
      const gap = p => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
      camera.zoom(gap(before) / gap(after));
      camera.pan(dx / 2 / canvas.clientHeight, dy / 2 / canvas.clientHeight);
    } else if (e.buttons & 6 || e.shiftKey) camera.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    else camera.orbit(dx * 0.008, dy * 0.008);
    pointers.set(e.pointerId, after);
  });
  canvas.addEventListener("wheel", e => {
    e.preventDefault();
    camera.zoom(Math.exp(clamp(e.deltaY, -200, 200) * 0.0012));
  }, { passive: false });
  canvas.addEventListener("contextmenu", e => e.preventDefault());
  return camera;
}
