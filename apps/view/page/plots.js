// Plots of the picked joint and of the drives over the motion's axis, or over time when live. A
// cursor stands where the mechanism is; a click or a drag in a plot moves the mechanism there.

class Plots {
  constructor(view, box) {
    this.view = view;
    this.box = box;
    this.charts = [];
    this.shownKey = null;
  }

  // Charts for what is picked; the same charts stay.
  rebuild() {
    const {view} = this, picked = view.picked;
    const joint = picked && picked.kind === "joint" ? picked.index : -1;
    const sets = view.live ? liveSets(view, joint) : motionSets(view, joint);
    this.box.replaceChildren();
    this.charts = sets.map((set) => new Chart(view, set));
    this.box.append(...this.charts.map((chart) => chart.element));
    this.box.hidden = !this.charts.length;
    this.draw();
  }

  draw() {
    for (const chart of this.charts) chart.draw();
  }
}

// What a chart shows: {title, unit, x: values, series: [{name, at(i), dashed}], count}.
function motionSets(view, joint) {
  const {scene} = view, motion = scene.motion, sets = [];
  if (!motion) return sets;
  const add = (title, unitName, series) => {
    sets.push({title, unit: unitName, series, axis: motion.axis, x: motion.axis.values,
      count: () => motion.count});
  };
  if (joint >= 0) addJointSets(scene, motion, joint, add);
  motion.drives.forEach((drive) => add("drive " + drive.name, drive.unit,
      [{name: drive.name, at: (i) => drive.forces[i]}]));
  return sets;
}

function addJointSets(scene, rows, index, add) {
  const joint = scene.joints[index], words = rows.certainty && rows.certainty[index];
  const width = scene.freedoms, wide = 6 * scene.joints.length;
  joint.freedoms.forEach((freedom, k) => {
    const {name, factor} = freedomUnit(scene, freedom);
    if (!rows.coordinates) return;
    add(freedom.name || joint.name, name, [{name: "coordinate",
      at: (i) => factor * rows.coordinates[i * width + joint.at + k]}]);
  });
  if (!rows.wrenches) return;
  for (const [begin, title, unitName] of [[0, "force on the second link", "N"],
    [3, "moment on the second link", "N m"]]) {
    const value = (i, k) => rows.wrenches[i * wide + 6 * index + begin + k];
    add(title, unitName, [...["x", "y", "z"].map((axis, k) => ({name: axis,
      at: (i) => value(i, k), dashed: words && words[begin + k] !== "certain"})),
      {name: "size", at: (i) => Math.hypot(value(i, 0), value(i, 1), value(i, 2)), strong: true,
        dashed: words && words.slice(begin, begin + 3).some((word) => word !== "certain")}]);
  }
}

const kChartHeight = 118;
const kChartEdge = {left: 50, right: 8, top: 8, bottom: 20};

class Chart {
  constructor(view, set) {
    this.view = view;
    this.set = set;
    this.canvas = make("canvas", {class: "vv-chart", tabindex: "0", role: "img",
      "aria-label": set.title + " in " + set.unit});
    this.values = set.series.map((series, k) => make("span", {class: "vv-key"}, series.mark =
        make("i", {class: series.dashed ? "vv-dashed" : ""}), make("span", {text: series.name}),
        series.out = make("b", {})));
    set.series.forEach((series, k) => {
      series.colour = series.strong ? "--vv-ink" : kSeriesColours[k % kSeriesColours.length];
      series.mark.style.setProperty("--vv-mark", "var(" + series.colour + ")");
    });
    this.element = make("figure", {class: "vv-figure"},
        make("figcaption", {},
            make("span", {class: "vv-title", text: set.title + " [" + set.unit + "]"}),
            make("span", {class: "vv-keys"}, ...this.values)), this.canvas);
    this.pen = this.canvas.getContext("2d");
    this.curves = document.createElement("canvas");
    listen(this.canvas, {
      pointerdown: (event) => this.seek(event),
      pointermove: (event) => { if (event.buttons & 1) this.seek(event); }});
    // The width is kept, because asking for it at each frame would lay the page out anew.
    new ResizeObserver(() => {
      this.wide = this.canvas.clientWidth;
      this.stale = true;
      this.draw();
    }).observe(this.canvas);
    this.stale = true;
  }

  // The mechanism goes to the place under the pointer.
  seek(event) {
    if (!this.view.scene.motion || this.view.live) return;
    event.preventDefault();
    this.canvas.focus({preventScroll: true});
    const box = this.canvas.getBoundingClientRect();
    const part = (event.clientX - box.left - kChartEdge.left) /
        (box.width - kChartEdge.left - kChartEdge.right);
    const {low, high} = this.range.x;
    this.view.player.pause();
    this.view.player.goTo(this.view.scene.motion.indexAtAxis(
        low + Math.min(1, Math.max(0, part)) * (high - low)));
  }

  draw() {
    const width = this.wide;
    if (!width) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    if (this.stale || this.view.live || this.width !== width || this.ratio !== ratio) {
      this.drawCurves(width, ratio);
    }
    const pen = this.pen;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.curves, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawCursor(width);
  }

  drawCurves(width, ratio) {
    Object.assign(this, {width, ratio, stale: false});
    this.findRange();
    for (const canvas of [this.canvas, this.curves]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(kChartHeight * ratio);
    }
    const pen = this.curves.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawAxes(pen, width);
    for (const series of this.set.series) this.drawSeries(pen, series, width);
  }

  findRange() {
    const {set} = this, count = set.count();
    const y = {low: Infinity, high: -Infinity}, x = {low: Infinity, high: -Infinity};
    const widen = (range, value) => {
      if (!Number.isFinite(value)) return;
      range.low = Math.min(range.low, value);
      range.high = Math.max(range.high, value);
    };
    for (let i = 0; i < count; ++i) {
      widen(x, set.x[i]);
      for (const series of set.series) widen(y, series.at(i));
    }
    if (!(y.high >= y.low)) Object.assign(y, {low: 0, high: 1});
    // A constant is drawn as one, not as the noise of its last digit.
    const size = Math.max(Math.abs(y.low), Math.abs(y.high)), span = y.high - y.low;
    const room = span > 1e-6 * size ? 0.06 * span : 0.1 * size || 1;
    y.low -= room;
    y.high += room;
    if (!(x.high > x.low)) x.high = x.low + 1;
    this.range = {x, y};
  }

  toX(value, width) {
    const {left, right} = kChartEdge, {low, high} = this.range.x;
    return left + (value - low) / (high - low) * (width - left - right);
  }

  toY(value) {
    const {top, bottom} = kChartEdge, {low, high} = this.range.y;
    return top + (high - value) / (high - low) * (kChartHeight - top - bottom);
  }

  drawAxes(pen, width) {
    const {theme} = this.view, {x, y} = this.range;
    pen.strokeStyle = theme.colour("--vv-line");
    pen.fillStyle = theme.colour("--vv-muted");
    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
    const step = niceStep((y.high - y.low) / 4);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let value = Math.ceil(y.low / step) * step; value <= y.high; value += step) {
      const at = Math.round(this.toY(value)) + 0.5;
      line(pen, kChartEdge.left, at, width - kChartEdge.right, at);
      pen.fillText(tickText(value, step), kChartEdge.left - 5, at);
    }
    this.drawBottom(pen, width, x);
  }

  drawBottom(pen, width, x) {
    const {axis} = this.set;
    const around = axis.unit === "deg" && x.high - x.low > 100;
    const step = around ? 90 : niceStep((x.high - x.low) / 5);
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const end = x.high + 1e-9 * step;
    for (let value = Math.ceil(x.low / step - 1e-9) * step; value <= end; value += step) {
      const at = this.toX(value, width), last = value + step > end;
      line(pen, at, kChartHeight - kChartEdge.bottom, at, kChartHeight - kChartEdge.bottom + 3);
      pen.textAlign = last && at > width - 34 ? "right" : "center";
      pen.fillText(tickText(value, step) + (last ? " " + axis.unit : ""),
          pen.textAlign === "right" ? width - 2 : at, kChartHeight - kChartEdge.bottom + 6);
    }
  }

  drawSeries(pen, series, width) {
    const count = this.set.count();
    pen.strokeStyle = this.view.theme.colour(series.colour);
    pen.lineWidth = series.strong ? 1.1 : 1.7;
    pen.lineJoin = "round";
    pen.setLineDash(series.dashed ? [5, 4] : []);
    pen.beginPath();
    let open = false;
    for (let i = 0; i < count; ++i) {
      const value = series.at(i);
      if (!Number.isFinite(value)) { open = false; continue; }
      const x = this.toX(this.set.x[i], width), y = this.toY(value);
      if (open) pen.lineTo(x, y); else pen.moveTo(x, y);
      open = true;
    }
    pen.stroke();
    pen.setLineDash([]);
  }

  drawCursor(width) {
    const {set, view} = this, count = set.count();
    if (!count) return;
    const index = view.live ? count - 1 : Math.min(view.now.index, count);
    const i = Math.min(Math.floor(index), count - 1), next = Math.min(i + 1, count - 1);
    const part = index - i;
    const at = view.live ? set.x[i] : view.scene.motion.axisAt(index);
    const x = this.toX(Math.min(at, this.range.x.high), width), pen = this.pen;
    pen.strokeStyle = view.theme.colour("--vv-accent");
    pen.lineWidth = 1.25;
    line(pen, x, kChartEdge.top, x, kChartHeight - kChartEdge.bottom);
    for (const series of set.series) {
      const value = series.at(i) + part * (series.at(next) - series.at(i));
      pen.fillStyle = view.theme.colour(series.colour);
      pen.beginPath();
      if (Number.isFinite(value)) pen.arc(x, this.toY(value), 3, 0, 2 * Math.PI);
      pen.fill();
      const text = shown(value);
      if (series.out.textContent !== text) series.out.textContent = text;
    }
  }
}

function line(pen, x1, y1, x2, y2) {
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}

function tickText(value, step) {
  if (Math.abs(value) < 1e-9 * step) return "0";
  if (Math.abs(value) >= 1e6 || step < 1e-4) return value.toExponential(1);
  return value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
}
