// Draws the scene with WebGL 2: the robot, its shadow, the person, what was requested, contacts.

const SHADOW_SIDE = 2048, SHADOW_REACH = 1.0, GHOST = [0.1, 0.45, 0.95, 0.75], CONTACT = [0.95, 0.1, 0.1, 1];
const NO_COVER = [0, 0, 0, 0];

class Painter {
  constructor(canvas, told) {
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("this browser has no WebGL 2; the plots need none");
    Object.assign(this, { canvas, told, scene: told.scene });
    this.programs = Object.fromEntries(Object.entries(SHADERS).map(([name, texts]) => [name, this.program(...texts)]));
    this.shapes = this.uploadShapes(told.arrays);
    this.square = this.uploadSquare();
    this.ball = this.findBall();
    this.floor = this.uploadFloor(told.arrays.floor);
    this.shadows = this.shadowMap();
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    ["point", "normal", "colour", "shine", "corner"].forEach((name, place) => gl.bindAttribLocation(program, place, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`the graphics card refuses: ${gl.getProgramInfoLog(program)}`);
    const places = {};
    return { program, at: (name) => (places[name] ??= gl.getUniformLocation(program, name)) };
  }

  attribute(place, { values, shape }, kind, normalised) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, shape[1], kind, normalised, 0, 0);
  }

  uploadShapes({ points, normals, colours, shines, faces }) {
    const gl = this.gl, shapes = gl.createVertexArray();
    gl.bindVertexArray(shapes);
    this.attribute(0, points, gl.FLOAT, false);
    this.attribute(1, padded(normals), gl.BYTE, true);
    this.attribute(2, colours, gl.UNSIGNED_BYTE, true);
    this.attribute(3, shines, gl.UNSIGNED_BYTE, true);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces.values, gl.STATIC_DRAW);
    return shapes;
  }

  uploadSquare() {
    const gl = this.gl, square = gl.createVertexArray();
    gl.bindVertexArray(square);
    this.attribute(4, { values: new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), shape: [4, 2] }, gl.FLOAT, false);
    return square;
  }

  /** A small ball of its own for contacts. */
  findBall() {
    const gl = this.gl, ball = gl.createVertexArray(), rings = 8, round = 12, points = [], faces = [];
    for (let i = 0; i <= rings; i++)
      for (let j = 0; j <= round; j++) {
        const up = (Math.PI * i) / rings, about = (2 * Math.PI * j) / round;
        points.push(Math.sin(up) * Math.cos(about), Math.sin(up) * Math.sin(about), Math.cos(up));
        const a = i * (round + 1) + j;
        if (i < rings && j < round) faces.push(a, a + round + 1, a + round + 2, a, a + round + 2, a + 1);
      }
    gl.bindVertexArray(ball);
    const values = new Float32Array(points);
    this.attribute(0, { values, shape: [0, 3] }, gl.FLOAT, false);
    this.attribute(1, { values, shape: [0, 3] }, gl.FLOAT, false);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(faces), gl.STATIC_DRAW);
    return { ball, count: faces.length };
  }

  uploadFloor({ values, shape }) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, shape[1], shape[0], 0, gl.RGB, gl.UNSIGNED_BYTE, values);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    const finer = gl.getExtension("EXT_texture_filter_anisotropic");
    if (finer) gl.texParameterf(gl.TEXTURE_2D, finer.TEXTURE_MAX_ANISOTROPY_EXT, 8);
    return texture;
  }

  shadowMap() {
    const gl = this.gl, texture = gl.createTexture(), frame = gl.createFramebuffer();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_SIDE, SHADOW_SIDE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return { texture, frame };
  }

  /** Paint a moment: poses of all bodies, those requested or null, covers of parts, contacts, and what is shown. */
  paint({ poses, requested, covers, contacts, shown }, camera) {
    const gl = this.gl, bodies = this.scene.bodies;
    this.fit();
    const matrices = poses.map(matrixOf);
    const seen = bodies.map((body, i) => i).filter((i) => bodies[i].of !== "person" || shown.has("person"));
    const { eye, view, forward, right, up } = camera.look(this.canvas.width / this.canvas.height);
    const lights = [...this.scene.lights].sort((a, b) => b.shadow - a.shadow);
    const centre = poses[1].slice(0, 2);
    const fromLight = this.castShadows(lights[0], [...centre, this.scene.floor.height], matrices, seen);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.paintSky(forward, right, up);
    const common = { eye, view, fromLight, lights };
    gl.enable(gl.DEPTH_TEST);
    this.paintFloor(common);
    const program = this.begin("bodies", common);
    gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(this.shapes);
    const opaque = seen.filter((i) => bodies[i].of !== "person");
    this.drawBodies(program, opaque, matrices, "seen", (i) => ({ cover: covers[bodies[i].part] }));
    if (contacts) this.drawContacts(program, contacts);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindVertexArray(this.shapes);
    this.drawBodies(program, seen.filter((i) => bodies[i].of === "person"), matrices, "seen", () => ({}));
    if (requested) this.drawGhost(program, requested.map(matrixOf));
    if (shown.has("collision")) this.drawBodies(program, opaque, matrices, "collision", () => ({}));
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
  }

  fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
  }

  castShadows(light, centre, matrices, seen) {
    const gl = this.gl, program = this.programs.shadow;
    const towards = unit(light.direction);
    const view = multiplied(orthographic(SHADOW_REACH, 4), lookAt(add(centre, scaled(towards, -2)), centre, [0, 0, 1]));
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.frame);
    gl.viewport(0, 0, SHADOW_SIDE, SHADOW_SIDE);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program.program);
    gl.uniformMatrix4fv(program.at("view"), false, view);
    gl.bindVertexArray(this.shapes);
    for (const i of seen) {
      gl.uniformMatrix4fv(program.at("body"), false, matrices[i]);
      this.draw(this.scene.bodies[i].seen);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return view;
  }

  begin(name, { eye, view, fromLight, lights }) {
    const gl = this.gl, program = this.programs[name], head = this.scene.headlight;
    gl.useProgram(program.program);
    gl.uniformMatrix4fv(program.at("view"), false, view);
    gl.uniformMatrix4fv(program.at("fromLight"), false, fromLight);
    gl.uniform3fv(program.at("eye"), eye);
    for (const kind of ["Ambient", "Diffuse", "Specular"]) gl.uniform3fv(program.at(`head${kind}`), head[kind.toLowerCase()]);
    gl.uniform3fv(program.at("lightTo"), lights.flatMap((light) => scaled(unit(light.direction), -1)));
    gl.uniform3fv(program.at("lightDiffuse"), lights.flatMap((light) => light.diffuse));
    gl.uniform3fv(program.at("lightSpecular"), lights.flatMap((light) => light.specular));
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.shadows.texture);
    gl.uniform1i(program.at("shadows"), 0);
    return program;
  }

  drawBodies(program, which, matrices, kind, how) {
    const gl = this.gl;
    for (const i of which) {
      const { cover = NO_COVER, paint = NO_COVER, opacity = 1 } = how(i);
      gl.uniformMatrix4fv(program.at("body"), false, matrices[i]);
      gl.uniform4fv(program.at("cover"), cover);
      gl.uniform4fv(program.at("paint"), paint);
      gl.uniform1f(program.at("opacity"), opacity);
      this.draw(this.scene.bodies[i][kind]);
    }
  }

  draw(runs) {
    for (const [first, count] of runs) this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 4 * first);
  }

  /** What was requested, seen through: only its nearest surface, and a little thinner, so that the robot hides it
   *  where both are the same. */
  drawGhost(program, matrices) {
    const gl = this.gl, robot = this.scene.bodies.map((body, i) => i).filter((i) => this.scene.bodies[i].of === "robot");
    const ghost = () => ({ paint: GHOST, opacity: 0.45 });
    gl.uniform1f(program.at("shrink"), 0.004);
    gl.colorMask(false, false, false, false);
    this.drawBodies(program, robot, matrices, "seen", ghost);
    gl.colorMask(true, true, true, true);
    gl.depthFunc(gl.LEQUAL);
    this.drawBodies(program, robot, matrices, "seen", ghost);
    gl.depthFunc(gl.LESS);
    gl.uniform1f(program.at("shrink"), 0);
  }

  drawContacts(program, contacts) {
    const gl = this.gl, size = 0.006;
    gl.bindVertexArray(this.ball.ball);
    gl.vertexAttrib4f(2, 1, 0, 0, 1);
    gl.vertexAttrib4f(3, 0, 0, 0.5, 0);
    gl.uniform4fv(program.at("cover"), NO_COVER);
    gl.uniform4fv(program.at("paint"), CONTACT);
    gl.uniform1f(program.at("opacity"), 1);
    gl.disable(gl.DEPTH_TEST); // they lie under the soles
    for (const [x, y, z] of contacts) {
      gl.uniformMatrix4fv(program.at("body"), false, new Float32Array([size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, x, y, z, 1]));
      gl.drawElements(gl.TRIANGLES, this.ball.count, gl.UNSIGNED_INT, 0);
    }
    gl.enable(gl.DEPTH_TEST);
  }

  paintFloor(common) {
    const gl = this.gl, program = this.begin("floor", common), { height, repeat, haze } = this.scene.floor;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.floor);
    gl.uniform1i(program.at("picture"), 1);
    gl.uniform1f(program.at("height"), height);
    gl.uniform2fv(program.at("repeat"), scaled(repeat, 0.5));
    gl.uniform3fv(program.at("haze"), haze);
    gl.bindVertexArray(this.square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  paintSky(forward, right, up) {
    const gl = this.gl, program = this.programs.sky;
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(program.program);
    for (const [name, value] of Object.entries({ zenith: this.scene.sky[0], horizon: this.scene.floor.haze, forward, right, up }))
      gl.uniform3fv(program.at(name), value);
    gl.bindVertexArray(this.square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
}

/** Normals of three bytes with a fourth beside, for cards read them in fours. */
function padded({ values, shape }) {
  const out = new Int8Array(4 * shape[0]);
  for (let i = 0; i < shape[0]; i++) for (let j = 0; j < 3; j++) out[4 * i + j] = values[3 * i + j];
  return { values: out, shape: [shape[0], 4] };
}
