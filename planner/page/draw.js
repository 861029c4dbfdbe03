// Drawing in WebGL 2: shaded surfaces that are coloured by a value in bands, and lines of any width.
// Places are in metres in the world's frame; matrices are lists of 16 numbers, column by column.

const surfaceVertex = `#version 300 es
in vec3 place, normal; in float value; in vec2 rest;
uniform mat4 matrix; uniform vec3 eye; uniform float lift;
out vec3 towards; out float shown; out vec2 fibre;
void main() {
  gl_Position = matrix * vec4(place + lift * normalize(eye - place), 1.0);
  towards = normal; shown = value; fibre = rest;
}`;

// Bands have the colours of the pictures; their limits and the lines along the fibres are smooth over one pixel.
const surfaceFragment = `#version 300 es
precision highp float;
in vec3 towards; in float shown; in vec2 fibre;
uniform sampler2D colours; uniform int bands; uniform float step; uniform vec4 plain; uniform vec3 light;
uniform float spacing;
out vec4 colour;
vec3 band(float k) { return texelFetch(colours, ivec2(clamp(int(k), 0, bands - 1), 0), 0).rgb; }
void main() {
  vec3 base = plain.rgb;
  if (bands > 0) {
    float at = max(shown, 0.0) / step, low = floor(at);
    base = mix(band(low - 1.0), band(low), clamp((at - low) / max(fwidth(at), 1e-6), 0.0, 1.0));
  }
  if (spacing > 0.0) {
    vec2 at = fibre / spacing, off = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), 1e-6);
    base *= 1.0 - 0.22 * (1.0 - clamp(min(off.x, off.y), 0.0, 1.0));
  }
  vec3 facing = normalize(gl_FrontFacing ? towards : -towards);
  colour = vec4(base * (0.72 + 0.34 * max(dot(facing, light), 0.0)), plain.a);
}`;

// One instance per piece of a line: its two ends, and a corner of the strip that is drawn for it.
const lineVertex = `#version 300 es
in vec3 from, to; in vec2 corner;
uniform mat4 matrix; uniform vec3 eye; uniform vec2 size; uniform float width, lift;
vec4 seen(vec3 place) { return matrix * vec4(place + lift * normalize(eye - place), 1.0); }
void main() {
  vec4 a = seen(from), b = seen(to);
  vec2 way = (b.xy / b.w - a.xy / a.w) * size;
  way = length(way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
  vec4 end = corner.x < 0.5 ? a : b;
  vec2 pixels = vec2(-way.y, way.x) * corner.y + way * (corner.x < 0.5 ? -0.5 : 0.5);
  end.xy += pixels * width / size * end.w;
  gl_Position = end;
}`;
const lineFragment = `#version 300 es
precision highp float;
uniform vec4 plain;
out vec4 colour;
void main() { colour = plain; }`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const uniforms = {}, attributes = {};
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); ++k) {
    const name = gl.getActiveUniform(made, k).name;
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_ATTRIBUTES); ++k) {
    const name = gl.getActiveAttrib(made, k).name;
    attributes[name] = gl.getAttribLocation(made, name);
  }
  return { made, uniforms, attributes };
}

class Painter {
  constructor(gl) {
    this.gl = gl;
    this.surfaces = program(gl, surfaceVertex, surfaceFragment);
    this.lines = program(gl, lineVertex, lineFragment);
    this.buffer = gl.createBuffer();
    this.indices = gl.createBuffer();
    this.corners = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]), gl.STATIC_DRAW);
    this.colours = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
                                 [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  // Colours of the bands, as lists of three numbers from 0 to 255.
  setColours(colours) {
    const { gl } = this;
    const bytes = new Uint8Array(colours.flatMap(([r, g, b]) => [r, g, b, 255]));
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, colours.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    this.bands = colours.length;
  }

  // A new picture. `eye` is where one looks from.
  begin(matrix, eye, background) {
    const { gl } = this;
    this.matrix = matrix;
    this.eye = eye;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  // What has a value is coloured by it, in bands of `step`; the rest is `plain` [r, g, b, a], 0 to 1. `lift` brings
  // a surface nearer to the eye by as many metres, so that it is not hidden by what it lies on.
  surface({ place, normal, triangles, value, rest, step = 1, plain = [0, 0, 0, 1], spacing = 0, lift = 0, light }) {
    const { gl, surfaces: { made, uniforms, attributes } } = this;
    gl.useProgram(made);
    gl.uniformMatrix4fv(uniforms.matrix, false, this.matrix);
    gl.uniform3fv(uniforms.eye, this.eye);
    gl.uniform1f(uniforms.lift, lift);
    gl.uniform1i(uniforms.bands, value ? this.bands : 0);
    gl.uniform1f(uniforms.step, step);
    gl.uniform4fv(uniforms.plain, plain);
    gl.uniform3fv(uniforms.light, light);
    gl.uniform1f(uniforms.spacing, rest ? spacing : 0);
    const parts = [[attributes.place, place, 3], [attributes.normal, normal, 3], [attributes.value, value, 1],
                   [attributes.rest, rest, 2]];
    const bytes = parts.reduce((sum, [, list]) => sum + (list ? list.byteLength : 0), 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STREAM_DRAW);
    let at = 0;
    for (const [attribute, list, count] of parts) {
      if (!list) { gl.disableVertexAttribArray(attribute); continue; }
      gl.bufferSubData(gl.ARRAY_BUFFER, at, list);
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, count, gl.FLOAT, false, 0, at);
      gl.vertexAttribDivisor(attribute, 0);
      at += list.byteLength;
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STREAM_DRAW);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
  }

  // Pieces of lines: x, y, z of both ends of each. `width` in pixels of the screen.
  pieces(ends, { width, colour, lift = 0 }) {
    const { gl, lines: { made, uniforms, attributes } } = this;
    if (ends.length === 0) return;
    gl.useProgram(made);
    gl.uniformMatrix4fv(uniforms.matrix, false, this.matrix);
    gl.uniform2f(uniforms.size, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.uniform1f(uniforms.width, width);
    gl.uniform3fv(uniforms.eye, this.eye);
    gl.uniform1f(uniforms.lift, lift);
    gl.uniform4fv(uniforms.plain, colour);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.enableVertexAttribArray(attributes.corner);
    gl.vertexAttribPointer(attributes.corner, 2, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(attributes.corner, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(ends), gl.STREAM_DRAW);
    for (const [attribute, offset] of [[attributes.from, 0], [attributes.to, 12]]) {
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 24, offset);
      gl.vertexAttribDivisor(attribute, 1);
    }
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, ends.length / 6);
    for (const attribute of Object.values(attributes)) {
      gl.vertexAttribDivisor(attribute, 0);
      gl.disableVertexAttribArray(attribute);
    }
  }
}
