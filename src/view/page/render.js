// The renderer: bodies of any number by instancing, a sun and a sky with shadows, a ground, lines, picking.

const SUN = unit([0.42, -0.55, 1.05]);
const SHADOW_SIZE = 2048;
/** The shapes that every plan has, before the meshes of its own. */
const OWN_SHAPES = 3;
/** Copies of a mesh that are drawn at once, at most. */
const COPIES_MAX = 128;
/** Pixels of the map of one direction of the sky. */
const SKY_SIZE = 256;
const SKY_DETAIL = 0.15;
/** Pictures that are averaged while everything is at rest, each with a slightly other sun, sky and camera. */
const REFINED = 16;
/** How wide the sun is, rad; more than the real one, as behind thin clouds. */
const SUN_WIDE = 0.055;
/** The angle between directions that follow each other in a spiral, rad. */
const GOLDEN = Math.PI * (3 - Math.sqrt(5));

/** The sun in one of the pictures that are averaged. */
function sunOf(round) {
  const [side, up] = [unit(cross(SUN, [0, 0, 1])), unit(cross(SUN, [1, 0, 0]))];
  const [r, a] = [SUN_WIDE * Math.sqrt(round / REFINED), GOLDEN * round];
  return unit(add(SUN, add(scaled(side, r * Math.cos(a)), scaled(up, r * Math.sin(a)))));
}

/** The directions of the sky in one of the pictures, spread evenly over it, fewer at the horizon. */
function skyOf(round) {
  return Array.from({ length: SKIES }, (_, i) => {
    const z = Math.sqrt(1 - 0.97 * ((i + ((round * 7) % REFINED + 0.5) / REFINED) / SKIES));
    const a = GOLDEN * i + (2 * Math.PI * ((round * 5) % REFINED)) / REFINED;
    return [Math.cos(a) * Math.sqrt(1 - z * z), Math.sin(a) * Math.sqrt(1 - z * z), z];
  });
}

/** How far the camera looks beside the middle of each pixel, in pixels. */
const jitterOf = round => [((round * 5 + 2) % REFINED) / REFINED - 0.5, ((round * 7 + 9) % REFINED) / REFINED - 0.5];

/** Throws where WebGL 2 is missing. */
function rendererOf(canvas, plan, motion) {
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance", preserveDrawingBuffer: false });
  if (!gl) throw new Error("WebGL 2 is missing");
  // All are begun before the first is asked for: a browser makes them while the page goes on.
  const begun = Object.fromEntries(Object.entries(PROGRAMS).map(([name, texts]) => [name, beginProgram(gl, texts)]));
  const programs = {};
  const programOf = name => programs[name] || (programs[name] = finishProgram(gl, begun[name]));
  const quad = bufferOf(gl, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
  const square = arrayOf(gl, [[0, quad, 2, 8, 0, 0]]);
  let meshes = shapesOf(plan, DETAILS.map(detail => detail.round)).map(levels => levels.map(shape => meshOf(gl, shape)));
  const ghosts = [null, null];
  const shadows = shadowMap(gl, SHADOW_SIZE);
  const skies = shadowMap(gl, SKY_TILES * SKY_SIZE);
  const sum = sumTarget(gl);
  const smooth = smoothTarget(gl);
  const picking = pickTarget(gl);
  const lines = lineBatch(gl);
  const flats = { buffer: gl.createBuffer() };
  flats.array = arrayOf(gl, [[0, flats.buffer, 3, 12, 0, 0]]);
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const software = Boolean(about && /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)));
  const lists = new Map();
  /** What is drawn now, of the list of solids that was chosen from last. */
  let chosen = null;
  let calls = 0;

  function choose(solids, X, { camera, detail }, within) {
    if (!lists.has(solids)) lists.set(solids, instancesOf(gl, meshes, plan, motion, solids));
    chosen = lists.get(solids);
    chosen.choose(X, camera.matrix, pixelsOf() * detail, within);
  }

  function draw(what) {
    for (const batch of chosen.batches) calls += batch.draw(what);
    gl.disable(gl.CULL_FACE);
  }

  /** Pixels of a metre at a distance of one. */
  const pixelsOf = () => canvas.height / (2 * Math.tan(FOVY / 2));

  function use(name, uniforms) {
    const program = programOf(name);
    gl.useProgram(program.handle);
    // A map can't be read while it is drawn.
    [shadows, skies].forEach((map, i) => {
      gl.activeTexture(gl.TEXTURE0 + i);
      gl.bindTexture(gl.TEXTURE_2D, name === "depth" ? null : map.texture);
    });
    for (const [key, value] of Object.entries({ shadows: 0, skies: 1, instances: 2, ...uniforms })) program.set(key, value);
  }

  /** The view of light from a direction: a box around what is drawn, or of something long around what is near. */
  function lightView(scene, direction) {
    const near = 1.6 * scene.camera.distance;
    const middle = near < scene.radius ? scene.camera.target : scene.middle;
    const r = Math.min(near, scene.radius * 1.1);
    const eye = add(middle, scaled(direction, 3 * r));
    return times(orthographic(r, 0.5 * r, 6 * r), lookAt(eye, middle, [0, 1, 0]));
  }

  function drawMap(map, tiles) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, map.frame);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    for (const [x, y, size, view] of tiles) {
      gl.viewport(x, y, size, size);
      use("depth", { view });
      draw("faces");
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** The maps of the light in one of the pictures that are averaged. */
  function lightOf(scene, X, round) {
    const sunDirection = sunOf(round);
    const light = { sunDirection, sun: lightView(scene, sunDirection), skyViews: new Float32Array(16 * SKIES), skyDirections: new Float32Array(3 * SKIES) };
    const before = calls;
    if (scene.sky) {
      // The maps of the sky are small, and so is what they need of the bodies' detail.
      choose(scene.solids, X, { camera: scene.camera, detail: SKY_DETAIL * scene.detail }, null);
      const tiles = skyOf(round).map((direction, i) => {
        const view = lightView(scene, direction);
        light.skyViews.set(view, 16 * i);
        light.skyDirections.set(direction, 3 * i);
        return [SKY_SIZE * (i % SKY_TILES), SKY_SIZE * Math.floor(i / SKY_TILES), SKY_SIZE, view];
      });
      drawMap(skies, tiles);
    }
    // A body outside of the picture may still throw a shadow into it.
    choose(scene.solids, X, scene, scene.shadow ? null : scene.camera.matrix);
    if (scene.shadow) drawMap(shadows, [[0, 0, SHADOW_SIZE, light.sun]]);
    // Maps are counted once, by direction: what is counted are the calls that it takes to draw everything.
    calls = before;
    return light;
  }

  function render(scene, X, round = 0) {
    calls = 0;
    const { camera, theme } = scene;
    const light = lightOf(scene, X, round);
    const [dx, dy] = round ? jitterOf(round) : [0, 0];
    const aside = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, (2 * dx) / canvas.width, (2 * dy) / canvas.height, 0, 1]);
    const view = times(aside, camera.matrix);
    // What is averaged needs no soft edges of its own, nor does, where they take long, what will be soon.
    const averaged = scene.smooth && sum.there && scene.sky;
    const single = averaged && (round > 0 || software);
    const target = !scene.smooth ? null : single ? sum.sized(canvas.width, canvas.height) : smooth.sized(canvas.width, canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    use("sky", { above: theme.above, below: theme.below });
    gl.bindVertexArray(square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    calls++;
    gl.enable(gl.DEPTH_TEST);
    const pixels = pixelsOf();
    const common = {
      view, ...light, eye: camera.eye, dark: theme.dark ? 1 : 0, paper: theme.figure ? 1 : 0, pixels,
      shadowed: scene.shadow ? 1 : 0, open: scene.sky ? 0 : 1, reach: 0.006 * Math.min(scene.radius, camera.distance),
    };
    use("solid" + (scene.sky ? "" : scene.shadow ? "Plain" : "Bare"), { ...common, opacity: 1 });
    draw("faces");
    gl.enable(gl.BLEND);
    // The canvas stays opaque.
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (scene.edges) {
      use("edge", { ...common, opacity: 1 });
      draw("lines");
    }
    drawGround(scene, common);
    scene.ghosts.forEach((shown, i) => shown && drawGhost(scene, common, scene.solids, ghosts[i], i));
    if (scene.target) drawGhost(scene, common, scene.target, X, -1);
    gl.depthMask(false);
    if (scene.area.length) drawArea(scene, view);
    drawLines(view, scene.lines);
    // The most important marks are drawn on top of everything.
    gl.disable(gl.DEPTH_TEST);
    drawLines(view, scene.marks);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
    return { calls, averaged, single };
  }

  /** One of the pictures that are averaged, from the first on; says whether it is shown and another would be better. */
  function show(scene, X, round) {
    const { calls: found, averaged, single } = render(scene, X, round);
    if (averaged) {
      sum.add(canvas.width, canvas.height, single ? null : smooth.frame, round, mean);
      return { calls: found, more: round + 1 < REFINED };
    }
    if (scene.smooth) sum.show(canvas.width, canvas.height, smooth.frame, mean);
    return { calls: found, more: false };
  }

  /** Draws a part of a picture into a target, in place of what is there, or `added` to it. */
  function mean(target, texture, part, added) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.DEPTH_TEST);
    if (added) gl.enable(gl.BLEND), gl.blendFunc(gl.ONE, gl.ONE);
    use("mean", { pictures: 0, part });
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.bindVertexArray(square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  function drawGround(scene, common) {
    gl.depthMask(false);
    const { middle, radius, camera, grain, theme } = scene;
    const width = Math.max(radius * 6, norm(sub(camera.eye, middle)) * 2.5);
    use(scene.sky ? "ground" : "groundPlain", {
      ...common, patch_: [middle[0], middle[1], scene.ground ? scene.floor : scene.lowest, width], slope: scene.slope, ink: theme.ink, axisX: theme.axisX, axisY: theme.axisY,
      step_: gridStep(grain), strength: theme.dark ? 1.7 : 1, there: scene.ground ? 1 : 0, lines_: scene.grid ? (scene.ground ? 1 : 0.7) : 0,
    });
    gl.bindVertexArray(square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    calls++;
    gl.depthMask(true);
  }

  /** Depth first, then colour once: what lies behind a ghost's own surface stays hidden. */
  function drawGhost(scene, common, solids, X, i) {
    choose(solids, X, scene, scene.camera.matrix);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 8);
    gl.colorMask(false, false, false, false);
    use("depth", { view: common.view });
    draw("faces");
    gl.colorMask(true, true, true, true);
    gl.depthFunc(gl.LEQUAL);
    use("solid", { ...common, opacity: 0.2, shadowed: 0, open: 1 });
    //: if (i === 2) programOf("solid").set("opacity", 0.34);
    draw("faces");
    gl.disable(gl.POLYGON_OFFSET_FILL);
    use("edge", { ...common, opacity: 0.8 });
    draw("lines");
    gl.depthFunc(gl.LESS);
  }

  function drawArea(scene, view) {
    const fan = [];
    for (let i = 2; i < scene.area.length; i++)
      for (const p of [scene.area[0], scene.area[i - 1], scene.area[i]]) fan.push(p[0], p[1], scene.floorAt(p) + 0.0005);
    if (!fan.length) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, flats.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(fan), gl.STREAM_DRAW);
    use("flat", { view, tint: [...scene.theme.good, 0.22] });
    gl.bindVertexArray(flats.array);
    gl.drawArrays(gl.TRIANGLES, 0, fan.length / 3);
    calls++;
  }

  function drawLines(view, list) {
    if (!list.length) return;
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    use("line", { view, screen: [canvas.width, canvas.height] });
    lines.draw(list, ratio);
    calls++;
  }

  /** The body under a place of the canvas (x, y in 0..1 from the top left), or -1; `depth`: how deep it is there, 0..1, or
      -1. */
  function pick(scene, X, x, y, depth = false) {
    const width = 4 / canvas.width;
    const height = 4 / canvas.height;
    // The view narrowed to the pixel.
    const narrow = new Float32Array([1 / width, 0, 0, 0, 0, 1 / height, 0, 0, 0, 0, 1, 0, (1 - 2 * x) / width, (2 * y - 1) / height, 0, 1]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, picking.frame);
    gl.viewport(0, 0, 1, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const view = times(narrow, scene.camera.matrix);
    choose(scene.solids, X, scene, view);
    use("pick", { view, depth: depth ? 1 : 0 });
    draw("faces");
    const found = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const value = found[0] + 256 * found[1] + 65536 * found[2];
    return depth ? (found[3] ? value / 16777215 : -1) : value - 1;
  }

  /** Draws something else from now on. */
  function replace(...next) {
    [plan, motion] = next;
    meshes = [...meshes.slice(0, OWN_SHAPES), ...(plan.meshes || []).map(mesh => [meshOf(gl, meshShape(mesh))])];
    for (const { batches } of lists.values()) for (const batch of batches) batch.free();
    lists.clear();
  }

  return { gl, software, show, pick, replace, ready: () => Object.keys(PROGRAMS).forEach(programOf), ghosts };
}

function beginProgram(gl, texts) {
  const handle = gl.createProgram();
  [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((kind, i) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, texts[i]);
    gl.compileShader(shader);
    gl.attachShader(handle, shader);
  });
  gl.linkProgram(handle);
  return handle;
}

function finishProgram(gl, handle) {
  if (!gl.getProgramParameter(handle, gl.LINK_STATUS)) {
    const logs = gl.getAttachedShaders(handle).map(shader => gl.getShaderInfoLog(shader));
    throw new Error(["a shader failed", ...logs, gl.getProgramInfoLog(handle)].join("\n"));
  }
  const uniforms = new Map();
  for (let i = 0; i < gl.getProgramParameter(handle, gl.ACTIVE_UNIFORMS); i++) {
    const { name, type } = gl.getActiveUniform(handle, i);
    uniforms.set(name.replace("[0]", ""), { at: gl.getUniformLocation(handle, name), type });
  }
  const set = (name, value) => {
    const uniform = uniforms.get(name);
    if (!uniform) return;
    const { at, type } = uniform;
    if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, value);
    else if (type === gl.FLOAT_VEC4) gl.uniform4fv(at, value);
    else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
    else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
    else if (type === gl.FLOAT) gl.uniform1f(at, value);
    else gl.uniform1i(at, value);
  };
  return { handle, set };
}

function bufferOf(gl, data, kind = gl.ARRAY_BUFFER) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, gl.STATIC_DRAW);
  return buffer;
}

/** A vertex array of attributes [location, buffer, numbers, stride, offset, divisor], with its indices. */
function arrayOf(gl, attributes, index = null) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  for (const [location, buffer, numbers, stride, offset, divisor] of attributes) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, numbers, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(location, divisor);
  }
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index);
  gl.bindVertexArray(null);
  return array;
}

/** The first link of a module keeps its colour; the others are lighter and darker by turns. */
const SHADES = [0, 0.22, -0.42, -0.3, -0.3, 0.34, -0.2, 0.12];

/** A mesh on the graphics processor, in copies that follow each other; every corner knows which it is of, and of how many. */
function meshOf(gl, { faces, index, lines }) {
  const copies = clamp(Math.floor(DRAWN_AT_ONCE / Math.max(index.length, 1)), 1, COPIES_MAX);
  const own = (corners, size) => {
    const count = corners.length / size;
    const all = new Float32Array(copies * count * (size + 2));
    for (let i = 0; i < copies * count; i++) {
      const from = size * (i % count);
      all.set(corners.subarray(from, from + size), (size + 2) * i);
      all.set([Math.floor(i / count), copies], (size + 2) * i + size);
    }
    return bufferOf(gl, all);
  };
  const count = faces.length / 9;
  const indices = new Uint32Array(copies * index.length);
  for (let i = 0; i < indices.length; i++) indices[i] = index[i % index.length] + count * Math.floor(i / index.length);
  const [corners, ends] = [own(faces, 9), own(lines, 6)];
  return {
    copies,
    faces: { length: index.length, array: arrayOf(gl, [[0, corners, 3, 44, 0, 0], [1, corners, 3, 44, 12, 0], [2, corners, 3, 44, 24, 0], [3, corners, 2, 44, 36, 0]], bufferOf(gl, indices, gl.ELEMENT_ARRAY_BUFFER)) },
    lines: { length: lines.length / 6, array: arrayOf(gl, [[0, ends, 3, 32, 0, 0], [2, ends, 3, 32, 12, 0], [3, ends, 2, 32, 24, 0]]) },
  };
}

/** A depth map that is read with comparison. */
function shadowMap(gl, size) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, size, size);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.LINEAR);
  for (const key of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, key, gl.CLAMP_TO_EDGE);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.drawBuffers([gl.NONE]);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, frame };
}

/** Where pictures are added up, in numbers finer than those of a screen. */
function sumTarget(gl) {
  const there = Boolean(gl.getExtension("EXT_color_buffer_float") || gl.getExtension("EXT_color_buffer_half_float"));
  const frames = [gl.createFramebuffer(), gl.createFramebuffer()];
  const textures = [null, null];
  const depth = gl.createRenderbuffer();
  let [wide, high] = [0, 0];
  function sized(width, height) {
    if (wide === width && high === height) return frames[0];
    [wide, high] = [width, height];
    [gl.RGBA8, gl.RGBA16F].forEach((format, i) => {
      gl.deleteTexture(textures[i]);
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, (textures[i] = gl.createTexture()));
      gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
      for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, frames[i]);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, textures[i], 0);
    });
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frames[0]);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    return frames[0];
  }
  /** Makes one sample a pixel of what was drawn into `frame`. */
  function resolve(frame) {
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frames[0]);
    gl.blitFramebuffer(0, 0, wide, high, 0, 0, wide, high, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }
  return {
    there,
    sized,
    /** Adds what was drawn, into `frame` or here, to the sum, which it begins anew at the first round, and shows the mean. */
    add(width, height, frame, round, drawn) {
      sized(width, height);
      if (frame) resolve(frame);
      drawn(frames[1], textures[0], 1, round > 0);
      drawn(null, textures[1], 1 / (round + 1), false);
    },
    /** Shows what was drawn into `frame`; the canvas, which has no opacity, can't take it in directly. */
    show(width, height, frame, drawn) {
      sized(width, height);
      resolve(frame);
      drawn(null, textures[0], 1, false);
    },
  };
}

/** Where a picture with soft edges is drawn, of several samples a pixel, before it is shown. The canvas
    has none of its own, so that what needs speed can do without. */
function smoothTarget(gl) {
  const frame = gl.createFramebuffer();
  const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
  const buffers = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]].map(kind => [gl.createRenderbuffer(), ...kind]);
  let [wide, high] = [0, 0];
  return {
    frame,
    sized(width, height) {
      if (wide === width && high === height) return frame;
      [wide, high] = [width, height];
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      for (const [buffer, format, place] of buffers) {
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
      }
      return frame;
    },
  };
}

function pickTarget(gl) {
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  for (const [format, place] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { frame };
}

/** Lines {a, b, width, colour: [r, g, b, a]}, drawn in one call. */
function lineBatch(gl) {
  const corners = bufferOf(gl, new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]));
  const buffer = gl.createBuffer();
  const array = arrayOf(gl, [[0, corners, 2, 8, 0, 0], [1, buffer, 4, 44, 0, 1], [2, buffer, 3, 44, 16, 1], [3, buffer, 4, 44, 28, 1]]);
  return {
    draw(list, ratio) {
      const data = new Float32Array(11 * list.length);
      list.forEach(({ a, b, width, colour }, i) => data.set([...a, width * ratio, ...b, ...colour], 11 * i));
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STREAM_DRAW);
      gl.bindVertexArray(array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, list.length);
    },
  };
}
