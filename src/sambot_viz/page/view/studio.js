// @ts-check
/* The look "Studio": soft light from above, a fill from the other side, a rim, and a shoulder
 * in place of blown-out whites. The lights are at the camera and above, so that a robot is well
 * lit from wherever it is seen. All of it is in the shaders of the shapes themselves: no light
 * of three.js, no shadow map, no further picture.
 */

/** Linear light to what a screen shows; what is brighter than white bends to it. */
const SHOULDER = `
vec3 sambotShown(vec3 c) {
  vec3 bent = 0.7 + 0.3 * tanh((c - 0.7) / 0.3);
  c = mix(c, bent, step(0.7, c));
  return mix(1.055 * pow(c, vec3(0.41666)) - 0.055, c * 12.92,
             vec3(lessThanEqual(c, vec3(0.0031308))));
}
`;
const LIT = `
vec3 sN = normal;
vec3 sV = isOrthographic ? vec3(0.0, 0.0, 1.0) : normalize(vViewPosition);
vec3 sUp = normalize((viewMatrix * vec4(0.0, 1.0, 0.0, 0.0)).xyz);
vec3 sKey = normalize(vec3(-0.55, 0.25, 0.55) + 0.75 * sUp);
vec3 sFill = normalize(vec3(0.85, 0.05, 0.45));
float sSky = 0.5 + 0.5 * dot(sN, sUp);
float sFacing = max(0.0, dot(sN, sV));
vec3 sLight = mix(vec3(0.15, 0.145, 0.14), vec3(0.36, 0.39, 0.43), sSky);
sLight += vec3(0.80, 0.77, 0.72) * max(0.0, (dot(sN, sKey) + 0.15) / 1.15);
sLight += vec3(0.13, 0.15, 0.18) * max(0.0, dot(sN, sFill));
float sShine = max(0.0, dot(sN, normalize(sKey + sV)));
float sRim = pow(1.0 - sFacing, 3.5) * (0.25 + 0.75 * sSky);
vec3 sGloss = vec3(0.09 * pow(sShine, 40.0) + 0.03 * pow(sShine, 8.0))
  + vec3(0.10, 0.11, 0.13) * sRim;
outgoingLight = sambotShown(totalEmissiveRadiance + diffuseColor.rgb * sLight + sGloss);
`;
/** The material of a lit shape: what its shader is to have, as rviz_look.js rewrites it. */
export const STUDIO_LIT = { begin: SHOULDER, shade: LIT };

/** 1 in Studio, 0 in RViz's look: the shaders of what both draw read it. */
export const studioUniform = { value: 0 };
