// Curves over time, with the reasons for changes below them and a line at the moment that is shown.

const COLOURS = { requested: "#7f7f7f", commanded: "#000000", simulated: "#2f9fd8" }, LEVEL = "#c00000", LANE = 5, HEIGHT = 92;
const MARGIN = { left: 46, right: 8, top: 4, bottom: 16 };

class Plot {
  constructor(parent, title, unit, lines, motion, { levels = [], lanes = [], least = 1, lowest, highest, seek }) {
    Object.assign(this, { unit, lines, motion, levels, lanes });
    this.range = rangeOf(lines, least, lowest, highest);
    this.box = element("figure", parent);
    const caption = element("figcaption", this.box);
    element("span", caption, title);
    this.value = element("span", caption, "", "value");
    const frame = element("div", this.box, "", "frame");
    this.canvas = element("canvas", frame);
    this.canvas.style.height = `${HEIGHT + LANE * lanes.length}px`;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${title} over time`);
    this.cursor = element("div", frame, "", "cursor");
    for (const kind of ["pointerdown", "pointermove"])
      frame.addEventListener(kind, (event) => {
        if (event.buttons & 1) seek(this.timeAt(event.clientX - frame.getBoundingClientRect().left));
      });
  }

  timeAt(x) {
    const share = (x - MARGIN.left) / (this.canvas.clientWidth - MARGIN.left - MARGIN.right);
    return share * this.motion.duration;
  }

  /** Move the line to a time, and say the values there. */
  point(time) {
    const width = this.canvas.clientWidth - MARGIN.left - MARGIN.right;
    this.cursor.style.left = `${MARGIN.left + (width * time) / this.motion.duration}px`;
    const row = this.motion.nearest(time);
    const told = this.lines.map(({ name, values }) => (Number.isFinite(values[row]) ? values[row].toFixed(this.unit === "opening" ? 2 : 1) : "–"));
    this.value.textContent = `${told.join(" / ")} ${this.unit}`;
  }

  draw() {
    const ratio = window.devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width) return;
    Object.assign(this.canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const pen = this.canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "10px system-ui, sans-serif";
    const [lowest, highest] = this.range, bottom = height - MARGIN.bottom - LANE * this.lanes.length;
    const x = (time) => MARGIN.left + ((width - MARGIN.left - MARGIN.right) * time) / this.motion.duration;
    const y = (value) => bottom - ((bottom - MARGIN.top) * (value - lowest)) / (highest - lowest);
    pen.fillStyle = "#f1f3f5"; // on the way to the first pose
    pen.fillRect(x(0), MARGIN.top, x(this.motion.curves.motion_start) - x(0), height - MARGIN.bottom - MARGIN.top);
    this.drawAxes(pen, x, y, width, height);
    for (const level of this.levels.filter((each) => each >= lowest && each <= highest))
      stroke(pen, LEVEL, 1, [[x(0), y(level)], [x(this.motion.duration), y(level)]], [2, 3]);
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.left, 0, width, bottom);
    pen.clip();
    for (const { name, values } of this.lines)
      for (const piece of pieces(values, (row) => x(this.motion.first + row * this.motion.step), y, width))
        stroke(pen, COLOURS[name], name === "simulated" ? 2 : 1.2, piece, name === "requested" ? [4, 3] : []);
    pen.restore();
    this.lanes.forEach(({ colour, spells }, lane) => {
      pen.fillStyle = colour;
      for (const [from, to] of spells) pen.fillRect(x(from), bottom + LANE * lane + 1, Math.max(1, x(to) - x(from)), LANE - 1);
    });
  }

  drawAxes(pen, x, y, width, height) {
    const [lowest, highest] = this.range;
    pen.fillStyle = "#495057";
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    for (const tick of ticks(lowest, highest, 3)) {
      stroke(pen, "#dee2e6", 1, [[MARGIN.left, y(tick)], [width - MARGIN.right, y(tick)]]);
      pen.fillText(String(tick), MARGIN.left - 5, y(tick));
    }
    pen.textBaseline = "bottom";
    pen.textAlign = "center";
    for (const tick of ticks(0, this.motion.duration, 6)) pen.fillText(`${tick} s`, Math.min(x(tick), width - 14), height);
  }
}

/** From the smallest to the largest value, and `least` at least, with some room; `lowest` and `highest` where given. */
function rangeOf(lines, least, lowest, highest) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines)
    for (const value of values) if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  if (low > high) [low, high] = [0, 0];
  const room = Math.max(0.06 * (high - low), (least - high + low) / 2);
  return [Math.min(low - room, lowest ?? Infinity), highest ?? high + room];
}

/** Lines without gaps; where many values fall on a column, its smallest and largest. */
function pieces(values, x, y, width) {
  const every = Math.max(1, Math.floor(values.length / (2 * width))), found = [];
  let piece = [];
  for (let row = 0; row < values.length; row += every) {
    let [low, high] = [Infinity, -Infinity];
    for (let i = row; i < Math.min(row + every, values.length); i++)
      if (Number.isFinite(values[i])) [low, high] = [Math.min(low, values[i]), Math.max(high, values[i])];
    if (low > high) {
      if (piece.length) found.push(piece);
      piece = [];
    } else {
      piece.push([x(row), y(low)]);
      if (high > low) piece.push([x(row), y(high)]);
    }
  }
  return piece.length ? [...found, piece] : found;
}

function stroke(pen, colour, width, points, dashes = []) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.setLineDash(dashes);
  pen.beginPath();
  points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

/** Round numbers from lowest to highest, about `count`. */
function ticks(lowest, highest, count) {
  const rough = (highest - lowest) / count, tens = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * tens).find((each) => each >= rough);
  const found = [];
  for (let i = Math.ceil(lowest / step); i * step <= highest; i++) found.push(Number((i * step).toPrecision(6)));
  return found;
}

/** All plots: joints that were changed, or all, then self-distance and balance. */
function makePlots(motion, parent, every, seek) {
  const { curves, arrays } = motion, colours = Object.fromEntries(curves.reasons.map((reason) => [reason.name, reason.colour]));
  const column = (name, joint, factor) => Float32Array.from({ length: motion.count }, (_, row) => factor * arrays[name].values[26 * row + joint]);
  parent.replaceChildren();
  const plots = [];
  for (const joint of every ? curves.joints.keys() : curves.changed) {
    const { name, unit, factor, limits, spells } = curves.joints[joint];
    const lines = [["requested", "requested"], ["commanded", "command"], ["simulated", "joint_positions"]];
    plots.push(new Plot(parent, name, unit, lines.map(([line, array]) => ({ name: line, values: column(array, joint, factor) })), motion, {
      levels: scaled(limits, factor), lanes: spells.map(([reason, times]) => ({ colour: colours[reason], spells: times })), least: unit === "°" ? 5 : 0.1, seek,
    }));
  }
  const { values } = arrays.distance, horizon = curves.horizon_mm;
  plots.push(new Plot(parent, `self-distance (${horizon} mm: that or more)`, "mm",
    [{ name: "commanded", values: values.subarray(motion.count) }, { name: "simulated", values: values.subarray(0, motion.count) }],
    motion, { levels: curves.clearances_mm, lowest: 0, highest: 1.05 * horizon, seek }));
  if (arrays.balance)
    plots.push(new Plot(parent, "balance: centre of mass inside the feet", "mm", [{ name: "simulated", values: arrays.balance.values }], motion, { levels: [0], least: 10, lowest: -2, seek }));
  return plots;
}
