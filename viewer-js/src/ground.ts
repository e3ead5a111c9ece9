// The ground: a grid that fades out, soft dark where the body is near it, and a ring that spreads on each beat.

import * as THREE from "three";

export const CONTACTS = 12;
const SIZE = 60; // [m]

const INK = new THREE.Vector3(0.2, 0.21, 0.27); // sRGB, as the shader writes it
const CHALK = new THREE.Vector3(0.75, 0.79, 0.9);
const NIGHT = new THREE.Vector3(0.02, 0.02, 0.04);

const VERTEX = /* glsl */ `
varying vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 middle;
uniform vec4 contacts[${CONTACTS}]; // x y, height above the ground, radius [m]
uniform float sinceBeat; // [s]
uniform float beatStrength;
uniform vec3 shadeInk;
uniform vec3 lineInk;
varying vec3 place;

float grid(vec2 p, float width) {
  vec2 slope = fwidth(p);
  vec2 near = abs(fract(p - 0.5) - 0.5);
  vec2 line = 1.0 - smoothstep(vec2(0.0), slope * width, near);
  return max(line.x, line.y) * (1.0 - smoothstep(0.1, 0.5, max(slope.x, slope.y)));
}

void main() {
  float away = distance(place.xy, middle.xy);
  float fade = exp(-away * away / 22.0);
  float lines = grid(place.xy, 1.3) * 0.16 * fade;
  float shade = 1.0;
  for (int i = 0; i < ${CONTACTS}; i++) {
    float reach = contacts[i].w * 1.5 + contacts[i].z * 0.7;
    vec2 apart = place.xy - contacts[i].xy;
    float strength = 0.24 / (1.0 + 40.0 * contacts[i].z * contacts[i].z + 6.0 * contacts[i].z);
    shade *= 1.0 - strength * exp(-dot(apart, apart) / (reach * reach));
  }
  float dark = 1.0 - shade;
  float radius = 0.42 + 1.5 * (1.0 - exp(-2.2 * sinceBeat));
  float edge = (away - radius) / (0.03 + 0.10 * sinceBeat);
  float ring = exp(-edge * edge) * exp(-4.0 * sinceBeat) * beatStrength;
  vec3 accent = vec3(0.886, 0.345, 0.243);
  vec3 colour = (dark * shadeInk + lines * lineInk + ring * accent) / max(ring + dark + lines, 1e-5);
  gl_FragColor = vec4(colour, clamp(max(dark, lines) + 0.7 * ring, 0.0, 1.0));
}`;

export class Ground {
  readonly group = new THREE.Group();
  private readonly uniforms = {
    middle: { value: new THREE.Vector3() },
    contacts: { value: Array.from({ length: CONTACTS }, () => new THREE.Vector4(0, 0, 9, 0.1)) },
    sinceBeat: { value: 9 },
    beatStrength: { value: 0 },
    shadeInk: { value: INK },
    lineInk: { value: INK },
  };
  private readonly shadow = new THREE.ShadowMaterial({ color: "#1d2233", opacity: 0.2 });

  constructor(private readonly floor: number) {
    const plane = new THREE.PlaneGeometry(SIZE, SIZE);
    const shadow = new THREE.Mesh(plane, this.shadow);
    shadow.receiveShadow = true;
    const pattern = new THREE.Mesh(
      plane,
      new THREE.ShaderMaterial({
        uniforms: this.uniforms,
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        transparent: true,
        depthWrite: false,
        polygonOffset: true,
        polygonOffsetFactor: -1,
      }),
    );
    pattern.renderOrder = 1;
    this.group.add(shadow, pattern);
  }

  /** A dark or a light room: chalk on the floor, or ink. */
  set dark(dark: boolean) {
    this.uniforms.lineInk.value = dark ? CHALK : INK;
    this.uniforms.shadeInk.value = dark ? NIGHT : INK;
    this.shadow.color.set(dark ? "#000000" : "#1d2233");
    this.shadow.opacity = dark ? 0.5 : 0.2;
  }

  update(centre: THREE.Vector3, ends: readonly THREE.Vector4[], sinceBeat: number, strength: number): void {
    this.group.position.set(centre.x, centre.y, this.floor);
    this.uniforms.middle.value.copy(centre);
    this.uniforms.sinceBeat.value = sinceBeat;
    this.uniforms.beatStrength.value = strength;
    const lowest = [...ends].sort((a, b) => a.z - a.w - (b.z - b.w)).slice(0, CONTACTS);
    lowest.forEach((end, i) => {
      const height = Math.max(end.z - end.w - this.floor, 0);
      this.uniforms.contacts.value[i].set(end.x, end.y, height, end.w);
    });
  }
}
