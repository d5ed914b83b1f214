// Plays a recorded motion: a place in it is a fractional pose index, the same for every plot.

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];

class Player {
  constructor(view, box) {
    this.view = view;
    this.motion = view.scene.motion;
    this.index = 0;
    this.speed = 1;
    this.playing = false;
    this.tick = this.tick.bind(this);
    if (!this.motion) return;
    // A very fast or very slow motion is shown in about four seconds.
    const {duration} = this.motion;
    this.stretch = duration > 1 && duration < 20 || !(duration > 0) ? 1 : duration / 4;
    this.build(box);
    this.goTo(0);
  }

  build(box) {
    this.button = make("button", {class: "vv-play", title: "Play or pause (space)",
      "aria-label": "Play", on: {click: () => this.toggle()}}, playIcon(false));
    this.slider = make("input", {type: "range", min: 0, max: this.motion.duration || 1,
      step: "any", "aria-label": "Place in the motion", class: "vv-cycle",
      on: {input: () => this.goTo(this.motion.indexAt(this.begin() + Number(this.slider.value)))}});
    this.slider.addEventListener("keydown", (event) => {
      if (event.key.startsWith("Arrow")) event.preventDefault();
    });
    this.readout = make("output", {class: "vv-readout"});
    const speeds = make("select", {"aria-label": "Speed", class: "vv-speed", title: "Speed",
      on: {change: () => { this.speed = Number(speeds.value); }}},
      ...kSpeeds.map((speed) => make("option", {value: speed, text: speed + "×"})));
    speeds.value = "1";
    const track = make("div", {class: "vv-track"}, this.slider, this.deadCentres());
    box.append(this.button, track, this.readout, speeds);
  }

  // Ticks above the slider where the drive is at a dead centre.
  deadCentres() {
    const ticks = make("div", {class: "vv-dead"});
    for (const centre of this.motion.deadCentres) {
      const part = (this.motion.timeAt(centre.pose) - this.begin()) / (this.motion.duration || 1);
      const mark = make("button", {title: centre.label || "dead centre",
        "aria-label": centre.label || "dead centre",
        on: {click: () => { this.pause(); this.goTo(centre.pose); }}});
      mark.style.left = 100 * Math.min(1, Math.max(0, part)) + "%";
      ticks.append(mark);
    }
    return ticks;
  }

  begin() {
    return this.motion.times[0];
  }

  // The mechanism has other numbers: the recorded motion is that of another.
  retire() {
    if (!this.motion) return;
    this.pause();
    this.motion = this.view.scene.motion = null;
    this.view.boxes.player.remove();
  }

  toggle() {
    if (this.playing) this.pause(); else this.play();
  }

  play() {
    if (!this.motion || this.playing || !(this.motion.end > 0)) return;
    if (!(this.motion.cycle > 0) && this.index >= this.motion.end) this.goTo(0);
    this.playing = true;
    this.last = null;
    this.showButton();
    this.view.stage.before.add(this.tick);
    this.view.stage.ask();
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.showButton();
    this.view.stage.before.delete(this.tick);
    this.view.stage.ask();
    this.view.emit("paused");
  }

  showButton() {
    this.button.replaceChildren(playIcon(this.playing));
    this.button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  tick(seconds) {
    const step = this.last === null ? 0 : Math.min(0.1, seconds - this.last);
    this.last = seconds;
    let time = this.motion.timeAt(this.index) + step * this.speed * this.stretch;
    const end = this.begin() + this.motion.duration;
    if (time >= end) {
      if (this.motion.cycle > 0) {
        time = this.begin() + (time - this.begin()) % this.motion.duration;
      } else {
        this.goTo(this.motion.end);
        this.pause();
        return;
      }
    }
    this.goTo(this.motion.indexAt(time));
  }

  step(count) {
    if (!this.motion) return;
    this.pause();
    const here = count > 0 ? Math.floor(this.index + 1e-9) : Math.ceil(this.index - 1e-9);
    this.goTo(here + count);
  }

  goTo(index) {
    if (!this.motion || !Number.isFinite(index)) return;
    this.index = this.motion.clamped(index);
    const now = this.view.now;
    now.index = this.index;
    now.time = this.motion.timeAt(this.index);
    this.motion.sample(this.index, now);
    this.slider.value = now.time - this.begin();
    const {label, unit: name} = this.motion.axis;
    const text = label + " " + this.motion.axisAt(this.index).toFixed(1) + " " + name;
    if (text !== this.readout.textContent) this.readout.textContent = text;
    this.view.moved();
  }
}

function playIcon(playing) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", playing ? "M5 4h3.5v12H5zM11.5 4H15v12h-3.5z" : "M6 3.5v13l10.5-6.5z");
  svg.append(path);
  return svg;
}
