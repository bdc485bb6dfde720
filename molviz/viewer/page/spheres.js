// Spheres in WebGL, exact to the pixel: each is a rectangle around its image, where every pixel's ray meets the ball.

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./scene.js").Scene} Scene */

const ROW = 2048; // balls in a row of a texture: every WebGL 2 has them as wide
const QUAD = [0, 1, 2, 2, 1, 3]; // the corners of two triangles

const VERTEX = `#version 300 es
precision highp float;
uniform highp sampler2D balls;
uniform lowp sampler2D colors;
uniform mat3 rotation;
uniform vec2 middle;
uniform vec2 scale;
uniform float eye;
flat out vec4 center;
flat out vec3 paint;
out vec2 page;

// the ends of a ball's image along one axis of a central projection: tangents from the eye
vec2 ends(float across, float depth, float radius) {
  float angle = atan(across, depth);
  float half_angle = asin(min(radius / length(vec2(across, depth)), 0.99));
  return eye * vec2(tan(angle - half_angle), tan(angle + half_angle));
}

void main() {
  int row = gl_VertexID >> 2;
  ivec2 texel = ivec2(row % ${ROW}, row / ${ROW});
  vec4 ball = texelFetch(balls, texel, 0);
  vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
  vec3 at = rotation * ball.xyz;
  center = vec4(at, ball.w);
  paint = texelFetch(colors, texel, 0).rgb;
  page = at.xy + corner * ball.w;
  if (eye > 0.0) {
    vec2 x = ends(at.x, eye - at.z, ball.w);
    vec2 y = ends(at.y, eye - at.z, ball.w);
    page = mix(vec2(x[0], y[0]), vec2(x[1], y[1]), corner * 0.5 + 0.5);
  }
  gl_Position = vec4((page - middle) * scale, 0.0, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
flat in vec4 center;
flat in vec3 paint;
in vec2 page;
uniform float eye;
uniform float reach;
out vec4 pixel;

void main() {
  vec3 from = eye > 0.0 ? vec3(0.0, 0.0, eye) : vec3(page, center.z);
  vec3 ray = eye > 0.0 ? normalize(vec3(page, -eye)) : vec3(0.0, 0.0, -1.0);
  vec3 offset = from - center.xyz;
  float along = dot(offset, ray);
  float inside = along * along - dot(offset, offset) + center.w * center.w;
  if (inside < 0.0) discard;
  vec3 point = offset - (along + sqrt(inside)) * ray;
  float facing = -dot(point, ray) / center.w;
  gl_FragDepth = clamp(0.5 - 0.5 * (point.z + center.z) / reach, 0.0, 1.0);
  pixel = vec4(paint * mix(0.5, 1.0, smoothstep(0.0, 0.5, facing)), 1.0);
}`;

/** Draws a scene's spheres on a canvas. */
export class SphereRenderer {
  /**
   * Return a renderer for a canvas, null where there is no WebGL.
   * @param {HTMLCanvasElement} canvas
   * @returns {SphereRenderer | null}
   */
  static on(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: true, premultipliedAlpha: true });
    return gl && new SphereRenderer(canvas, gl);
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   */
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.count = 0;
    this.reach = 1;
    this.program = programOf(gl);
    this.balls = gl.createTexture();
    this.colors = gl.createTexture();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.enable(gl.DEPTH_TEST);
  }

  /**
   * Take a scene to draw. Corner c of ball k is vertex 4 k + c: instances would be the usual way, but browsers that
   * draw without a graphics card take ten times as long for them.
   * @param {Scene} scene
   */
  take(scene) {
    const { gl } = this;
    const corners = new Uint32Array(QUAD.length * scene.count);
    for (let k = 0; k < corners.length; k++) corners[k] = 4 * Math.floor(k / QUAD.length) + QUAD[k % QUAD.length];
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    this.count = corners.length;
    this.reach = scene.reach;
    const rows = Math.ceil(scene.count / ROW);
    const balls = new Float32Array(4 * ROW * rows);
    const colors = new Uint8Array(4 * ROW * rows);
    balls.set(scene.balls);
    colors.set(scene.colors);
    this.texture(0, this.balls);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, ROW, rows, 0, gl.RGBA, gl.FLOAT, balls);
    this.texture(1, this.colors);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, ROW, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, colors);
  }

  /**
   * Let a unit hold a texture that is read texel by texel.
   * @param {number} unit
   * @param {WebGLTexture} texture
   */
  texture(unit, texture) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  /**
   * Draw one frame.
   * @param {Camera} camera
   * @param {number} sharpness pixels of the canvas to one of the page
   */
  draw(camera, sharpness) {
    const { gl, canvas, program } = this;
    const [width, height] = [camera.width, camera.height].map((side) => Math.max(1, Math.round(side * sharpness)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const at = (/** @type {string} */ name) => gl.getUniformLocation(program, name);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    gl.uniformMatrix3fv(at("rotation"), true, camera.rotation);
    gl.uniform2fv(at("middle"), camera.middle);
    gl.uniform2f(at("scale"), (2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height);
    gl.uniform1f(at("eye"), camera.distance);
    gl.uniform1f(at("reach"), this.reach);
    gl.uniform1i(at("colors"), 1);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
  }
}

/**
 * Return the program of both shaders; throws where one does not compile.
 * @param {WebGL2RenderingContext} gl
 */
function programOf(gl) {
  const program = gl.createProgram();
  for (const [type, source] of /** @type {[number, string][]} */ ([
    [gl.VERTEX_SHADER, VERTEX],
    [gl.FRAGMENT_SHADER, FRAGMENT],
  ])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(type));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(String(gl.getProgramInfoLog(program)));
  return program;
}
