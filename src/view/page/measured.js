// Simulations: what the robot did, measured at moments, in place of what the plan says. Lines that begin with `//:` in the
// other scripts are code in pages of simulations alone, where these two scripts stand before them.

/** The numbers of a column: [unit, first, difference, ...]; what is missing at its end stays as it is. */
function columnOf([unit, ...steps], count) {
  const numbers = new Float64Array(count);
  let sum = 0;
  for (let i = 0; i < count; i++) numbers[i] = (sum += steps[i] || 0) * unit;
  return numbers;
}

/** The motion that was measured. `nominal` is that of the plan, with the same bodies; all that the plan commands is its. */
function measuredMotion(plan, nominal) {
  const measured = plan.simulation;
  const { count } = measured;
  const times = columnOf(measured.times, count);
  const joints = measured.joints.map(column => columnOf(column, count));
  const first = plan.body.forms.length;
  plan.body.forms.push(...measured.forms);
  const trees = measured.trees.map(({ root, steps }, i) => ({
    root,
    steps: steps.map(([link, parent, form, ...joint]) => [link, parent, form + first, ...joint]),
    base: measured.bases[i].map(column => columnOf(column, count)),
  }));
  const at = t => {
    const i = Math.max(lastNotAbove(times, t), 0);
    const j = Math.min(i + 1, count - 1);
    return [i, j, j > i ? clamp((t - times[i]) / (times[j] - times[i]), 0, 1) : 0];
  };
  const jointAt = (joint, t) => {
    const [i, j, u] = at(t);
    return mix(joints[joint][i], joints[joint][j], u);
  };
  const told = (joint, value) => (nominal.joints[joint].turns ? ((value * 180) / Math.PI).toFixed(1) + "°" : (value * 1000).toFixed(1) + " mm");
  const q = new Float64Array(joints.length);
  return {
    ...nominal,
    nominal,
    /** Where the base is on the ground at each moment, as [x, y]; where that is not level, its own place. */
    way: Array.from(times, (_, i) => trees[0].base.slice(0, measured.terrain ? 3 : 2).map(column => column[i])),
    times,
    momentAt: t => at(t)[0],
    jointAt,
    drives: measured.drives.map(drive => ({ ...drive, efforts: columnOf(drive.efforts, count) })),
    events: measured.events.map(([time, text]) => ({ time, kind: "dock", text })),
    place(t, X) {
      const [i, j, u] = at(t);
      joints.forEach((column, joint) => (q[joint] = mix(column[i], column[j], u)));
      for (const { root, steps, base } of trees) {
        const numbers = base.map(column => mix(column[i], column[j], u));
        const turn = numbers.slice(3);
        const length = Math.hypot(...turn);
        nominal.walk({ root, steps }, q, { p: numbers.slice(0, 3), q: turn.map(c => c / length) });
      }
      nominal.write(X);
    },
    facts(b, t) {
      const lines = nominal.facts(b, t).slice(0, 2);
      for (const joint of nominal.jointsOf(nominal.moduleOf[b])) {
        lines.push([nominal.joints[joint].name, told(joint, jointAt(joint, t)) + ", wanted " + told(joint, nominal.jointAt(joint, t))]);
      }
      return lines;
    },
  };
}

/** The curves of joints as they went, with those of the plan. */
function measuredJoints(plan, motion, { title, lines }, chosen) {
  for (const [i, joint] of chosen.entries()) {
    const scale = motion.joints[joint].turns ? 180 / Math.PI : 1000;
    lines[i].commanded = lines[i].points.map(([t]) => [t, motion.nominal.jointAt(joint, t) * scale]);
  }
  return { title: title + ", dashed: the plan", lines };
}

/** The efforts of the motors of joints: of those with limits as parts of them, or else as they are. */
function effortRows(plan, motion, chosen) {
  const drives = motion.drives.filter(drive => chosen.includes(drive.joint));
  const limited = drives.filter(drive => drive.limit > 0);
  const line = (drive, scale, unit) => ({
    name: drive.name, unit, points: Array.from(motion.times, (t, i) => [t, drive.efforts[i] * scale]),
  });
  if (limited.length) {
    const lines = limited.slice(0, JOINTS_SHOWN).map(drive => {
      const share = line(drive, 100 / drive.limit, " % of " + drive.limit + " " + drive.unit);
      return { ...share, points: share.points.map(([t, x]) => [t, Math.abs(x)]) };
    });
    return [{ title: "efforts", lines, limits: [[100, "limit of the motor"]] }];
  }
  const lines = drives.slice(0, JOINTS_SHOWN).map(drive => line(drive, 1, " " + drive.unit));
  return lines.length ? [{ title: "efforts, without limits", lines }] : [];
}

/** The way to colour by what motors were asked for, as a part of their limits. */
function effortColours(motion) {
  const of = motion.modules.map(() => []);
  for (const drive of motion.drives) {
    const { module } = motion.joints[drive.joint];
    if (drive.limit > 0 && module >= 0) of[module].push(drive);
  }
  const colour = (body, X, t) => {
    const drives = of[motion.moduleOf[body]];
    const moment = motion.momentAt(t);
    return drives.length ? ramp(Math.max(...drives.map(drive => Math.abs(drive.efforts[moment]) / drive.limit))) : rgb(motion.modules[motion.moduleOf[body]].around ? AROUND : "#8d949b");
  };
  return of.some(drives => drives.length) ? [{ name: "effort", title: "Effort", colour, legend: [["ramp", "effort, none to its limit"]] }] : [];
}

/** A dashed curve in the ink that is chosen. */
function dashed(g, points, x, y) {
  g.setLineDash([4, 4]);
  g.globalAlpha = 0.7;
  g.beginPath();
  points.forEach(([time, v], i) => (i ? g.lineTo(x(time), y(v)) : g.moveTo(x(time), y(v))));
  g.stroke();
  g.globalAlpha = 1;
  g.setLineDash([]);
}

/** Ends the page of findings of a simulation: the numbers that were measured. */
function measuredNumbers(plan, page) {
  const rows = plan.verdict.checks.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, visible(value))]);
  page.append(el("h2", {}, "Measured"), el("div", { class: "data" }, el("dl", {}, rows)));
  return page;
}
