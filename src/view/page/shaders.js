// The programs that run on the graphics processor.

const HEAD = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp sampler2DShadow;\n";

/** Each instance carries the three sides of what it draws, in the world, and its place. */
const BODY = `
layout(location=0) in vec3 corner;
layout(location=1) in vec3 normal;
layout(location=2) in vec4 along;   // w: x of the place, of the others y and z
layout(location=3) in vec4 across;
layout(location=4) in vec4 up;
layout(location=5) in vec4 tint;    // w: glow
layout(location=6) in float body;
vec3 place() { return vec3(along.w, across.w, up.w); }
vec3 sides() { return vec3(length(along.xyz), length(across.xyz), length(up.xyz)); }
vec3 grown(vec3 by) {
  vec3 c = corner * by;
  return place() + along.xyz * c.x + across.xyz * c.y + up.xyz * c.z;
}
vec3 world() { return grown(vec3(1.0)); }
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
out float glow;
void main() {
  // A line thinner than a pixel would appear as dots, or not at all.
  float away = (view * vec4(place(), 1.0)).w;
  at = grown(max(vec3(1.0), 1.1 * away / (pixels * sides())));
  facing = worldNormal();
  // Light adds up in squares of what is shown, which is near enough to what screens do.
  colour = tint.rgb * tint.rgb;
  glow = tint.a;
  lit = sun * vec4(at + facing * 0.002, 1.0);
  gl_Position = view * vec4(at, 1.0);
}`;

const LIGHT = `
uniform sampler2DShadow shadows;
uniform float shadowed;
float sunlight(vec4 lit) {
  vec3 p = lit.xyz / lit.w * 0.5 + 0.5;
  if (shadowed < 0.5 || any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
  float sum = 0.0, texel = 1.0 / float(textureSize(shadows, 0).x);
  for (float x = -0.9; x < 1.0; x += 1.8)
    for (float y = -0.9; y < 1.0; y += 1.8) sum += texture(shadows, vec3(p.xy + vec2(x, y) * texel, p.z - 0.0015));
  return sum / 4.0;
}
`;

const SOLID_FRAGMENT = HEAD + LIGHT + `
uniform vec3 eye, sunDirection;
uniform float opacity, dark;
in vec3 at, facing, colour;
in vec4 lit;
in float glow;
out vec4 shown;
void main() {
  vec3 n = normalize(facing), v = normalize(eye - at);
  float direct = max(dot(n, sunDirection), 0.0) * sunlight(lit);
  float back = max(dot(n, vec3(-sunDirection.xy, 0.25)), 0.0);
  vec3 sky = mix(vec3(0.30, 0.29, 0.28), vec3(0.56, 0.60, 0.66), n.z * 0.5 + 0.5) * mix(1.0, 0.72, dark);
  vec3 c = colour * (sky + direct * vec3(0.92, 0.88, 0.80) + back * 0.10);
  float gloss = max(dot(n, normalize(sunDirection + v)), 0.0), rim = 1.0 - max(dot(n, v), 0.0);
  gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
  c += 0.10 * gloss * direct + colour * 0.35 * rim * rim * rim;
  c = mix(c, colour * 1.5 + 0.12, glow);
  shown = vec4(sqrt(c), opacity);
}`;

const EDGE_VERTEX = HEAD + BODY + `
uniform mat4 view;
uniform float pixels;               // of a metre at a distance of one
out vec3 colour;
out float strength;
void main() {
  colour = tint.rgb;
  gl_Position = view * vec4(world(), 1.0);
  // Edges of what is small on the screen would cover it.
  strength = smoothstep(5.0, 28.0, length(sides()) * pixels / gl_Position.w);
  gl_Position.z -= 0.00015 * gl_Position.w;
}`;

const EDGE_FRAGMENT = HEAD + `
uniform float opacity, dark;
in vec3 colour;
in float strength;
out vec4 shown;
void main() { shown = vec4(colour * mix(0.42, 0.32, dark), opacity * strength); }`;

const DEPTH_VERTEX = HEAD + BODY + `
uniform mat4 view;
void main() { gl_Position = view * vec4(world(), 1.0); }`;
const DEPTH_FRAGMENT = HEAD + `void main() {}`;

const PICK_VERTEX = HEAD + BODY + `
uniform mat4 view;
flat out int found;
void main() { found = int(body) + 1; gl_Position = view * vec4(world(), 1.0); }`;
const PICK_FRAGMENT = HEAD + `
flat in int found;
out vec4 shown;
void main() { shown = vec4(found & 255, (found >> 8) & 255, (found >> 16) & 255, 255) / 255.0; }`;

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
uniform vec3 ink;
uniform float step_, strength;
in vec2 at;
in vec4 lit;
out vec4 shown;
float grid(float width) {
  vec2 g = abs(fract(at / width - 0.5) - 0.5) * width, w = fwidth(at);
  vec2 line = 1.0 - smoothstep(w * 0.4, w * 1.4, g);
  // Lines closer than two pixels would only be noise.
  return max(line.x, line.y) * clamp(width / max(w.x, w.y) / 8.0 - 0.25, 0.0, 1.0);
}
void main() {
  float away = length(at - patch_.xy) / patch_.w;
  float fade = 1.0 - smoothstep(0.15, 0.95, away);
  float lines = max(grid(step_) * 0.10, grid(step_ * 10.0) * 0.22);
  float shade = (1.0 - sunlight(lit)) * 0.34 * strength;
  shown = vec4(ink, 1.0 - (1.0 - lines) * (1.0 - shade)) * vec4(1.0, 1.0, 1.0, fade);
}`;

const SKY_VERTEX = HEAD + `
layout(location=0) in vec2 corner;
out float up;
void main() { up = corner.y * 0.5 + 0.5; gl_Position = vec4(corner, 0.9999, 1.0); }`;
const SKY_FRAGMENT = HEAD + `
uniform vec3 above, below;
in float up;
out vec4 shown;
void main() { shown = vec4(mix(below, above, smoothstep(0.1, 1.0, up)), 1.0); }`;

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

/** Vertex and fragment program of each. */
const PROGRAMS = {
  solid: [SOLID_VERTEX, SOLID_FRAGMENT], edge: [EDGE_VERTEX, EDGE_FRAGMENT], depth: [DEPTH_VERTEX, DEPTH_FRAGMENT],
  pick: [PICK_VERTEX, PICK_FRAGMENT], ground: [GROUND_VERTEX, GROUND_FRAGMENT], sky: [SKY_VERTEX, SKY_FRAGMENT],
  line: [LINE_VERTEX, LINE_FRAGMENT], flat: [FLAT_VERTEX, FLAT_FRAGMENT],
};
