// A camera on a sphere about a point; the pointer turns, moves and nears it.

class Camera {
  constructor(canvas, presets) {
    this.presets = presets;
    this.pointers = new Map();
    this.use(Object.keys(presets)[0]);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => this.drag(event, canvas.clientHeight));
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.near(Math.exp(0.001 * event.deltaY)); }, { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", () => this.use(this.name));
  }

  use(name) {
    Object.assign(this, structuredClone(this.presets[name]), { name });
    this.moved = true;
  }

  near(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.15), 8);
    this.moved = true;
  }

  drag(event, height) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const across = event.clientX - before.clientX, down = event.clientY - before.clientY;
    const others = [...this.pointers.values()].filter((each) => each.pointerId !== event.pointerId);
    this.pointers.set(event.pointerId, event);
    if (others.length) {
      const apart = (each) => Math.hypot(each.clientX - others[0].clientX, each.clientY - others[0].clientY) || 1;
      this.near(apart(before) / apart(event));
      this.shift(across / 2, down / 2, height);
    } else if (event.shiftKey || event.buttons & 6) this.shift(across, down, height);
    else {
      this.azimuth -= 0.4 * across;
      this.elevation = Math.min(Math.max(this.elevation - 0.3 * down, -89), 30);
    }
    this.moved = true;
  }

  shift(across, down, height) {
    const metres = (2 * this.distance * Math.tan(radians(this.fovy) / 2)) / height;
    const { right, up } = this.axes();
    this.lookat = add(this.lookat, add(scaled(right, -across * metres), scaled(up, down * metres)));
  }

  axes() {
    const [a, e] = [radians(this.azimuth), radians(this.elevation)];
    const forward = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const right = unit(cross(forward, [0, 0, 1]));
    return { forward, right, up: cross(right, forward) };
  }

  look(aspect) {
    const { forward, right, up } = this.axes();
    const far = this.distance * Math.max(1, 1.25 / aspect); // a narrow picture steps back
    const eye = add(this.lookat, scaled(forward, -far));
    eye[2] = Math.max(eye[2], 0.02);
    const wide = Math.tan(radians(this.fovy) / 2);
    const view = multiplied(perspective(radians(this.fovy), aspect, 0.02, 60), lookAt(eye, this.lookat, up));
    return { eye, view, forward, right: scaled(right, wide * aspect), up: scaled(up, wide) };
  }
}
