// The programs that run on the graphics processor.

const HEAD = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp sampler2DShadow;\n";

/** Directions of the sky whose light is followed at once: tiles of one map, four by four. */
const SKIES = 16;
const SKY_TILES = 4;

/** Instances in a row of the texture that they lie in. */
const PER_ROW = 200;

/** Each instance carries the three sides of what it draws, in the world, and its place. Edges of boxes and cylinders are
    rounded: `inset` says how many radii a corner is drawn in from the sides. */
const BODY = `
layout(location=0) in vec3 corner;
layout(location=1) in vec3 normal;
layout(location=2) in vec3 inset;
layout(location=3) in vec2 copy;    // which of how many
uniform sampler2D instances;
vec4 along, across, up;             // w: x of the place, of the others y and z
vec4 tint;                          // w: glow
float body;
vec4 part(int i) {
  int instance = int(copy.x) + gl_InstanceID * int(copy.y);
  return texelFetch(instances, ivec2(instance % ${PER_ROW} * 5 + i, instance / ${PER_ROW}), 0);
}
/** Everything about the instance: comes first. */
void read() {
  along = part(0);
  across = part(1);
  up = part(2);
  tint = part(3);
  body = part(4).x;
}
vec3 place() { return vec3(along.w, across.w, up.w); }
vec3 sides() { return vec3(length(along.xyz), length(across.xyz), length(up.xyz)); }
vec3 grown(vec3 by) {
  vec3 s = sides(), round = 0.085 * min(s.x, min(s.y, s.z)) / max(s, vec3(1e-12));
  vec3 c = (corner - inset * round) * by;
  return place() + along.xyz * c.x + across.xyz * c.y + up.xyz * c.z;
}
vec3 world() { return grown(vec3(1.0)); }
/** A line thinner than a pixel would appear as dots, or not at all. */
vec3 thick(mat4 view, float pixels) {
  float away = dot(vec4(view[0].w, view[1].w, view[2].w, view[3].w), vec4(place(), 1.0));
  return grown(max(vec3(1.0), 1.1 * away / (pixels * sides())));
}
/** By the cofactors of the sides, which hold for any of them. */
vec3 worldNormal() {
  return normalize(cross(across.xyz, up.xyz) * normal.x + cross(up.xyz, along.xyz) * normal.y + cross(along.xyz, across.xyz) * normal.z);
}
`;

const SOLID_VERTEX = HEAD + BODY + `
uniform mat4 view, sun;
uniform float pixels;               // of a metre at a distance of one
out vec3 at, facing, colour;
out vec4 lit;
out float glow, metal;
void main() {
  read();
  at = thick(view, pixels);
  facing = worldNormal();
  // Light adds up in squares of what is shown, which is near enough to what screens do.
  colour = tint.rgb * tint.rgb;
  metal = tint.a < 0.0 ? 1.0 : 0.0;
  glow = max(tint.a, 0.0);
  lit = sun * vec4(at + facing * 0.002, 1.0);
  gl_Position = view * vec4(at, 1.0);
}`;

/** Light of the sun, through a map of its own, and of the sky, through a map with a tile for each direction. */
const LIGHT = `
uniform sampler2DShadow shadows, skies;
uniform float shadowed, open;
uniform mat4 skyViews[${SKIES}];
uniform vec3 skyDirections[${SKIES}];
float sunlight(vec4 lit) {
  vec3 p = lit.xyz / lit.w * 0.5 + 0.5;
  if (shadowed < 0.5 || any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
#ifdef PLAIN
  return texture(shadows, vec3(p.xy, p.z - 0.0015));
#else
  float sum = 0.0, texel = 1.0 / float(textureSize(shadows, 0).x);
  for (float x = -0.9; x < 1.0; x += 1.8)
    for (float y = -0.9; y < 1.0; y += 1.8) sum += texture(shadows, vec3(p.xy + vec2(x, y) * texel, p.z - 0.0015));
  return sum / 4.0;
#endif
}
/** What of the sky is seen from a point: of what shines on its side, and of all. */
vec2 skylight(vec3 at, vec3 n) {
#ifdef PLAIN
  return vec2(1.0);
#else
  if (open > 0.5) return vec2(1.0);
  float sum = 0.0, weights = 0.0, all = 0.0;
  for (int i = 0; i < ${SKIES}; i++) {
    vec3 p = (skyViews[i] * vec4(at, 1.0)).xyz * 0.5 + 0.5;
    vec2 tile = vec2(i % ${SKY_TILES}, i / ${SKY_TILES});
    float seen = any(lessThan(p, vec3(0.004))) || any(greaterThan(p, vec3(0.996))) ? 1.0
      : texture(skies, vec3((p.xy + tile) / ${SKY_TILES}.0, p.z - 0.003));
    float weight = max(dot(n, skyDirections[i]), 0.0) + 0.02;
    sum += weight * seen;
    weights += weight;
    all += seen;
  }
  return vec2(sum / weights, all / ${SKIES}.0);
#endif
}
`;

/** What shines on a surface beside the sun: from above, from below, and from the other side. `sky`: what of it is seen. */
const SHINE = `
uniform vec3 sunDirection;
uniform float dark, paper;
vec3 ambientOf(vec3 n, vec2 sky) {
  float up = n.z * 0.5 + 0.5, side = max(dot(n, normalize(vec3(-sunDirection.xy, 0.3))), 0.0);
  vec3 ambient = mix(vec3(0.50, 0.54, 0.60), vec3(0.74), paper) * mix(1.0, 0.62, dark) * (0.35 + 0.65 * up) * mix(0.12, 1.0, sky.x);
  ambient += mix(vec3(0.26, 0.245, 0.225), vec3(0.26), paper) * mix(1.0, 0.55, dark) * (1.0 - up) * mix(0.3, 1.0, sky.y);
  return ambient + side * vec3(0.17, 0.175, 0.19) * mix(0.4, 1.0, sky.y);
}
vec3 sunColour() { return mix(vec3(0.74, 0.705, 0.65), vec3(0.52), paper); }
/** Bright light is compressed, and not cut off. */
vec3 seen(vec3 c) { return sqrt(c / (1.0 + max(c - 0.6, 0.0) * 0.7)); }
`;

const SOLID_FRAGMENT = HEAD + LIGHT + SHINE + `
uniform vec3 eye;
uniform float opacity, reach;
in vec3 at, facing, colour;
in vec4 lit;
in float glow, metal;
out vec4 shown;
void main() {
  vec3 n = normalize(facing), v = normalize(eye - at), h = normalize(sunDirection + v);
  float direct = max(dot(n, sunDirection), 0.0) * sunlight(lit);
  vec2 sky = skylight(at + n * reach, n);
  vec3 c = colour * (ambientOf(n, sky) + direct * sunColour());
  // A rough surface: a broad highlight, and what the sky leaves at grazing angles.
  float rough = mix(0.42, 0.30, metal), a = rough * rough, d = dot(n, h) * dot(n, h) * (a * a - 1.0) + 1.0;
  float gloss = min(a * a / (4.0 * d * d), 6.0) * mix(0.06, 0.24, metal);
  float rim = 1.0 - max(dot(n, v), 0.0);
  rim *= rim;
  rim *= rim;
  c += (gloss * direct + rim * 0.10 * sky.x * (0.7 + 0.3 * n.z)) * mix(vec3(1.0), colour * 2.2, metal * 0.5) * mix(1.0, 0.4, paper);
  shown = vec4(seen(mix(c, colour * 1.3 + 0.10, glow)), opacity);
}`;

/** The same without the light of the sky and without highlights, worked out at corners, for what has to be fast. */
const PLAIN_VERTEX = HEAD + BODY + SHINE + `
uniform mat4 view, sun;
uniform float pixels;               // of a metre at a distance of one
out vec3 shade, sunny;
out vec4 lit;
void main() {
  read();
  vec3 at = thick(view, pixels), n = worldNormal(), colour = tint.rgb * tint.rgb;
  float glow = max(tint.a, 0.0);
  shade = mix(colour * ambientOf(n, vec2(1.0)), colour * 1.3 + 0.10, glow);
  sunny = colour * max(dot(n, sunDirection), 0.0) * sunColour() * (1.0 - glow);
  lit = sun * vec4(at + n * 0.002, 1.0);
  gl_Position = view * vec4(at, 1.0);
}`;
const PLAIN_FRAGMENT = HEAD + "#define PLAIN\n" + LIGHT + SHINE + `
uniform float opacity;
in vec3 shade, sunny;
in vec4 lit;
out vec4 shown;
void main() { shown = vec4(seen(shade + sunny * sunlight(lit)), opacity); }`;

/** And without shadows. */
const BARE_VERTEX = PLAIN_VERTEX.replace("out vec3 shade, sunny;\nout vec4 lit;", "vec3 shade, sunny;\nvec4 lit;\nout vec3 colour_;").replace(/}$/, "  colour_ = seen(shade + sunny);\n}");
const BARE_FRAGMENT = HEAD + `
uniform float opacity;
in vec3 colour_;
out vec4 shown;
void main() { shown = vec4(colour_, opacity); }`;

const EDGE_VERTEX = HEAD + BODY + `
uniform mat4 view;
uniform float pixels;               // of a metre at a distance of one
out vec3 colour;
out float strength;
void main() {
  read();
  colour = tint.rgb;
  gl_Position = view * vec4(world(), 1.0);
  // Edges of what is small on the screen would cover it.
  strength = smoothstep(5.0, 28.0, length(sides()) * pixels / gl_Position.w);
  gl_Position.z -= 0.00015 * gl_Position.w;
}`;

const EDGE_FRAGMENT = HEAD + `
uniform float opacity, dark, paper;
in vec3 colour;
in float strength;
out vec4 shown;
void main() { shown = vec4(colour * mix(0.55, 0.4, dark) * (1.0 - 0.75 * paper), opacity * strength * mix(0.38, 0.9, paper)); }`;

const DEPTH_VERTEX = HEAD + BODY + `
uniform mat4 view;
void main() { read(); gl_Position = view * vec4(world(), 1.0); }`;
const DEPTH_FRAGMENT = HEAD + `void main() {}`;

const PICK_VERTEX = HEAD + BODY + `
uniform mat4 view;
flat out int found;
void main() { read(); found = int(body) + 1; gl_Position = view * vec4(world(), 1.0); }`;
const PICK_FRAGMENT = HEAD + `
uniform float depth;                // whether the depth is asked for, and not the body
flat in int found;
out vec4 shown;
void main() {
  int value = depth > 0.5 ? int(gl_FragCoord.z * 16777215.0) : found;
  shown = vec4(value & 255, (value >> 8) & 255, (value >> 16) & 255, 255) / 255.0;
}`;

const GROUND_VERTEX = HEAD + `
uniform mat4 view, sun;
uniform vec4 patch_;               // middle, half the width
uniform vec2 slope;
layout(location=0) in vec2 corner;
out vec2 at;
out vec4 lit;
void main() {
  at = patch_.xy + corner * patch_.w;
  vec4 p = vec4(at, patch_.z + dot(slope, at), 1.0);
  lit = sun * p;
  gl_Position = view * p;
}`;
const GROUND_FRAGMENT = HEAD + LIGHT + `
uniform vec4 patch_;
uniform vec3 ink, axisX, axisY;
uniform vec2 slope;
uniform float step_, strength, reach, there, lines_;
in vec2 at;
in vec4 lit;
out vec4 shown;
float grid(float width, vec2 w) {
  vec2 g = abs(fract(at / width - 0.5) - 0.5) * width;
  vec2 line = 1.0 - smoothstep(w * 0.3, w * 1.0, g);
  // Lines closer than two pixels would only be noise.
  return max(line.x, line.y) * clamp(width / max(w.x, w.y) / 8.0 - 0.25, 0.0, 1.0);
}
void main() {
  float away = length(at - patch_.xy) / patch_.w;
  float fade = 1.0 - smoothstep(0.10, 0.85, away);
  vec2 w = fwidth(at);
  float lines = max(grid(step_, w) * 0.075, grid(step_ * 10.0, w) * 0.17) * lines_;
  vec2 axis = (1.0 - smoothstep(w * 0.4, w * 1.2, abs(at))).yx * 0.38 * lines_;
  float shade = 0.0;
  if (there > 0.5) {
    vec3 n = normalize(vec3(-slope, 1.0));
    float sky = skylight(vec3(at, patch_.z + dot(slope, at)) + n * reach, n).x;
    shade = 1.0 - (1.0 - (1.0 - sunlight(lit)) * 0.24 * strength) * mix(1.0, sky, 0.55);
  }
  vec3 c = mix(mix(ink, axisX, axis.x > 0.02 ? 1.0 : 0.0), axisY, axis.y > 0.02 ? 1.0 : 0.0);
  float drawn = 1.0 - (1.0 - max(lines, max(axis.x, axis.y))) * (1.0 - shade);
  shown = vec4(mix(ink, c, step(shade, max(axis.x, axis.y))), drawn * fade);
}`;

const SKY_VERTEX = HEAD + `
layout(location=0) in vec2 corner;
out float up;
void main() { up = corner.y * 0.5 + 0.5; gl_Position = vec4(corner, 0.9999, 1.0); }`;
const SKY_FRAGMENT = HEAD + `
uniform vec3 above, below;
in float up;
out vec4 shown;
void main() { shown = vec4(mix(below, above, smoothstep(0.0, 1.0, up)), 1.0); }`;

/** A picture added to others, or shown: a part of each. */
const MEAN_VERTEX = HEAD + `
layout(location=0) in vec2 corner;
out vec2 at;
void main() { at = corner * 0.5 + 0.5; gl_Position = vec4(corner, 0.0, 1.0); }`;
const MEAN_FRAGMENT = HEAD + `
uniform sampler2D pictures;
uniform float part;
in vec2 at;
out vec4 shown;
void main() { shown = vec4(texture(pictures, at).rgb * part, 1.0); }`;

/** Lines as wide as asked for, in pixels; four corners each. */
const LINE_VERTEX = HEAD + `
uniform mat4 view;
uniform vec2 screen;
layout(location=0) in vec2 corner;  // which end, which side
layout(location=1) in vec4 from;    // w: width
layout(location=2) in vec3 to;
layout(location=3) in vec4 tint;
out vec4 colour;
void main() {
  vec4 a = view * vec4(from.xyz, 1.0), b = view * vec4(to, 1.0);
  // A point behind the camera has no direction on the screen.
  if (a.w < 0.001) a = mix(a, b, (0.001 - a.w) / (b.w - a.w));
  if (b.w < 0.001) b = mix(b, a, (0.001 - b.w) / (a.w - b.w));
  vec2 d = (b.xy / b.w - a.xy / a.w) * screen;
  d = length(d) > 0.0001 ? normalize(d) : vec2(0.0, 1.0);
  gl_Position = corner.x < 0.5 ? a : b;
  // With square ends, so that a line of no length is a dot.
  vec2 off = vec2(-d.y, d.x) * corner.y + d * (corner.x < 0.5 ? -1.0 : 1.0);
  gl_Position.xy += off / screen * from.w * gl_Position.w;
  gl_Position.z -= 0.0003 * gl_Position.w;
  colour = tint;
}`;
const LINE_FRAGMENT = HEAD + `
in vec4 colour;
out vec4 shown;
void main() { shown = colour; }`;

const FLAT_VERTEX = HEAD + `
uniform mat4 view;
layout(location=0) in vec3 corner;
void main() { gl_Position = view * vec4(corner, 1.0); gl_Position.z -= 0.0001 * gl_Position.w; }`;
const FLAT_FRAGMENT = HEAD + `
uniform vec4 tint;
out vec4 shown;
void main() { shown = tint; }`;

/** The same program without the light of the sky, and with harder shadows, for what has to be fast. */
const plain = text => text.replace(HEAD, HEAD + "#define PLAIN\n");

/** Vertex and fragment program of each. */
const PROGRAMS = {
  solid: [SOLID_VERTEX, SOLID_FRAGMENT], edge: [EDGE_VERTEX, EDGE_FRAGMENT], depth: [DEPTH_VERTEX, DEPTH_FRAGMENT],
  pick: [PICK_VERTEX, PICK_FRAGMENT], ground: [GROUND_VERTEX, GROUND_FRAGMENT], sky: [SKY_VERTEX, SKY_FRAGMENT],
  solidPlain: [PLAIN_VERTEX, PLAIN_FRAGMENT], solidBare: [BARE_VERTEX, BARE_FRAGMENT], groundPlain: [GROUND_VERTEX, plain(GROUND_FRAGMENT)],
  line: [LINE_VERTEX, LINE_FRAGMENT], flat: [FLAT_VERTEX, FLAT_FRAGMENT], mean: [MEAN_VERTEX, MEAN_FRAGMENT],
};
