// Puts the page together: the scene, the buttons, the words, the plots.

const KEYS = {
  " ": (player) => player.toggle(),
  ArrowLeft: (player) => player.jump(-0.5),
  ArrowRight: (player) => player.jump(0.5),
  ",": (player) => player.jump(-0.02),
  ".": (player) => player.jump(0.02),
  Home: (player) => player.seek(0),
  End: (player) => player.jump(player.duration),
  "-": (player) => player.changeSpeed(-1),
  "=": (player) => player.changeSpeed(1),
  "+": (player) => player.changeSpeed(1),
};

const byId = (id) => document.getElementById(id);

function element(kind, parent, text = "", className = "") {
  const made = document.createElement(kind);
  if (text) made.textContent = text;
  if (className) made.className = className;
  parent.append(made);
  return made;
}

class Page {
  constructor(told) {
    this.told = told;
    this.motion = new Motion(told);
    this.player = new Player(this.motion.duration, told.speeds, told.layers);
    this.startAt(location.hash);
    window.addEventListener("hashchange", () => this.startAt(location.hash));
    this.tell();
    this.offer();
    this.plots = [];
    this.replot();
    try {
      this.painter = new Painter(byId("scene"), told);
      this.camera = new Camera(byId("scene"), told.scene.cameras);
      this.offerCameras();
    } catch (error) {
      complain(error.message);
    }
    new ResizeObserver(() => this.resized()).observe(byId("plots"));
    new ResizeObserver(() => (this.drawn = NaN)).observe(byId("scene"));
    document.addEventListener("keydown", (event) => this.press(event));
    document.body.dataset.ready = "yes";
    this.before = performance.now();
    requestAnimationFrame((now) => this.frame(now));
  }

  /** `#t=2.5` behind the address shows that moment of the recording. */
  startAt(hash) {
    const found = /^#t=(\d+\.?\d*)$/.exec(hash);
    if (!found) return;
    this.player.playing = false;
    this.player.seek(this.motion.rolloutTime(Number(found[1])));
  }

  tell() {
    const { told } = this;
    byId("title").textContent = told.title;
    byId("verdict").textContent = told.verdict;
    byId("verdict").className = told.verdict_kind;
    if (told.rules_off.length) element("p", byId("off"), `SWITCHED OFF: ${told.rules_off.join(", ")}`, "unsafe");
    const list = element("dl", byId("summary"));
    for (const [what, lines] of told.summary) {
      element("dt", list, what);
      for (const line of lines) element("dd", list, line);
    }
    for (const note of told.notes) element("p", byId("summary"), `note: ${note}`, "note");
    for (const [name, colour] of Object.entries(COLOURS)) chip(byId("legend"), name, colour, "line");
    for (const { words, colour } of told.curves.reasons) chip(byId("legend"), words, colour, "box");
  }

  offer() {
    const { player, told } = this;
    byId("slider").max = player.duration;
    byId("slider").addEventListener("input", (event) => {
      player.playing = false;
      player.seek(Number(event.target.value));
    });
    byId("play").addEventListener("click", () => player.toggle());
    for (const speed of told.speeds) element("option", byId("speed"), `${speed} ×`).value = speed;
    byId("speed").addEventListener("change", (event) => (player.speed = Number(event.target.value)));
    for (const { name, words, shown } of told.layers) {
      const label = element("label", byId("layers")), box = element("input", label);
      Object.assign(box, { type: "checkbox", checked: shown, id: `layer-${name}` });
      label.append(words);
      box.addEventListener("change", () => { player.show(name); this.drawn = NaN; });
    }
    byId("every").addEventListener("change", () => this.replot());
  }

  offerCameras() {
    for (const name of Object.keys(this.told.scene.cameras)) element("option", byId("camera"), name).value = name;
    byId("camera").addEventListener("change", (event) => this.camera.use(event.target.value));
  }

  replot() {
    this.plots = makePlots(this.motion, byId("plots"), byId("every").checked, (time) => { this.player.playing = false; this.player.seek(time); });
    this.resized();
  }

  resized() {
    for (const plot of this.plots) plot.draw();
    this.drawn = NaN;
  }

  press(event) {
    const key = KEYS[event.key];
    if (!key || event.ctrlKey || event.altKey || event.metaKey || /^(SELECT|OPTION)$/.test(event.target.tagName)) return;
    event.preventDefault();
    key(this.player);
  }

  frame(now) {
    const { player } = this;
    player.advance((now - this.before) / 1000);
    this.before = now;
    if (this.drawn !== player.time || this.camera?.moved) this.show();
    byId("play").textContent = player.playing ? "❚❚" : "▶";
    byId("play").setAttribute("aria-label", player.playing ? "pause" : "play");
    byId("speed").value = player.speed;
    requestAnimationFrame((then) => this.frame(then));
  }

  show() {
    const { player, motion, painter, camera } = this, { time, shown } = player;
    this.drawn = time;
    const at = motion.recordingTime(time), lasts = this.told.curves.recording_s;
    byId("time").textContent = at < 0 ? "on the way to the first pose" : `${Math.min(at, lasts).toFixed(2)} of ${lasts.toFixed(2)} s`;
    byId("slider").value = time;
    for (const plot of this.plots) plot.point(time);
    const { covers, words } = motion.safety(time);
    byId("words").replaceChildren();
    if (shown.has("safety")) for (const { word, colour } of words) chip(byId("words"), word, css(colour), "box");
    if (!painter) return;
    camera.moved = false;
    painter.paint({
      poses: motion.poses(time),
      requested: shown.has("requested") ? motion.poses(time, true) : null,
      covers: shown.has("safety") ? covers : [],
      contacts: shown.has("contacts") ? motion.contacts(time) : null,
      shown,
    }, camera);
  }
}

const css = (colour) => `rgb(${colour.map((part) => Math.round(255 * part)).join(" ")})`;

function chip(parent, words, colour, kind) {
  const label = element("span", parent, "", "chip");
  element("i", label, "", kind).style.background = colour;
  label.append(words);
}

function complain(message) {
  byId("complaint").textContent = message;
  byId("complaint").hidden = false;
}

openParcel(byId("data").textContent).then((told) => (window.page = new Page(told))).catch((error) => complain(`This page cannot be shown: ${error.message}`));
