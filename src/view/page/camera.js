// The eye: goes round a point, nearer and farther, by mouse, touch and keys.

const FOVY = (38 * Math.PI) / 180;

function cameraOf(canvas, calm, changed) {
  const goal = { yaw: -0.9, pitch: 0.42, distance: 1, target: [0, 0, 0] };
  const now = { ...goal };
  const camera = { matrix: null, eye: [0, 0, 0], goal, follow: true };
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
    const aspect = canvas.width / Math.max(canvas.height, 1);
    const away = [Math.cos(now.pitch) * Math.cos(now.yaw), Math.cos(now.pitch) * Math.sin(now.yaw), Math.sin(now.pitch)];
    // In a narrow window the width has to hold what the height holds in a wide one.
    const distance = now.distance * Math.max(1, 0.95 / aspect);
    camera.eye = add(now.target, scaled(away, distance));
    const view = lookAt(camera.eye, now.target, [0, 0, 1]);
    camera.matrix = times(perspective(FOVY, aspect, distance * 0.05, distance * 40), view);
    return far > 1e-4;
  };

  camera.jump = () => Object.assign(now, goal, { target: [...goal.target] });

  /** So far away that a ball is in view. */
  camera.fit = (middle, radius) => {
    goal.target = [...middle];
    goal.distance = (radius / Math.sin(FOVY / 2)) * 1.02;
  };

  camera.orbit = (dx, dy) => {
    goal.yaw -= dx;
    goal.pitch = clamp(goal.pitch + dy, -0.2, 1.55);
    changed();
  };
  camera.pan = (dx, dy) => {
    const right = [-Math.sin(goal.yaw), Math.cos(goal.yaw), 0];
    const up = [-Math.sin(goal.pitch) * Math.cos(goal.yaw), -Math.sin(goal.pitch) * Math.sin(goal.yaw), Math.cos(goal.pitch)];
    goal.target = add(goal.target, add(scaled(right, -dx * goal.distance), scaled(up, dy * goal.distance)));
    camera.follow = false;
    changed();
  };
  camera.zoom = factor => {
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
