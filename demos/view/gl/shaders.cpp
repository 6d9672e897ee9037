#include "gl/shaders.h"

namespace tandem::view::shaders {

const char* const kPlaceOfABody = R"(
layout(location = 0) in vec3 point;
layout(location = 2) in vec3 origin;
layout(location = 3) in vec4 turn;

vec3 rotate(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}
vec3 place() { return origin + rotate(turn, point); }
)";

const char* const kSolidVertex = R"(
layout(location = 1) in vec3 normal;
layout(location = 4) in vec3 colour;
uniform mat4 world_to_clip;
uniform mat4 world_to_shadow;
uniform float shadow_offset;
out vec3 p_W;
out vec3 n_W;
out vec3 p_shadow;
flat out vec3 albedo;

void main() {
  n_W = rotate(turn, normal);
  p_W = place();
  // A surface must not shadow itself, so the shadow is looked up a little outside of it.
  p_shadow = (world_to_shadow * vec4(p_W + shadow_offset * n_W, 1.0)).xyz;
  albedo = colour;
  gl_Position = world_to_clip * vec4(p_W, 1.0);
}
)";

const char* const kSolidFragment = R"(
in vec3 p_W;
in vec3 n_W;
in vec3 p_shadow;
flat in vec3 albedo;
uniform vec3 eye_W;
uniform vec3 sun_W;
uniform sampler2DShadow shadow;
out vec4 picture;

const vec3 kSun = vec3(0.72, 0.69, 0.64);
const vec3 kSky = vec3(0.43, 0.45, 0.48);
const vec3 kGround = vec3(0.27, 0.26, 0.25);

// Part of the sun that no body hides. Each look-up blends 2 x 2 pixels of the map.
#if defined SOFT_SHADOWS
float sunlight() {
  vec3 place = vec3(p_shadow.xy, clamp(p_shadow.z, 0.0, 1.0));
  vec2 pixel = 1.0 / vec2(textureSize(shadow, 0));
  float sum = 0.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) sum += texture(shadow, place + vec3(pixel * vec2(x, y), 0.0));
  return sum / 9.0;
}
#elif defined SHADOWS
float sunlight() { return texture(shadow, vec3(p_shadow.xy, clamp(p_shadow.z, 0.0, 1.0))); }
#else
float sunlight() { return 1.0; }
#endif

#ifdef GRID
// One on the lines of a net of 0.1 m, 0 between them. Far away it fades.
float net() {
  vec2 cell = p_W.xy * 10.0;
  vec2 pixel = fwidth(cell);
  vec2 away = abs(fract(cell - 0.5) - 0.5);
  vec2 line = clamp(1.0 - away / max(pixel, 1e-6), 0.0, 1.0) * clamp(1.0 - 3.0 * pixel, 0.0, 1.0);
  return max(line.x, line.y) * step(0.9, n_W.z);
}
#endif

// The curve of sRGB, by roots: a power takes 2 ms longer on a software driver.
vec3 toScreen(vec3 linear) {
  vec3 root = sqrt(linear);
  vec3 fourth = sqrt(root);
  return 0.585 * root + 0.783 * fourth - 0.368 * sqrt(fourth);
}

void main() {
  vec3 n = normalize(n_W);
  vec3 to_eye = normalize(eye_W - p_W);
  float facing = dot(n, sun_W);
  float lit = sunlight();
  float gloss = max(dot(n, normalize(sun_W + to_eye)), 0.0);
  // To the power of 32.
  gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
  vec3 colour = albedo;
#ifdef GRID
  colour *= 1.0 - 0.22 * net();
#endif
  vec3 light = mix(kGround, kSky, 0.5 + 0.5 * n.z) + kSun * (max(facing, 0.0) * lit);
  colour = colour * light + 0.05 * gloss * lit * step(0.0, facing);
  picture = vec4(toScreen(clamp(colour, 0.0, 1.0)), 1.0);
}
)";

const char* const kShadowVertex = R"(
uniform mat4 world_to_clip;

void main() { gl_Position = world_to_clip * vec4(place(), 1.0); }
)";

const char* const kShadowFragment = R"(
void main() {}
)";

// A line is a strip of two triangles, as wide as the line and one pixel for its soft edges.
const char* const kLineVertex = R"(
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec3 colour;
layout(location = 3) in float width;
uniform mat4 world_to_clip;
uniform vec2 size;
uniform float nearest;
flat out vec3 line_colour;
flat out float half_width;
noperspective out float away;

// The part of a line behind the eye would be turned about.
vec4 cut(vec4 end, vec4 other) {
  if (end.w >= nearest || other.w <= nearest) return end;
  return mix(end, other, (nearest - end.w) / (other.w - end.w));
}

void main() {
  vec4 a = world_to_clip * vec4(from, 1.0);
  vec4 b = world_to_clip * vec4(to, 1.0);
  vec4 start = cut(a, b), end = cut(b, a);
  if (max(start.w, end.w) < nearest) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  vec2 along = (end.xy / end.w - start.xy / start.w) * size;
  along = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
  half_width = 0.5 * width;
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  bool is_end = gl_VertexID >= 2;
  away = side * (half_width + 1.0);
  // Half a width longer at each end, so that corners are closed.
  vec2 shift = vec2(-along.y, along.x) * away + along * (is_end ? half_width : -half_width);
  vec4 place = is_end ? end : start;
  place.xy += 2.0 * shift / size * place.w;
  // Lines on a surface win over it.
  place.z -= 1e-4 * place.w;
  line_colour = colour;
  gl_Position = place;
}
)";

const char* const kLineFragment = R"(
flat in vec3 line_colour;
flat in float half_width;
noperspective in float away;
out vec4 picture;

void main() {
  picture = vec4(line_colour, clamp(half_width + 0.5 - abs(away), 0.0, 1.0));
}
)";

// One triangle that covers the picture at the farthest depth.
const char* const kBackgroundVertex = R"(
noperspective out float height;

void main() {
  vec2 place = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID >> 1) * 4 - 1);
  height = 0.5 + 0.5 * place.y;
  gl_Position = vec4(place, 1.0, 1.0);
}
)";

const char* const kBackgroundFragment = R"(
noperspective in float height;
uniform vec3 top;
uniform vec3 bottom;
out vec4 picture;

void main() { picture = vec4(mix(bottom, top, height), 1.0); }
)";

}  // namespace tandem::view::shaders
