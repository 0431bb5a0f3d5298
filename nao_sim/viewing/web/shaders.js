// What the graphics card runs.  Light is MuJoCo's: ambient, diffuse and Blinn's highlights, colours as they are.

const HEAD = "#version 300 es\nprecision highp float;\nprecision highp sampler2DShadow;\n";

const SHADOWED = `
uniform sampler2DShadow shadows;
float lit(vec4 place) {
  vec3 at = place.xyz / place.w * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float step = 1.0 / float(textureSize(shadows, 0).x), sum = 0.0;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++) sum += texture(shadows, vec3(at.xy + vec2(i, j) * step, at.z - 0.0015));
  return sum / 9.0;
}`;

const SHADERS = {
  bodies: [
    `${HEAD}
uniform mat4 body, view, fromLight;
uniform float shrink;
in vec3 point, normal;
in vec4 colour, shine;
out vec3 place, outwards;
out vec4 shade, gloss, inLight;
void main() {
  outwards = mat3(body) * normal;
  vec4 world = body * vec4(point, 1.0) - vec4(shrink * outwards, 0.0);
  place = world.xyz;
  shade = colour;
  gloss = shine;
  inLight = fromLight * (world + vec4(0.004 * outwards, 0.0));
  gl_Position = view * world;
}`,
    `${HEAD}
uniform vec3 eye, headAmbient, headDiffuse, headSpecular;
uniform vec3 lightTo[2], lightDiffuse[2], lightSpecular[2];
uniform vec4 cover, paint;
uniform float opacity;
in vec3 place, outwards;
in vec4 shade, gloss, inLight;
out vec4 pixel;
${SHADOWED}
void main() {
  vec3 n = normalize(outwards), toEye = normalize(eye - place);
  vec3 base = mix(shade.rgb * (1.0 - gloss.w * cover.a) + gloss.w * cover.rgb, paint.rgb, paint.a);
  vec3 diffuse = headAmbient + headDiffuse * max(dot(n, toEye), 0.0);
  float sharp = gloss.y * 128.0 + 1.0;
  vec3 specular = headSpecular * pow(max(dot(n, toEye), 0.0), sharp);
  for (int i = 0; i < 2; i++) {
    float reach = i == 0 ? lit(inLight) : 1.0;
    diffuse += reach * lightDiffuse[i] * max(dot(n, lightTo[i]), 0.0);
    specular += reach * lightSpecular[i] * pow(max(dot(n, normalize(lightTo[i] + toEye)), 0.0), sharp);
  }
  pixel = vec4(base * (diffuse + gloss.z) + gloss.x * specular, shade.a * opacity);
}`,
  ],
  shadow: [`${HEAD}uniform mat4 body, view;\nin vec3 point;\nvoid main() { gl_Position = view * body * vec4(point, 1.0); }`, `${HEAD}void main() {}`],
  floor: [
    `${HEAD}
uniform mat4 view, fromLight;
uniform float height;
in vec2 corner;
out vec3 place;
out vec4 inLight;
void main() {
  vec4 world = vec4(corner * 14.0, height, 1.0);
  place = world.xyz;
  inLight = fromLight * world;
  gl_Position = view * world;
}`,
    `${HEAD}
uniform vec3 eye, haze, headAmbient, headDiffuse, lightTo[2], lightDiffuse[2];
uniform vec2 repeat;
uniform sampler2D picture;
in vec3 place;
in vec4 inLight;
out vec4 pixel;
${SHADOWED}
void main() {
  vec3 toEye = normalize(eye - place);
  vec3 diffuse = headAmbient + headDiffuse * max(toEye.z, 0.0);
  for (int i = 0; i < 2; i++) diffuse += (i == 0 ? lit(inLight) : 1.0) * lightDiffuse[i] * max(lightTo[i].z, 0.0);
  vec3 colour = texture(picture, place.xy * repeat).rgb * diffuse;
  pixel = vec4(mix(colour, haze, smoothstep(4.0, 12.0, length(place.xy))), 1.0);
}`,
  ],
  sky: [
    `${HEAD}in vec2 corner;\nout vec2 at;\nvoid main() { at = corner; gl_Position = vec4(corner, 0.9999, 1.0); }`,
    `${HEAD}
uniform vec3 zenith, horizon, forward, right, up;
in vec2 at;
out vec4 pixel;
void main() {
  vec3 along = normalize(forward + at.x * right + at.y * up);
  pixel = vec4(mix(horizon, zenith, clamp(along.z, 0.0, 1.0)), 1.0);
}`,
  ],
};
